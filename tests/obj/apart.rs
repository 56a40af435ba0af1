//! Vertices that stand apart from where they are: both points are in the file, what nobody moved is
//! read where it is, and what somebody moved stays.

use tearmesh::{FaceId, Point, VertexId, mend, split};
use tearmesh_obj::Document;

use super::digest;
use super::random::Random;
use super::torn_damage::hash_of_faces;
use super::torn_record::{Work, assert_is_read_again, files};
use super::{read, rewritten, text};

/// Two triangles torn apart at vertices 2 and 3; the lip of the second stands apart.
const BODY: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1.25 0.5 0\nv 0 1.5 0\n\
    f 1 2 3\nf 6 5 4\n";

const ITEMS: &str = "#~ split 5 2 1\n#~ split 6 3 1\n#~ apart 5 1 0 0 1.25 0.5 0\n\
    #~ apart 6 0 1 0 0 1.5 0\n";

fn file(version: u8, items: &str) -> String {
    let faces = hash_of_faces(&[6, 0, 1, 2, 5, 4, 3]);
    let (count, sum) = (
        items.lines().count(),
        digest::after(digest::EMPTY, items.bytes()),
    );
    format!(
        "{BODY}#tearmesh record {version} v 6 f 2 vt 0 0 vn 0 0 faces {faces:016x}\n{items}\
         #tearmesh end {count} {sum:016x}\n"
    )
}

/// The codes, lines and messages of what is said of a document.
fn said(document: &Document) -> Vec<(&str, usize, &str)> {
    let all = document.diagnostics().iter();
    let told = all.map(|one| {
        (
            one.code,
            one.location.map_or(0, |at| at.line),
            &*one.message,
        )
    });
    told.collect()
}

#[test]
fn a_vertex_that_stands_apart_is_read_where_it_is() {
    let file = file(3, ITEMS);
    let document = read(file.as_bytes());
    assert_eq!(said(&document), []);
    assert_eq!(
        document.positions()[4..],
        [[1.0, 0.0, 0.0].into(), [0.0, 1.0, 0.0].into()]
    );
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn what_was_edited_since_is_told_from_what_stands_apart() {
    let file = file(3, ITEMS);
    let message = "`v` 5 was written apart from the other side of its cut and was edited since: it stays where it is now";
    let edited = file.replace("v 1.25 0.5 0\n", "v 1.25 0.5 1e-300\n");
    let document = read(edited.as_bytes());
    assert_eq!(said(&document), [("W-OBJ-RECORD-APART", 5, message)]);
    assert_eq!(
        document.positions()[4..],
        [[1.25, 0.5, 1e-300].into(), [0.0, 1.0, 0.0].into()]
    );
    let again = rewritten(edited.as_bytes());
    assert!(
        !text(&again).contains("apart 5") && text(&again).contains("#~ apart 6 0 1 0 0 1.5 0\n")
    );
    assert_eq!(rewritten(&again), again);
    // Who put it back by hand has edited it, too; and all of a file that was moved as a whole is.
    let moved = file
        .replace("v 1.25 0.5 0\n", "v 1 0 0\n")
        .replace("v 0 1.5 0\n", "v 0 1.5 2\n");
    let document = read(moved.as_bytes());
    let message = format!("{message}, and so do 1 more such");
    assert_eq!(said(&document), [("W-OBJ-RECORD-APART", 5, &*message)]);
    assert_eq!(
        document.positions()[4..],
        [[1.0, 0.0, 0.0].into(), [0.0, 1.5, 2.0].into()]
    );
}

#[test]
fn what_is_wrong_with_such_a_line_is_said() {
    let (range, points) = (
        "a number of this record is out of its range",
        "this record has a vertex without two usable points",
    );
    let head = "#~ split 5 2 1\n";
    for (items, message) in [
        ("#~ apart 7 1 0 0 2 0 0\n", range),
        ("#~ apart 0 1 0 0 2 0 0\n", range),
        ("#~ apart 5 1 0 0 2 0 0\n#~ apart 5 1 0 0 3 0 0\n", range),
        ("#~ apart 6 1 0 0 2 0 0\n#~ apart 5 1 0 0 3 0 0\n", range),
        ("#~ apart 5 1 0 0 2 0\n", points),
        ("#~ apart 5\n", points),
        ("#~ apart 5 1 0 0 2 0 1e90\n", points),
        (
            "#~ apart 5 1 0 0 2 0 0 1\n",
            "this line of a record has extra words",
        ),
        ("#~ apart 5 1 0 x 2 0 0\n", "cannot read number `x`"),
        (
            "#~ apart 5 1 0 0 1 0 0\n",
            "this record writes a vertex apart at its own position",
        ),
        (
            "#~ apart 5 1 0 0 2 0 0\n#~ slide 5 1 0 0 0 1 0 0\n",
            "this record has no line `slide` here",
        ),
    ] {
        let file = file(3, &format!("{head}{items}"));
        let document = read(file.as_bytes());
        let [(code, _, is)] = said(&document)[..] else {
            panic!("{items}: {:?}", said(&document));
        };
        assert_eq!((code, is), ("W-OBJ-RECORD", message), "{items}");
        // It is read as one without: everything stands where its `v` says.
        assert_eq!(document.positions()[4], [1.25, 0.5, 0.0].into(), "{items}");
    }
    let copy = file(3, "#~ fan 6 3\n#~ apart 6 0 1 0 0 1.5 0\n");
    assert_eq!(said(&read(copy.as_bytes()))[0].2, "vertex 6 is a copy");
    let earlier = file(2, ITEMS);
    assert_eq!(
        said(&read(earlier.as_bytes()))[0].2,
        "this record has no line `apart` here"
    );
    let earlier = file(2, "#~ split 5 2 1\n#~ split 6 3 1\n");
    assert_eq!(said(&read(earlier.as_bytes())), []);
}

/// A vertex with two fans, as a finite cut leaves it, is two `v`: both stand apart.
#[test]
fn copies_stand_where_their_vertex_does() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 1 0\nv -1 -1 0\n\
                f 1 2 6\nf 1 6 3\nf 1 3 4\nf 1 4 7\nf 1 7 5\nf 1 5 2\n";
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    let faces = [0, 3].map(|f| FaceId::new(f).expect("small"));
    let v = VertexId::new(0).expect("small");
    let made = work.edit(|mesh, _, edits| split::vertex(mesh, v, &faces, edits).is_ok());
    assert!(made);
    let mut points = work.positions.as_slice().to_vec();
    points[0] = Point::new(0.0, 0.0, 7.0);
    work.torn.set_apart(points);
    let written = text(&work.written());
    assert_eq!(written.matches("v 0 0 7\n").count(), 2, "{written}");
    let again = read(written.as_bytes());
    assert_eq!(said(&again), []);
    assert_eq!(again.mesh().as_ref(), Ok(&work.mesh));
    assert_eq!(again.positions(), work.positions.as_slice());
    assert_eq!(text(&rewritten(written.as_bytes())), written);
    // One of the two was moved: the other is where it is.
    for first in [true, false] {
        let at = if first {
            written.find("v 0 0 7\n")
        } else {
            written.rfind("v 0 0 7\n")
        };
        let at = at.expect("a copy");
        let moved = format!("{}v 0 0 9\n{}", &written[..at], &written[at + 8..]);
        let again = read(moved.as_bytes());
        let mesh = again.mesh().expect("a torn mesh");
        assert_eq!(mesh.vertex_count(), work.mesh.vertex_count() + 1);
        let heights = again.positions().iter().map(|p| p.z);
        assert_eq!(
            heights.filter(|&z| z != 0.0).collect::<Vec<_>>(),
            [9.0],
            "{first}"
        );
        let bytes = rewritten(moved.as_bytes());
        assert_eq!(rewritten(&bytes), bytes);
    }
}

/// Random cuts with vertices that stand apart at random, cut on and mended in another session.
#[test]
fn a_gap_changes_nothing_but_what_is_written() {
    let mut apart = 0;
    for (name, bytes) in files() {
        for seed in 0..6 {
            let mut random = Random(seed);
            let document = read(&bytes);
            let mut work = Work::on(&document);
            work.tear(&mut random, 12, true);
            work.torn.next_cut();
            let plain = work.written();
            let mut points = work.positions.as_slice().to_vec();
            for point in &mut points {
                let height = random.next();
                point.z += if height < 0.4 { 0.01 + height } else { 0.0 };
            }
            work.torn.set_apart(points);
            let written = work.written();
            let name = format!("{name} {seed}");
            apart += text(&written).matches("#~ apart ").count();
            let again = read(&written);
            assert_eq!(said(&again), said(&read(&plain)), "{name}");
            assert_eq!(again.positions(), read(&plain).positions(), "{name}");
            assert_is_read_again(&work, &again, &name);
            assert_eq!(rewritten(&written), written, "{name}");
            // The same is done to both, and then all is sewn and what was inserted taken out.
            let plain = read(&plain);
            let [one, other] = [&again, &plain].map(|document| {
                let mut random = Random(seed + 100);
                let mut work = Work::on(document);
                work.tear(&mut random, 6, true);
                let written = work.written();
                assert_eq!(rewritten(&written), written, "{name}");
                let all = mend::stitches(&work.mesh, |_| true);
                work.edit(|mesh, positions, edits| {
                    mend::sew(mesh, positions, &all, |_| 1.0, 1.0, edits).expect("one root")
                });
                let simple = work.torn.simplified(&work.mesh, &work.positions);
                let simple = simple.expect("it is read").document;
                let bytes = simple.map_or_else(
                    || work.written(),
                    |simple| {
                        let mesh = simple.mesh().expect("a mesh");
                        super::write_as(&simple, &mesh, &super::positions(&simple))
                    },
                );
                (
                    read(&bytes).positions().to_vec(),
                    read(&bytes).triangles().to_vec(),
                )
            });
            assert_eq!(one, other, "{name}");
        }
    }
    println!("{apart} vertices apart");
    assert!(apart > 1000, "{apart}");
}

/// What is merged stands where it is; a simulation that moves vertices leaves none apart.
#[test]
fn nothing_stands_apart_that_was_sewn_or_moved() {
    let file = file(3, ITEMS);
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    let all = mend::stitches(&work.mesh, |v| v.index() != 4);
    work.edit(|mesh, positions, edits| {
        mend::sew(mesh, positions, &all, |_| 1.0, 0.0, edits).expect("at one place")
    });
    let written = text(&work.written());
    assert!(
        written.contains("#~ apart 5 1 0 0 1.25 0.5 0\n#tearmesh end"),
        "{written}"
    );
    assert_eq!(written.matches("apart").count(), 1, "{written}");
    let elsewhere = work
        .positions
        .as_slice()
        .iter()
        .map(|p| [p.x, p.y, p.z + 1.0]);
    let elsewhere = tearmesh::Positions::new(elsewhere).expect("finite");
    let mut out = Vec::new();
    work.torn
        .write(&work.mesh, &elsewhere, &mut out)
        .expect("memory");
    assert!(!text(&out).contains("apart"));
}
