//! Two cuts through files, of which the last is undone: the first stays as it was, and of the second
//! nothing stays.

use tearmesh::{CutMethod, HalfEdgeId, Point, Ray, Scissor, Vector};
use tearmesh_obj::Document;

use super::random::Random;
use super::read;
use super::work::{Work, file_of};

/// Cuts between places on and beside the vertices of the sheet, so that cuts run along its edges, end on
/// them, and cross.
fn cut(work: &mut Work<'_>, random: &mut Random) {
    let mut place = || {
        let [x, y] = [(); 2].map(|()| (15.0 * random.next()).floor() / 2.0 - 2.0);
        Point::new(x / 3.0, y / 3.0, 1.0)
    };
    let rays = [place(), place()].map(|place| Ray::new(place, -Vector::z()).expect("a ray"));
    let through = random.next() < 0.3;
    let Ok(scissor) = Scissor::new(rays[0], rays[1]) else {
        return;
    };
    work.edit(|mesh, positions, edits| {
        let scissor = scissor.through(through);
        let done = scissor.cut(CutMethod::Exact, mesh, positions, edits);
        done.expect("in step");
    });
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

/// What is written once nothing more can be taken out; no tear becomes longer, shorter or heals.
fn simplified(work: &Work<'_>, name: &str) -> String {
    let (written, [edited, ..]) = work.simplified();
    assert_eq!(edited, 0, "{name}: nobody edited anything");
    let [is, becomes] = [&work.written()[..], written.as_bytes()].map(|file| tears(&read(file)));
    let same = (is.0 - becomes.0).abs() < 1e-9 && is.1 == becomes.1;
    assert!(same, "{name}: {is:?} becomes {becomes:?}");
    written
}

#[test]
fn undoing_the_last_of_two_cuts_leaves_the_first_as_it_was() {
    let (mesh, at) = tearmesh::shapes::grid(3, 3);
    let file = file_of(&mesh, &at);
    let mut slits = 0;
    for seed in 0..600 {
        let name = format!("case {seed}");
        let mut random = Random(seed);
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        cut(&mut work, &mut random);
        let first = simplified(&work, &name);
        let bytes = work.written();
        let once = read(&bytes);
        let mut work = Work::on(&once);
        let before = work.torn.cuts();
        cut(&mut work, &mut random);
        let bytes = work.written();
        let twice = read(&bytes);
        let mut work = Work::on(&twice);
        if work.torn.cuts().len() == before.len() {
            continue; // It tore nothing.
        }
        work.sew(&work.torn.stitches_of_last(1));
        assert_eq!(simplified(&work, &name), first, "{name}");
        slits += usize::from(before.len() == 1);
    }
    assert!(slits > 150, "{slits}");
}
