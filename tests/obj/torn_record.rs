//! Torn and divided meshes through a file and back: splits, insertions and merges at random.

use std::collections::BTreeMap;

use tearmesh::insert::Plan;
use tearmesh::{Point, mend};
use tearmesh_obj::Document;

use super::random::Random;
use super::work::{Work, assert_is_read_again, files};
use super::{read, rewritten, text};

/// What must hold of a mesh that is written, read and written again.
pub(crate) fn survives(work: &Work<'_>, name: &str) -> Vec<u8> {
    let written = work.written();
    let again = read(&written);
    // No quad is left when a document is written.
    let said = |document: &Document| {
        let all = document.diagnostics().iter();
        all.filter(|one| one.code != "W-OBJ-QUAD").count()
    };
    assert_eq!(said(&again), said(work.torn.document()), "{name}");
    assert_is_read_again(work, &again, name);
    let in_order = work.in_order().into_iter();
    let places: Vec<Point> = in_order.map(|v| work.positions.at(v)).collect();
    assert_eq!(again.positions(), places, "{name}");
    assert_eq!(text(&rewritten(&written)), text(&written), "{name}");
    let followed = Work::on(&again);
    assert_eq!(followed.torn.cuts(), work.torn.cuts(), "{name}");
    assert_eq!(followed.joined(), work.joined(), "{name}");
    assert_eq!(text(&followed.written()), text(&written), "{name}");
    written
}

#[test]
fn mending_cuts_gives_back_what_was_written_before_them() {
    for (name, bytes) in files() {
        for seed in 0..4 {
            let mut random = Random(100 + seed);
            let name = format!("{name}, seed {seed}");
            let document = read(&bytes);
            let mut work = Work::on(&document);
            let mut before = Vec::new();
            for _ in 0..3 {
                before.push(text(&work.written()));
                let more = if name.starts_with("late") { 1 } else { 6 };
                let count = work.mesh.vertex_count() + more;
                while work.mesh.vertex_count() < count {
                    work.split(&mut random);
                }
                work.torn.next_cut();
            }
            let file = work.written();
            let mut later = read(&file);
            for state in before.iter().rev() {
                work.sew(&work.torn.stitches_of_last(1));
                assert_eq!(&text(&work.written()), state, "{name}");
                // The same by way of the file.
                let mut work = Work::on(&later);
                work.sew(&work.torn.stitches_of_last(1));
                let file = work.written();
                assert_eq!(&text(&file), state, "{name}, by way of a file");
                later = read(&file);
            }
            assert!(!text(&work.written()).contains("#tearmesh"), "{name}");
        }
    }
}

/// What is still open stays, and everything round it that is not may go.
#[test]
fn a_part_is_simplified_and_the_rest_still_can_be() {
    let mut parts = 0;
    for (name, bytes) in files() {
        let uncut = text(&rewritten(&bytes));
        for seed in 0..20 {
            let mut random = Random(300 + seed);
            let document = read(&bytes);
            let mut work = Work::on(&document);
            work.tear(&mut random, 30, false);
            let chosen: Vec<bool> = work.mesh.vertices().map(|_| random.below(3) > 0).collect();
            work.sew(&mend::stitches(&work.mesh, |v| chosen[v.index()]));
            let (written, counts) = work.simplified();
            assert_eq!(counts, [0; 3], "{name}, seed {seed}");
            parts += usize::from(written != text(&work.written()));
            let simple = read(written.as_bytes());
            let mut rest = Work::on(&simple);
            assert!(rest.mesh.check().is_empty());
            survives(&rest, &name);
            assert_eq!(rest.simplified().0, written, "{name}, seed {seed}");
            assert_eq!(area(&rest), area(&work), "{name}, seed {seed}");
            assert_eq!(rest.undone(), uncut, "{name}, seed {seed}");
        }
    }
    assert!(parts > 20, "{parts}");
}

/// To nine digits.
fn area(work: &Work<'_>) -> String {
    let of = |f| {
        let corners = work.mesh.face_vertices(f);
        let [a, b, c]: [Point; 3] = corners.map(|v| work.positions.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    format!("{:.9}", work.mesh.faces().map(of).sum::<f64>())
}

/// Corner by corner: an inserted index is that of both sides where both sides had the same two.
#[test]
fn both_sides_of_an_edge_share_an_index_where_they_did() {
    // Faces 1 and 2 have the same indices along 2-3; faces 2 and 3 have others along 3-4.
    let file =
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 5 5\n\
vt 6 6\nvn 1 0 0\nvn 0 1 0\nf 1/1/1 2/2/1 3/3/2\nf 3/3/2 2/2/1 4/4/2\nf 3/5/2 4/6/2 5/4/2\n";
    for tear in [false, true] {
        let document = read(file);
        let mut work = Work::on(&document);
        if tear {
            work.deeds("split 1 0, split 2 0");
        }
        work.edit(|mesh, _, edits| {
            let mut plan = Plan::new();
            plan.on_edge(mesh.half_edge(1), 0.25); // 2-3
            plan.on_edge(mesh.half_edge(6), 0.5); // 3-4
            plan.apply(mesh, edits).expect("two points");
        });
        let written = work.written();
        let again = read(&written);
        // One for 2-3, and for 3-4 one on each side; the normals of 3-4 are one.
        assert_eq!(again.texture_count(), 6 + 3, "{}", text(&written));
        let texture: Vec<&[f64]> = (6..9).map(|i| again.texture(i)).collect();
        assert_eq!(texture, [[0.75, 0.25], [0.5, 1.0], [5.5, 5.5]]);
        let [x, y, z] = again.normals()[2];
        assert_eq!(again.normals().len(), 3);
        assert!((x - 3.0 * y).abs() < 1e-15 && z == 0.0 && (x.hypot(y) - 1.0).abs() < 1e-15);
        let mut users = BTreeMap::new();
        for triangle in 0..again.triangles().len() {
            for corner in 0..3 {
                let texture = again.corner(triangle, corner).texture;
                *users.entry(texture).or_insert(0) += 1;
            }
        }
        assert_eq!(
            users[&Some(6)],
            5,
            "2 corners of one face and 3 of the other"
        );
    }
}
