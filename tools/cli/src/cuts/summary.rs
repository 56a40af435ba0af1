//! The summary of a cut and its gap, and the warnings about them.

use tearmesh::gap::Gapped;
use tearmesh::{Cut, CutAim, CutReport};

use super::no_op::NoOpReason;
use crate::measure::Bounds;
use crate::report;
use crate::say::{Fault, count, pieces, place, short};

/// The line of the summary on a cut; cuts have numbers where there are several.
pub(crate) fn cut(number: Option<usize>, cut: &CutReport) -> String {
    let name = number.map_or_else(|| "cut".to_owned(), |number| format!("cut {number}"));
    let inserted = match cut.vertices_inserted {
        0 => String::new(),
        inserted => count(inserted, "vertex", "vertices") + " inserted, ",
    };
    let refused = match cut.refused {
        0 => String::new(),
        refused => format!(" ({refused} refused)"),
    };
    format!(
        "{name}: {} crossed, {inserted}{} split{refused}, {} -> {}",
        count(cut.faces_crossed, "face", "faces"),
        count(cut.splits, "vertex", "vertices"),
        count(cut.pieces_before, "piece", "pieces"),
        pieces(cut.pieces, crumbs(cut)),
    )
}

/// The pieces that were not expected, but for those of which a warning of their own says why.
fn crumbs(cut: &CutReport) -> usize {
    cut.crumbs.saturating_sub(cut.necks.len())
}

/// The line of the summary on a gap.
pub(crate) fn gap(gapped: &Gapped) -> String {
    let pieces = count(gapped.pieces_moved, "piece", "pieces");
    let vertices = count(gapped.side_vertices, "vertex", "vertices") + " along the cut";
    let what = match (gapped.pieces_moved, gapped.side_vertices) {
        (0, _) => vertices,
        (_, 0) => pieces,
        _ => format!("{pieces} and {vertices}"),
    };
    let up_to = match gapped.vertices_clamped {
        0 => "",
        _ => "up to ",
    };
    format!("gap: {what} moved apart by {up_to}{}", short(gapped.length))
}

/// A warning if the gap is narrower somewhere than it was to be.
pub(crate) fn of_gap(gapped: &Gapped) -> Option<Fault> {
    let vertices = count(gapped.vertices_clamped, "vertex", "vertices");
    let message = format!("{vertices} moved less than half the gap, to keep faces from flipping");
    (gapped.vertices_clamped > 0).then(|| Fault::warning("W-CUT-GAP", message))
}

/// The table of warnings about a cut, with its number where there are several: each row has the
/// code, when it is due, and what is said. `reason` is why it split nothing, and `extent` that of
/// the mesh, which helps if the cut missed it.
pub(crate) fn warnings(
    number: Option<usize>,
    entry: &report::Cut,
    reason: NoOpReason,
    extent: Option<Bounds>,
) -> Vec<Fault> {
    let cut = &entry.report;
    let is_cut = !cut.missed && cut.splits > 0;
    let crumbs = crumbs(cut);
    let [crossed, loose, lost] = [
        count(cut.faces_crossed, "face", "faces"),
        count(crumbs, "crumb", "crumbs"),
        count(cut.lost, "piece", "pieces"),
    ];
    let far = format!("; the nearest vertex is {} away", short(cut.nearest_vertex));
    let touches = ": the cut only touches the mesh";
    let unsplit = "but no vertex could be split";
    let (missed, uncut) = match reason {
        NoOpReason::Seam => (": it is already cut there", "but it is already cut there"),
        NoOpReason::Touch => (touches, "it only touches the mesh"),
        NoOpReason::Snap => ("", "but is shorter than the snap: use --snap 0"),
        _ if cut.nearest_vertex == 0.0 => (touches, unsplit),
        _ => (&*far, unsplit),
    };
    let place_of_cut = match entry.through {
        true => "on the plane",
        false => "between the rays",
    };
    let why_lost = match entry.method {
        "exact" => "the part to cut off is smaller than the snap",
        _ => "the mesh has no edges for the cut to follow",
    };
    let missed = format!("no face lies {place_of_cut}{missed}");
    let uncut = format!("the cut crosses {crossed}, {uncut}");
    let necks = cut.necks.iter().map(|neck| {
        let (at, width) = (place(neck.at.into()), short(neck.width));
        let faces = count(neck.faces, "face", "faces");
        let hung = format!("it hung on a neck {width} wide, which is narrower than the snap");
        let message = format!("a piece of {faces} came off at {at}: {hung}");
        ("W-CUT-NECK", is_cut, message)
    });
    let loose = format!("{loose} came loose beside the cut");
    let lost = format!("{lost} stayed joined: {why_lost}");
    let shared = "the two sides still share a vertex between the rays".to_owned();
    let rows = [
        ("W-CUT-MISS", cut.missed, missed),
        ("W-CUT-NONE", !cut.missed && !is_cut, uncut),
    ];
    let aims = cut.aims.into_iter().flatten().zip(["first", "second"]);
    let aims = aims.filter_map(|(aim, which)| {
        let aim = aim.filter(CutAim::is_missed)?;
        let [at, seam] = [aim.at, aim.seam].map(|p| place(p.into()));
        let aside = short(aim.aside);
        let message = format!(
            "the {which} ray meets the mesh at {at}, but the cut passes {aside} away from there, at {seam}"
        );
        Some(("W-CUT-ASIDE", is_cut, message))
    });
    let rows = rows.into_iter().chain(necks).chain(aims).chain([
        ("W-CUT-CRUMBS", is_cut && crumbs > 0, loose),
        ("W-CUT-LOST", is_cut && cut.lost > 0, lost),
        ("W-CUT-JOINED", is_cut && !cut.separated, shared),
    ]);
    let due = rows.filter(|(_, is_due, _)| *is_due);
    let extent = extent.filter(|_| cut.missed);
    let warned = due.map(|(code, _, message)| {
        let mut fault = warning(code, number, &message);
        fault.help = extent.and_then(|extent| help(reason, extent));
        fault
    });
    warned.collect()
}

/// What would help a cut that met no face.
fn help(reason: NoOpReason, Bounds { min, max }: Bounds) -> Option<String> {
    let elsewhere = match reason {
        NoOpReason::Seam | NoOpReason::Touch | NoOpReason::Snap => return None,
        NoOpReason::Unknown => String::new(),
        NoOpReason::Elsewhere { faces: 0, splits } => {
            let vertices = count(splits, "vertex", "vertices");
            format!("; the plane runs along edges elsewhere: --through splits {vertices} there")
        }
        NoOpReason::Elsewhere { faces, .. } => {
            let faces = count(faces, "face", "faces");
            format!("; the plane crosses {faces} elsewhere: --through cuts there")
        }
    };
    let (least, most) = (place(min), place(max));
    let words = format!("the mesh extends from {least} to {most}{elsewhere}");
    Some(words)
}

/// A warning if a cut through the first layers went through two.
pub(crate) fn of_layers(number: Option<usize>, cut: &Cut) -> Option<Fault> {
    let [one, other] = cut.layers().map(|hit| hit.map(|hit| hit.chain));
    let message = "the rays hit different layers of the mesh: both are cut";
    (one != other).then(|| warning("W-CUT-LAYERS", number, message))
}

fn warning(code: &'static str, number: Option<usize>, message: &str) -> Fault {
    let of = number.map_or_else(String::new, |number| format!("cut {number}: "));
    Fault::warning(code, of + message)
}
