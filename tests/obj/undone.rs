//! Two cuts through files, of which the last is undone: the first stays as it was, and of the second
//! nothing stays.

use tearmesh::{CutMethod, HalfEdgeId, Point, Positions, Ray, Scissor, Vector, gap, shapes};
use tearmesh_obj::Document;

use super::random::Random;
use super::read;
use super::work::{Work, file_of, text};

/// How the cuts of a case are made.
#[derive(Debug)]
struct Options {
    snap: f64,
    snap_move: bool,
    /// How far the sides of cuts are written apart.
    gap: f64,
    /// Whether rays pass beside vertices, so that crossings snap, and the sheet is not flat.
    is_uneven: bool,
}

impl Options {
    /// Every combination, one after the other.
    fn of_case(case: u64) -> Options {
        let mut rest = case as usize;
        let mut one_of = |count: usize| {
            let one = rest % count;
            rest /= count;
            one
        };
        Options {
            snap_move: one_of(2) == 1,
            is_uneven: one_of(2) == 1,
            gap: [0.0, 0.05][one_of(2)],
            snap: [0.0, 0.02, Scissor::SNAP, 0.2, 0.45][one_of(5)],
        }
    }
}

/// Cuts between places on and beside the vertices of the sheet, so that cuts run along its edges, end on
/// them, and cross.
fn cut(work: &mut Work<'_>, random: &mut Random, options: &Options) {
    let mut place = || {
        let [x, y] = [(); 2].map(|()| (15.0 * random.next()).floor() / 2.0 - 2.0);
        let mut beside = || 0.2 * f64::from(u8::from(options.is_uneven)) * (random.next() - 0.5);
        Point::new((x + beside()) / 3.0, (y + beside()) / 3.0, 1.0)
    };
    let rays = [place(), place()].map(|place| Ray::new(place, -Vector::z()).expect("a ray"));
    let through = random.next() < 0.3;
    let Ok(scissor) = Scissor::new(rays[0], rays[1]) else {
        return;
    };
    work.edit(|mesh, positions, edits| {
        let scissor = scissor.with_through(through).with_snap(options.snap);
        let scissor = scissor.with_snap_move(options.snap_move);
        let done = scissor.cut(CutMethod::Exact, mesh, positions, edits);
        done.expect("in step");
    });
    let (_, points) = gap::gapped(&work.mesh, &work.positions, options.gap);
    work.torn.set_apart(points);
}

/// How long all tears are together, and how many pieces there are.
fn tears(document: &Document) -> (f64, usize) {
    let mesh = document.mesh().expect("a mesh");
    let is_first = |&h: &HalfEdgeId| mesh.ghost_pair(h).is_some_and(|ghost| h < ghost);
    let torn = mesh.half_edges().filter(is_first);
    let at = document.positions();
    let length = torn.map(|h| (at[mesh.target(h).index()] - at[mesh.origin(h).index()]).norm());
    (length.sum(), mesh.components().count())
}

/// A file with all its vertices where they are.
fn in_place(file: &[u8]) -> String {
    let document = read(file);
    let mut work = Work::on(&document);
    work.torn.set_in_place(|_| true);
    text(&work.written())
}

/// What is written once nothing more can be taken out, in place; no tear becomes longer, shorter or heals.
fn simplified(work: &Work<'_>, name: &str) -> String {
    let (written, [edited, slid_edited, _]) = work.simplified();
    assert_eq!(
        (edited, slid_edited),
        (0, 0),
        "{name}: nobody edited anything"
    );
    let [is, becomes] = [&work.written()[..], written.as_bytes()].map(|file| tears(&read(file)));
    let same = (is.0 - becomes.0).abs() < 1e-9 && is.1 == becomes.1;
    assert!(same, "{name}: {is:?} becomes {becomes:?}");
    in_place(written.as_bytes())
}

/// A sheet of nine squares, flat or not.
fn sheet(random: &mut Random, options: &Options) -> String {
    let (mesh, mut at) = shapes::grid(3, 3);
    if options.is_uneven {
        let uneven = at.as_slice().iter();
        let uneven = uneven.map(|p| p + Vector::z() * 0.3 * random.next());
        at = Positions::new(uneven.collect::<Vec<Point>>()).expect("small");
    }
    file_of(&mesh, &at)
}

#[test]
fn undoing_the_last_of_two_cuts_leaves_the_first_as_it_was() {
    let (mut slits, mut slid) = (0, 0);
    for case in 0..2_000 {
        let options = Options::of_case(case);
        let name = format!("case {case}, {options:?}");
        let mut random = Random(case);
        let file = sheet(&mut random, &options);
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        cut(&mut work, &mut random, &options);
        let bytes = work.written();
        let once = in_place(&bytes);
        let is_torn = work.torn.cuts().len() == 1;
        let first = simplified(&work, &name);
        if is_torn {
            assert_eq!(first, once, "{name}: nothing was mended");
        }
        let document = read(&bytes);
        let mut work = Work::on(&document);
        let before = work.torn.cuts();
        cut(&mut work, &mut random, &options);
        let bytes = work.written();
        let document = read(&bytes);
        let mut work = Work::on(&document);
        if work.torn.cuts().len() == before.len() {
            continue; // It tore nothing.
        }
        work.sew(&work.torn.stitches_of_last(1));
        assert_eq!(simplified(&work, &name), first, "{name}");
        slits += usize::from(is_torn);
        slid += usize::from(is_torn && once.contains("#~ slide"));
    }
    assert!(
        slits > 500 && slid > 60,
        "{slits}, {slid} of them with slides"
    );
}
