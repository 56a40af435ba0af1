//! The verb `cut`.

mod map;
mod pieces;
mod seam;

use std::ffi::OsString;
use std::io::Write;
use std::time::Instant;

use tearmesh::{
    COORDINATE_MAX, Cursor, Cut, CutEnd, CutLayers, CutMethod, CutTips, Edit, Edits, Masses,
    Positions, Scissor, gap,
};
use tearmesh_obj::TornDocument;

use self::map::Map;
use self::pieces::Pieces;
use crate::args::{CutArgs, Gap, Mass};
use crate::choice::Choice as _;
use crate::cuts::no_op::{self, NoOpReason};
use crate::cuts::scissors::{self, Along, no_plane};
use crate::cuts::summary;
use crate::exit::{Exit, Stop};
use crate::files::Names;
use crate::measure::{Bounds, Edges, written_area};
use crate::picture::Texture;
use crate::rays;
use crate::say::{Fault, short};
use crate::session::{self, Session, milliseconds};
use crate::streams::Streams;
use crate::{output, report, weld};

/// Cuts, says what was done, and gives the exit status. `typed` is for the reproducer.
pub(crate) fn run(args: &CutArgs, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let (files, names) = (&args.files, names(args));
    Session::run("cut", files, &names, typed, streams, |session| {
        check(args)?;
        work(args, session)
    })
}

/// The files of a cut, but for its pieces.
fn names(args: &CutArgs) -> Names<'_> {
    let read = [(args.rays_file.as_deref(), "the rays")];
    let written = [
        ("--seam", &args.seam, "the seam"),
        ("--map", &args.map, "the map"),
    ];
    Names::new(&args.files, &read, &written)
}

fn work(args: &CutArgs, session: &mut Session<'_, '_>) -> Result<(), Stop> {
    let cuts = scissors::cuts(args, session.streams)?;
    for pair in cuts.iter().filter_map(Along::rays) {
        // Rays that span no plane are refused before a large file is read.
        scissors::of_rays(pair, &mut session.faults)?;
    }
    let pieces = Pieces::of(args, &names(args))?;
    let mut opened = session.open(session::repair(args.repair, args.separate_fans))?;
    let seams = weld::seams(
        &mut opened,
        args.weld,
        &mut session.words,
        &mut session.faults,
    )?;
    let (document, mut mesh, mut positions) = (opened.document, opened.mesh, opened.positions);
    let vertices_before = mesh.vertex_count();
    let masses = match args.mass {
        Mass::Area => Masses::area(&mesh, &positions, 1.0),
        Mass::Half => Masses::half(&mesh, &positions, 1.0),
    };
    let mut masses = masses.map_err(Fault::from)?;

    let start = Instant::now();
    // Seams that coincide are closed while cuts are made, so that none of them opens one.
    let mut closed = seams.close(&mut mesh);
    let mut edits = Edits::new();
    let (mut torn, mut texture) = (TornDocument::new(&document), Texture::of(&document));
    let area_before = written_area(&torn, &mesh, &positions);
    let gap = args.gap.map(|gap| match gap {
        Gap::Length(length) => length,
        Gap::Edges(part) => part * Edges::of(&mesh, &positions).mean,
    });
    let mut map = args.map.as_ref().map(|_| Map::new(&document));
    let mut slid = false;
    let mut line = Polyline::default();
    let through = args.through || !args.plane.is_empty();
    let how = (args.method, through);
    let mut lines = Vec::new();
    for (i, along) in cuts.iter().enumerate() {
        let number = (cuts.len() > 1).then_some(i + 1);
        let scissor = scissor(args, along, &line, &positions)?;
        let aimed = scissor.aimed_at(&mesh, &positions);
        let made = aimed.and_then(|scissor| {
            let (mesh, positions) = (&mut mesh, &mut positions);
            let made = scissor.cut_measured(args.method, mesh, positions, &mut edits)?;
            Ok((scissor, made))
        });
        let refused = |error| scissors::refused(number, error, &positions);
        let (scissor, (cut, done)) = made.map_err(refused)?;
        slid |= edits.iter().any(|edit| matches!(edit, Edit::Slide(_)));
        edits.replay(&mut (&mut masses, &mut torn, &mut closed));
        texture.follow(&edits);
        if let Some(map) = &mut map {
            edits.replay(map);
        }
        line.go_on(&edits, &cut);
        edits.clear();
        torn.next_cut();
        let chosen = (args.layers == CutLayers::First).then_some(&cut);
        let mut entry = report::Cut::new(along.rays(), &scissor, how, &done, chosen);
        session.words.push(summary::cut(number, &done));
        if let Some(pair) = along.rays().filter(|_| args.camera.camera.is_some()) {
            let typed = rays::typed(pair);
            session.words.push(format!("the same as {typed}"));
            entry.equivalent = Some(typed);
        }
        let how_cut = (&scissor, args.method, args.snap);
        let reason = match done.splits {
            0 => no_op::reason(how_cut, through, (&mesh, &positions), &done),
            _ => NoOpReason::Unknown,
        };
        let extent = done.missed.then(|| Bounds::of(&mesh, &positions));
        let warnings = summary::warnings(number, &entry, reason, extent);
        session.faults.extend(warnings);
        session.report.cuts.push(entry);
        session.faults.extend(summary::of_layers(number, &cut));
        lines.push(seam::lines(&cut, &mesh, &positions));
    }
    closed.reopen(&mut mesh);
    session.timing.cut = milliseconds(start);

    let ledger = masses.ledger();
    drop(masses); // To check and to write take the most memory.
    let moved = || session::moved(&document, &mesh, &positions);
    let broken = (!slid).then(moved).flatten();
    let mass = session.verify(&mesh, &ledger, report::AREA, broken)?;
    if edits.cursor() == Cursor::START && !args.allow_miss {
        return Err(session.nothing_done());
    }
    let mut shown = None;
    if let Some(gap) = gap {
        let (gapped, points) = gap::gapped(&mesh, &positions, gap);
        Positions::new(points.iter().copied()).map_err(|_| too_wide(gap))?;
        session.words.push(summary::gap(&gapped));
        session.faults.extend(summary::of_gap(&gapped));
        session.report.gap = Some(gapped);
        shown = Some(points.clone());
        torn.set_apart(points);
    }
    let fill = |mut out: &mut dyn Write| torn.write(&mesh, &positions, &mut out);
    session.write(&mesh, fill)?;
    let shown = shown.as_deref().unwrap_or(positions.as_slice());
    session.show_mesh(&document, &mesh, shown, args.camera.up.coords, &texture)?;
    session.show_page(&mesh, shown, args.camera.up.coords)?;
    if let Some(path) = args.files.wanted(&args.seam) {
        output::write(path, |out| seam::write(&lines, out))?;
    }
    if let Some((path, map)) = args.files.wanted(&args.map).zip(map) {
        let files = [&session.report.input, &session.report.output];
        let names = files.map(|file| file.as_ref().and_then(|file| file.path.as_deref()));
        output::write(path, |out| map.write(&torn, &mesh, names, out))?;
    }
    if let Some(pieces) = pieces {
        let written = pieces.write(&torn, &mesh, &positions)?;
        session.words.push(pieces::words(&written));
        session.report.pieces = Some(written);
    }
    session.report.area = Some(report::Area {
        before: area_before,
        after: written_area(&torn, &mesh, &positions),
    });
    session.end(vertices_before, &mesh, mass);
    Ok(())
}

/// Cuts of which each begins with the ray that ended the one before: where the first began, and where
/// the last ended.
#[derive(Default)]
struct Polyline {
    ends: Option<[CutEnd; 2]>,
}

impl Polyline {
    /// Notes a cut. The log is that of this cut alone.
    fn go_on(&mut self, edits: &Edits, cut: &Cut) {
        let before = self.ends.take();
        self.ends = cut.ends().map(|[begin, end]| {
            let goes_on = |[_, last]: &[CutEnd; 2]| last.ray().is_along(&begin.ray());
            let first = before.filter(goes_on).map(|[mut first, _]| {
                edits.replay(&mut first);
                first
            });
            [first.unwrap_or_else(|| begin.clone()), end.clone()]
        });
    }
}

/// The scissor of a cut, by the options. That of two rays goes on from where the last cut ended if that
/// ended with the first of them, and ends where the first of those cuts began if it comes back there.
fn scissor(
    args: &CutArgs,
    along: &Along,
    line: &Polyline,
    positions: &Positions,
) -> Result<Scissor, Stop> {
    let scissor = match along {
        Along::Plane(plane) => Scissor::by_plane(*plane),
        Along::Rays(pair) => {
            let goes_on = |[_, last]: &&[CutEnd; 2]| last.ray().is_along(&pair[0]) && !args.through;
            let scissor = match line.ends.as_ref().filter(goes_on) {
                Some([first, last]) if first.ray().is_along(&pair[1]) => {
                    Scissor::closed(last, first, positions)
                }
                Some([_, last]) => Scissor::continued(last, pair[1], positions),
                None => Scissor::new(pair[0], pair[1]),
            };
            scissor.map_err(|error| no_plane(pair, error))?
        }
    };
    let scissor = scissor.with_through(args.through).with_tips(args.tips);
    let scissor = scissor.with_layers(args.layers).with_snap(args.snap);
    Ok(scissor.with_snap_move(args.snap_move))
}

/// That a gap moves vertices to where no verb could read them.
fn too_wide(gap: f64) -> Stop {
    let (gap, limit) = (short(gap), short(COORDINATE_MAX));
    let message = format!("a gap of {gap} moves vertices beyond {limit}, the largest coordinate");
    Stop::usage(message, "give a smaller --gap")
}

/// Refuses options that do not go together: when, what is said, and what helps.
fn check(args: &CutArgs) -> Result<(), Stop> {
    let method = args.method.word();
    let is_exact = args.method == CutMethod::Exact;
    let refused = |message: &str, help: &str| Err(Stop::usage(message, help));
    if args.layers == CutLayers::First && !args.plane.is_empty() {
        let message = "`--layers first` is for rays: with a plane, no ray hits a layer first";
        let help = "cut with --rays or --camera, or leave out --layers";
        return refused(message, help);
    }
    if args.tips == CutTips::Midpoint && args.method != CutMethod::Partition {
        let message = format!("`--tips midpoint` is for the method partition, not {method}");
        return refused(&message, "leave it out, or add --method partition");
    }
    if args.mass == Mass::Half && is_exact {
        let message =
            "`--mass half` cannot follow inserted vertices, and the method exact inserts some";
        return refused(message, "use --mass area, or --method partition");
    }
    if args.snap_move && !is_exact {
        let message = format!("`--snap-move` is for the method exact, not {method}");
        return refused(&message, "leave it out: the other methods move no vertex");
    }
    Ok(())
}
