//! Two cuts through files, of which the last is undone: the first stays as it was, and of the second
//! nothing stays.

use tearmesh::{CutMethod, Point, Ray, Scissor, Vector};
use tearmesh_obj::{Document, Simplified};

use super::random::Random;
use super::torn_record::Work;
use super::{positions, read, text, write_as};

/// A sheet with texture coordinates.
fn sheet() -> String {
    let (mesh, at) = tearmesh::shapes::grid(3, 3);
    let mut file = String::from("vt 0.25 0.5\nvt 1 0\nvt 0 1\n");
    for p in at.as_slice() {
        file += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| v.index() + 1);
        file += &format!("f {a}/1 {b}/2 {c}/3\n");
    }
    file
}

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
    let torn = mesh
        .half_edges()
        .filter(|&h| mesh.ghost_pair(h).is_some_and(|ghost| h < ghost));
    let at = document.positions();
    let length = torn.map(|h| (at[mesh.target(h).index()] - at[mesh.origin(h).index()]).norm());
    (length.sum(), mesh.components().count())
}

/// What is written once nothing more can be taken out; no tear becomes longer, shorter or heals.
fn simplified(work: &Work<'_>, name: &str) -> String {
    let before = read(&work.written());
    let simplified = work.torn.simplified(&work.mesh, &work.positions);
    let Simplified {
        document, edited, ..
    } = simplified.expect("what we wrote");
    assert_eq!(edited, 0, "{name}: nobody edited anything");
    let Some(document) = document else {
        return text(&work.written());
    };
    let (is, becomes) = (tears(&before), tears(&document));
    let same = (is.0 - becomes.0).abs() < 1e-9 && is.1 == becomes.1;
    assert!(same, "{name}: {is:?} becomes {becomes:?}");
    let mesh = document.mesh().expect("a mesh");
    text(&write_as(&document, &mesh, &positions(&document)))
}

#[test]
fn undoing_the_last_of_two_cuts_leaves_the_first_as_it_was() {
    let file = sheet();
    let (mut crossed, mut slits) = (0, 0);
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
        crossed += usize::from(first.contains("#~ split"));
    }
    println!("{slits} times two cuts, and {crossed} with a tear that stays");
    assert!(slits > 150, "{slits}");
}
