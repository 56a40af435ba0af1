//! Vertices that stand apart from where they are: both points are in the file, what nobody moved is
//! read where it is, and what somebody moved stays.

use tearmesh::{Point, mend};

use super::tables::{APART, whole};
use super::work::Work;
use super::{read, rewritten, text};

/// A vertex with two fans, as a finite cut leaves it, is two `v`: both stand apart.
#[test]
fn copies_stand_where_their_vertex_does() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 1 0\nv -1 -1 0\n\
                f 1 2 6\nf 1 6 3\nf 1 3 4\nf 1 4 7\nf 1 7 5\nf 1 5 2\n";
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("split 0 0 3");
    let mut points = work.positions.as_slice().to_vec();
    points[0] = Point::new(0.0, 0.0, 7.0);
    work.torn.set_apart(points);
    let written = text(&work.written());
    assert_eq!(written.matches("v 0 0 7\n").count(), 2, "{written}");
    let again = read(written.as_bytes());
    assert_eq!(again.diagnostics(), []);
    assert_eq!(again.mesh().as_ref(), Ok(&work.mesh));
    assert_eq!(again.positions(), work.positions.as_slice());
    assert_eq!(text(&rewritten(written.as_bytes())), written);
    // One of the two was moved: the other is where it is.
    for first in [true, false] {
        let mut copies = written.match_indices("v 0 0 7\n");
        let (at, _) = if first { copies.next() } else { copies.last() }.expect("a copy");
        let moved = format!("{}v 0 0 9\n{}", &written[..at], &written[at + 8..]);
        let again = read(moved.as_bytes());
        let mesh = again.mesh().expect("a torn mesh");
        assert_eq!(mesh.vertex_count(), work.mesh.vertex_count() + 1);
        let heights = again.positions().iter().map(|p| p.z);
        assert!(heights.filter(|&z| z != 0.0).eq([9.0]), "{first}");
        let bytes = rewritten(moved.as_bytes());
        assert_eq!(rewritten(&bytes), bytes);
    }
}

/// What is merged stands where it is; a simulation that moves vertices leaves none apart.
#[test]
fn nothing_stands_apart_that_was_sewn_or_moved() {
    let file = whole(APART);
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    let all = mend::stitches(&work.mesh, |v| v.index() != 4);
    work.sew(&all);
    let written = text(&work.written());
    assert!(
        written.contains("#~ apart 5 1 0 0 1.25 0.5 0\n#tearmesh end"),
        "{written}"
    );
    assert_eq!(written.matches("apart").count(), 1, "{written}");
    let elsewhere = work.positions.as_slice().iter();
    let elsewhere = elsewhere.map(|p| [p.x, p.y, p.z + 1.0]);
    work.positions = tearmesh::Positions::new(elsewhere).expect("finite");
    assert!(!text(&work.written()).contains("apart"));
}
