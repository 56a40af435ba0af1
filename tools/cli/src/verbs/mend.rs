//! The verb `mend`.

use std::ffi::OsString;
use std::io::Write;
use std::time::Instant;

use tearmesh::mend::{self, SewError, Stitch, StitchError};
use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{Edit, Edits, Masses, Mesh, Positions, Vector, VertexId};
use tearmesh_obj::{Document, Simplified, TornDocument};

use crate::args::MendArgs;
use crate::exit::{Exit, Stop};
use crate::files::Names;
use crate::measure::{Edges, written_area};
use crate::picture::Texture;
use crate::report;
use crate::say::{Fault, count, short};
use crate::session::{self, Session, milliseconds};
use crate::streams::Streams;
use crate::weld;

/// Mends, says what was done, and gives the exit status. `typed` is for the reproducer.
pub(crate) fn run(args: &MendArgs, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let (files, names) = (&args.files, Names::new(&args.files, &[], &[]));
    Session::run("mend", files, &names, typed, streams, |session| {
        work(args, session)
    })
}

fn work(args: &MendArgs, session: &mut Session<'_, '_>) -> Result<(), Stop> {
    let opened = session.open(None)?;
    let (mut document, mut mesh, mut positions) = (opened.document, opened.mesh, opened.positions);
    if args.coincident {
        (document, mesh) = torn_at_seams(document, &mesh, &positions)?;
    }
    let (vertices_before, pieces_before) = (mesh.vertex_count(), mesh.components().count());
    let masses = Masses::area(&mesh, &positions, 1.0);
    let mut masses = masses.map_err(Fault::from)?;
    let mut torn = TornDocument::new(&document);
    let area_before = written_area(&torn, &mesh, &positions);

    let start = Instant::now();
    let stitches = stitches(args, &mesh, &positions, &torn);
    // To the bit: where one is at −0 and the other at 0, corners of one of them move.
    let bits = |v| <[f64; 3]>::from(positions.at(v)).map(f64::to_bits);
    let apart = |stitch: &Stitch| bits(stitch.kept()) != bits(stitch.gone());
    let moves = stitches.iter().any(apart);
    let far = moves.then(|| far_apart(&stitches, &mesh, &positions));
    let mut edits = Edits::new();
    let (weight, farthest) = (|v| masses.at(v), args.max_distance.unwrap_or(f64::INFINITY));
    let log = &mut edits;
    let merged = mend::sew(&mut mesh, &positions, &stitches, weight, farthest, log);
    let merged = merged.map_err(|error| too_far(&error, &document))?;
    session.faults.extend(far.flatten());
    edits.replay(&mut (&mut positions, &mut masses, &mut torn));
    close_gaps(&mut torn, &mesh, &edits, vertices_before);
    session.timing.cut = milliseconds(start);

    let ledger = masses.ledger();
    let moved = || session::moved(&document, &mesh, &positions);
    let broken = (!moves).then(moved).flatten();
    let mass = session.verify(&mesh, &ledger, report::AREA, broken)?;

    let simplified = match args.simplify {
        true => torn.simplified(&mesh, &positions),
        false => Ok(Simplified::default()),
    };
    let simplified = simplified.expect("what we wrote can be read");
    session.faults.extend(kept(&simplified));
    if merged == 0 && simplified.document.is_none() {
        let place = if args.near.is_some() { " there" } else { "" };
        let message = format!("nothing is torn{place}");
        let mut fault = Fault::warning("W-MEND-NONE", message);
        let seams = match args.coincident || document.has_record() {
            true => UnsewnSeams::default(),
            false => UnsewnSeams::find(&mesh, &positions),
        };
        if !seams.is_empty() {
            let (one, many) = ("pair of boundary edges lies", "pairs of boundary edges lie");
            let edges = count(seams.edges().len(), one, many);
            fault.message = format!("the file has no record of cuts; {edges} on each other");
            let help = "if another program dropped the record, --coincident sews them";
            fault = fault.help(help);
        }
        session.faults.push(fault);
        return Err(session.nothing_done());
    }
    let cuts_left = torn.cuts().len();
    let faces_before = mesh.face_count();
    let vertices_mended = mesh.vertex_count();
    if let Some(document) = &simplified.document {
        mesh = document.mesh().expect("what was written can be read");
        let points = document.positions().iter().copied();
        positions = Positions::new(points).expect("they were usable");
    }
    if moves || simplified.slid_back > 0 {
        // No verb would read a mesh that has no area where its vertices moved.
        Masses::area(&mesh, &positions, 1.0).map_err(Fault::from)?;
    }
    let mut texture = Texture::of(simplified.document.as_ref().unwrap_or(&document));
    if simplified.document.is_none() {
        texture.follow(&edits);
    }
    let simple = simplified.document.as_ref().map(TornDocument::new);
    let torn = simple.as_ref().unwrap_or(&torn);
    let fill = |mut out: &mut dyn Write| torn.write(&mesh, &positions, &mut out);
    session.write(&mesh, fill)?;
    session.show_mesh(&document, &mesh, &positions, Vector::y(), &texture)?;
    session.show_page(&mesh, &positions, Vector::y())?;
    let mended = report::Mend {
        merged,
        cuts_left,
        vertices_removed: vertices_mended - mesh.vertex_count(),
        vertices_edited: simplified.edited,
        vertices_slid_back: simplified.slid_back,
        vertices_slid_edited: simplified.slid_edited,
        faces_removed: faces_before - mesh.face_count(),
        pieces_before,
        pieces: mesh.components().count(),
    };
    session.words.push(summary(&mended));
    session.report.mend = Some(mended);
    session.report.area = Some(report::Area {
        before: area_before,
        after: written_area(torn, &mesh, &positions),
    });
    session.end(vertices_before, &mesh, mass);
    Ok(())
}

/// The line of the summary.
fn summary(mended: &report::Mend) -> String {
    let mut words = format!(
        "mend: {} sewn, {} -> {}",
        count(mended.merged, "vertex", "vertices"),
        count(mended.pieces_before, "piece", "pieces"),
        count(mended.pieces, "piece", "pieces"),
    );
    let (removed, moved) = (mended.vertices_removed, mended.vertices_slid_back);
    for (number, one, many, done) in [
        (removed, "inserted vertex", "inserted vertices", "removed"),
        (moved, "vertex", "vertices", "moved back"),
        (mended.cuts_left, "cut", "cuts", "left"),
    ] {
        if number > 0 {
            words += &format!(", {} {done}", count(number, one, many));
        }
    }
    words
}

/// Writes pieces where they are that something was sewn to. Each part of one may have been written apart
/// from where it is by another way.
fn close_gaps(torn: &mut TornDocument<'_>, mesh: &Mesh, edits: &Edits, vertices_before: usize) {
    let mut is_sewn = vec![false; vertices_before];
    for edit in edits {
        for op in edit.vertex_ops() {
            op.apply(&mut is_sewn, |_| false);
        }
        if let Edit::Merge(merge) = edit {
            is_sewn[merge.kept.index()] = true;
        }
    }
    let components = mesh.components();
    let piece = |v: VertexId| Some(components.of(mesh.half_edge_of(v)?.face()));
    let mut is_closed = vec![false; components.count()];
    let sewn = mesh.vertices().filter(|v| is_sewn[v.index()]);
    for piece in sewn.filter_map(piece) {
        is_closed[piece] = true;
    }
    torn.set_in_place(|v| piece(v).is_some_and(|piece| is_closed[piece]));
}

/// The document and its mesh, torn where its boundary lies on itself.
fn torn_at_seams(
    document: Document,
    mesh: &Mesh,
    positions: &Positions,
) -> Result<(Document, Mesh), Stop> {
    if document.has_record() {
        let message =
            "`--coincident` is for a file without a record of its cuts, and this one has one";
        let help = "leave it out: the record is more exact";
        return Err(Stop::usage(message, help));
    }
    let seams = UnsewnSeams::find(mesh, positions);
    Ok(weld::torn_at(document, mesh, &seams)?)
}

/// What is to be sewn.
fn stitches(
    args: &MendArgs,
    mesh: &Mesh,
    positions: &Positions,
    torn: &TornDocument<'_>,
) -> Vec<Stitch> {
    if let Some(last) = args.last {
        return torn.stitches_of_last(last.get());
    }
    let ball = args.near.zip(args.radius);
    let is_in = |v| ball.is_none_or(|(centre, radius)| (positions.at(v) - centre).norm() <= radius);
    mend::stitches(mesh, is_in)
}

/// A warning of vertices to be joined that are farther apart than the mean edge is long: their faces are
/// drawn out over that.
fn far_apart(stitches: &[Stitch], mesh: &Mesh, positions: &Positions) -> Option<Fault> {
    let edge = Edges::of(mesh, positions).mean;
    let between = |stitch: &Stitch| positions.at(stitch.kept()) - positions.at(stitch.gone());
    let distances = stitches.iter().map(|stitch| between(stitch).norm());
    let far: Vec<f64> = distances.filter(|&distance| distance > edge).collect();
    let farthest = short(far.iter().copied().fold(0.0, f64::max));
    let (one, many) = ("pair of vertices was", "pairs of vertices were");
    let (pairs, edge) = (count(far.len(), one, many), short(edge));
    let message = format!(
        "{pairs} sewn from farther apart than the mean edge is long, {edge}: up to {farthest}"
    );
    let help = "--max-distance D refuses that, and --near sews a part";
    (!far.is_empty()).then(|| Fault::warning("W-MEND-FAR", message).help(help))
}

/// Warns of vertices that stay where they are, because they were edited since.
fn kept(simplified: &Simplified) -> impl Iterator<Item = Fault> {
    let (inserted, slid) = (simplified.edited, simplified.slid_edited);
    let of_inserted = count(
        inserted,
        "inserted vertex was edited since the cut and stays, as do the divided faces that depend on it",
        "inserted vertices were edited since the cut and stay, as do the divided faces that depend on them",
    );
    let of_slid = count(
        slid,
        "vertex that a cut moved was edited since and stays in place",
        "vertices that cuts moved were edited since and stay in place",
    );
    let all = [(inserted, of_inserted), (slid, of_slid)].into_iter();
    let some = all.filter(|&(number, _)| number > 0);
    some.map(|(_, message)| Fault::warning("W-MEND-EDITED", message))
}

/// Says which vertices are too far apart, by their numbers in the file.
fn too_far(error: &SewError, document: &Document) -> Stop {
    let mut faults: Vec<Fault> = Vec::new();
    for (stitch, why) in error.refused().iter().take(SHOWN) {
        let StitchError::Distance { distance } = why else {
            panic!("stitches are of one root, and masses are weights: {error}")
        };
        let number = |v: VertexId| document.number_of_vertex(v.index());
        let (one, other) = (number(stitch.kept()), number(stitch.gone()));
        let message = format!("the vertices {one} and {other} are {distance} apart");
        faults.push(Fault::error("E-MEND-DISTANCE", message));
    }
    let more = error.refused().len().saturating_sub(SHOWN);
    if let Some(last) = faults.last_mut() {
        if more > 0 {
            last.message += &format!(", and {} more", count(more, "pair is", "pairs are"));
        }
        last.help = Some("nothing was mended: allow more with --max-distance".to_owned());
    }
    faults.into()
}

/// How many pairs of vertices are named.
const SHOWN: usize = 5;
