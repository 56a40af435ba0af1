//! The verb `mend`.

use std::ffi::OsString;
use std::io::Write;

use tearmesh::mend::{self, SewError, Stitch, StitchError};
use tearmesh::{Edit, Edits, Masses, Mesh, Positions, Vector, VertexId};
use tearmesh_obj::{Coincident, Document, Simplified, TornDocument};

use crate::args::MendArgs;
use crate::exit::{Exit, Stop};
use crate::files::Names;
use crate::report;
use crate::say::{Fault, count};
use crate::session::{self, Clock, Opened, Session};
use crate::streams::Streams;

/// Mends, says what was done, and gives the exit status. `typed` is for the reproducer.
pub(crate) fn run(args: &MendArgs, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let (files, names) = (&args.files, Names::new(&args.files, &[], &[]));
    Session::run("mend", files, &names, typed, streams, |session, streams| {
        work(args, session, streams)
    })
}

fn work(args: &MendArgs, session: &mut Session<'_>, streams: &mut Streams<'_>) -> Result<(), Stop> {
    let Opened {
        mut document,
        mut mesh,
        mut positions,
    } = session.open(None, streams)?;
    if args.coincident {
        (document, mesh) = torn_at(document, &mesh)?;
    }
    let (vertices_before, pieces_before) = (mesh.vertex_count(), mesh.components().count());
    let masses = Masses::area(&mesh, &positions, 1.0);
    let mut masses = masses.map_err(Fault::from)?;
    let mut torn = TornDocument::new(&document);

    let clock = Clock::start();
    let stitches = stitches(args, &mesh, &positions, &torn);
    let apart = |stitch: &Stitch| positions.at(stitch.kept()) != positions.at(stitch.gone());
    let moves = stitches.iter().any(apart);
    let mut edits = Edits::new();
    let (weight, farthest) = (|v| masses.at(v), args.max_distance.unwrap_or(f64::INFINITY));
    let merged = mend::sew(
        &mut mesh, &positions, &stitches, weight, farthest, &mut edits,
    )
    .map_err(|error| too_far(&error, &document))?;
    edits.replay(&mut (&mut positions, &mut masses, &mut torn));
    close_gaps(&mut torn, &mesh, &edits, vertices_before);
    session.report.timing_ms.get_or_insert_default().cut = clock.milliseconds();

    let mut ledger = masses.ledger();
    let moved = || session::moved(&document, &mesh, &positions);
    let broken = (!moves).then(moved).flatten();
    let mut mass = session.verify(&mesh, &ledger, report::MassUnit::Area, broken)?;

    let simplified = match args.simplify {
        true => torn.simplified(&mesh, &positions),
        false => Ok(Simplified::default()),
    };
    let simplified = simplified.expect("what we wrote can be read");
    let (edited, slid_edited) = (simplified.edited, simplified.slid_edited);
    session.faults.extend(kept(edited, slid_edited));
    if merged == 0 && simplified.document.is_none() {
        let place = if args.near.is_some() { " there" } else { "" };
        let message = format!("nothing is torn{place}");
        let mut fault = Fault::warning("W-MEND-NONE", message);
        let pairs = match args.coincident || document.has_record() {
            true => Coincident::default(),
            false => document.coincident(&mesh),
        };
        if pairs.edges() > 0 {
            let edges = count(
                pairs.edges(),
                "pair of boundary edges lies",
                "pairs of boundary edges lie",
            );
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
        // What was moved spans another area: the mass is that of what is written.
        let masses = Masses::area(&mesh, &positions, 1.0).map_err(Fault::from)?;
        ledger.after = masses.ledger().after;
        mass = session.say_mass(&ledger, report::MassUnit::Area);
    }
    let simple = simplified.document.as_ref().map(TornDocument::new);
    let torn = simple.as_ref().unwrap_or(&torn);
    let fill = |mut out: &mut dyn Write| torn.write(&mesh, &positions, &mut out);
    session.write(&mesh, fill, streams)?;
    session.show_mesh(&document, &mesh, &positions, Vector::y())?;
    session.show_page(&mesh, &positions, Vector::y())?;
    let taken_out = vertices_mended - mesh.vertex_count();
    let pieces = mesh.components().count();
    session.report.mend = Some(report::Mend {
        merged,
        cuts_left,
        vertices_removed: taken_out,
        vertices_edited: edited,
        vertices_slid_back: simplified.slid_back,
        vertices_slid_edited: slid_edited,
        faces_removed: faces_before - mesh.face_count(),
        pieces_before,
        pieces,
    });
    let mut words = format!(
        "mend: {} sewn, {} -> {}",
        count(merged, "vertex", "vertices"),
        count(pieces_before, "piece", "pieces"),
        count(pieces, "piece", "pieces"),
    );
    let slid_back = count(simplified.slid_back, "vertex", "vertices");
    for (number, what, done) in [
        (
            taken_out,
            count(taken_out, "inserted vertex", "inserted vertices"),
            "removed",
        ),
        (simplified.slid_back, slid_back, "moved back"),
        (cuts_left, count(cuts_left, "cut", "cuts"), "left"),
    ] {
        if number > 0 {
            words += &format!(", {what} {done}");
        }
    }
    session.words.push(words);
    session.end(vertices_before, &mesh, mass);
    Ok(())
}

/// Writes pieces where they are that something was sewn to. Each part of one may have been written apart
/// from where it is by another way.
fn close_gaps(torn: &mut TornDocument<'_>, mesh: &Mesh, edits: &Edits, vertices_before: usize) {
    let mut is_sewn = vec![false; vertices_before];
    for edit in edits.iter() {
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
    for v in mesh.vertices().filter(|v| is_sewn[v.index()]) {
        piece(v)
            .into_iter()
            .for_each(|piece| is_closed[piece] = true);
    }
    torn.set_in_place(|v| piece(v).is_some_and(|piece| is_closed[piece]));
}

/// The document and its mesh, torn where its boundary lies on itself.
fn torn_at(document: Document, mesh: &Mesh) -> Result<(Document, Mesh), Stop> {
    if document.has_record() {
        let message =
            "`--coincident` is for a file without a record of its cuts, and this one has one";
        return Err(Stop::usage(
            message,
            "leave it out: the record is more exact",
        ));
    }
    let pairs = document.coincident(mesh);
    document.torn_at(&pairs).map_err(|error| {
        let edges = count(
            pairs.edges(),
            "pair of boundary edges",
            "pairs of boundary edges",
        );
        let message = format!("{edges} cannot be sewn: {error}");
        Fault::error("E-MEND-COINCIDENT", message).into()
    })
}

/// What is to be sewn.
fn stitches(
    args: &MendArgs,
    mesh: &Mesh,
    positions: &Positions,
    torn: &TornDocument<'_>,
) -> Vec<Stitch> {
    match (args.last, args.near.zip(args.radius)) {
        (Some(last), _) => torn.stitches_of_last(last.get()),
        (None, Some((centre, radius))) => {
            mend::stitches(mesh, |v| (positions.at(v) - centre).norm() <= radius)
        }
        (None, None) => mend::stitches(mesh, |_| true),
    }
}

/// Warns of vertices that stay where they are, because they were edited since.
fn kept(inserted: usize, slid: usize) -> impl Iterator<Item = Fault> {
    let all = [
        (
            inserted,
            "inserted vertex was edited since the cut and stays, as do the divided faces that depend on it",
            "inserted vertices were edited since the cut and stay, as do the divided faces that depend on them",
        ),
        (
            slid,
            "vertex that a cut moved was edited since and stays in place",
            "vertices that cuts moved were edited since and stay in place",
        ),
    ];
    let some = all.into_iter().filter(|&(number, ..)| number > 0);
    some.map(|(number, one, many)| Fault::warning("W-MEND-EDITED", count(number, one, many)))
}

/// Says which vertices are too far apart, by their numbers in the file.
fn too_far(error: &SewError, document: &Document) -> Stop {
    let mut faults: Vec<Fault> = Vec::new();
    for (stitch, why) in error.refused().iter().take(SHOWN) {
        let StitchError::Distance { distance } = why else {
            panic!("stitches are of one root, and masses are weights: {error}")
        };
        let message = format!(
            "the vertices {} and {} are {distance} apart",
            document.number_of_vertex(stitch.kept().index()),
            document.number_of_vertex(stitch.gone().index())
        );
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
