//! Seams of the input whose sides coincide: a warning of them, and sewing them before the work.

use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{Edits, Mesh, Positions, mend};
use tearmesh_obj::{Document, TornDocument};

use crate::exit::Stop;
use crate::say::{Fault, count};
use crate::session::Opened;

/// Sews the seams of what was read, if that is wanted, and returns those that are left, with a warning.
pub(crate) fn seams(
    opened: &mut Opened,
    weld: Option<f64>,
    words: &mut Vec<String>,
    faults: &mut Vec<Fault>,
) -> Result<UnsewnSeams, Stop> {
    words.extend(weld.map_or(Ok(None), |distance| sew(opened, distance))?);
    let seams = UnsewnSeams::find(&opened.mesh, &opened.positions);
    faults.extend(warning(&seams));
    Ok(seams)
}

/// Sews the seams of what was read, whose sides are at most so far apart, and says how many vertices that
/// joined. The result is what `mend --coincident` writes.
fn sew(opened: &mut Opened, distance: f64) -> Result<Option<String>, Stop> {
    if opened.document.has_record() {
        let message = "`--weld` is for a file without a record of cuts, and this one has one";
        let help = "mend it first, or weld the file from before it was cut";
        return Err(Stop::usage(message, help));
    }
    let seams = UnsewnSeams::within(&opened.mesh, &opened.positions, distance);
    if seams.is_empty() {
        return Ok(None);
    }
    opened.welded = Some(seams.welded_vertices(&opened.mesh));
    let (torn, mut mesh) = torn_at(opened.document.clone(), &opened.mesh, &seams)?;
    let (mut positions, mut edits) = (opened.positions.clone(), Edits::new());
    let stitches = seams.stitches(&mesh);
    let (weight, farthest) = (|_| 1.0, f64::INFINITY);
    let sewn = mend::sew(
        &mut mesh, &positions, &stitches, weight, farthest, &mut edits,
    );
    let sewn = sewn.expect("the sides of a seam have one root");
    let mut document = TornDocument::new(&torn);
    edits.replay(&mut (&mut positions, &mut document));
    let mut bytes = Vec::new();
    let written = document.write(&mesh, &positions, &mut bytes);
    written.expect("memory takes all that is written");
    opened.document = Document::read(&bytes[..]).expect("what was written can be read");
    opened.mesh = opened
        .document
        .mesh()
        .expect("seams that are no surface stay apart");
    let points = opened.document.positions().iter().copied();
    opened.positions = Positions::new(points).expect("they were usable");
    Ok(Some(format!(
        "weld: {} sewn",
        count(sewn, "vertex", "vertices")
    )))
}

/// A document and its mesh, in which the sides of seams are ghost pairs.
pub(crate) fn torn_at(
    document: Document,
    mesh: &Mesh,
    seams: &UnsewnSeams,
) -> Result<(Document, Mesh), Fault> {
    document.torn_from(&seams.lowest(mesh)).map_err(|error| {
        let (one, many) = ("pair of boundary edges", "pairs of boundary edges");
        let edges = count(seams.edges().len(), one, many);
        let message = format!("{edges} cannot be sewn: {error}");
        Fault::error("E-MEND-COINCIDENT", message)
    })
}

/// A warning of seams that are not sewn.
pub(crate) fn warning(seams: &UnsewnSeams) -> Option<Fault> {
    let (all, left) = (seams.boundary_edges(), seams.left_apart());
    let mut parts = Vec::new();
    let mut add = |number: usize, words: &str| {
        if number > 0 {
            parts.push(format!("{number} {words}"));
        }
    };
    add(left.crowded, "where more than two sides meet");
    add(left.same_direction, "where both sides run the same way");
    add(left.not_manifold, "where sewing would not leave a surface");
    let sewable = 2 * seams.edges().len();
    if sewable + left.count() + seams.near_misses() == 0 {
        return None;
    }
    let edges = count(all, "boundary edge", "boundary edges");
    let mut message = format!("{} of {edges} lie on another", sewable + left.count());
    if !parts.is_empty() {
        message += &format!(" (stay apart: {})", parts.join(", "));
    }
    if seams.near_misses() > 0 {
        let pairs = count(seams.near_misses(), "pair nearly does", "pairs nearly do");
        message += &format!("; {pairs}, by less than a millionth of the size");
    }
    let fault = Fault::warning("W-MESH-UNSEWN", message);
    Some(match sewable {
        0 => fault,
        _ => fault.help("--weld sews them, in cut, tear and play"),
    })
}
