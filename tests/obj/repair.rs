//! Repairs: what is done, what is said, and what stays as it was.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use tearmesh::Defect;
use tearmesh_obj::{Document, Repair};

use super::refuse::unescaped;
use super::{positions, read, rewritten, text, write_as};

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nv 2 2 2\n";

fn said(document: &Document) -> Vec<String> {
    let repairs = document.diagnostics().iter();
    let repairs = repairs.filter(|one| one.code.starts_with("W-OBJ-REPAIR"));
    repairs
        .map(|one| format!("{one}  [{}]", one.code))
        .collect()
}

/// Repairs faces over [`VERTICES`]: what is said, and the vertices and faces of the file then.
fn check(repair: Repair, faces: &str, expected: &[&str], written: &str) {
    let document = read(format!("{VERTICES}{faces}").as_bytes()).repaired(repair);
    assert_eq!(said(&document), expected, "{faces}");
    let mesh = document.mesh().unwrap_or_else(|error| panic!("{error}"));
    let bytes = write_as(&document, &mesh, &positions(&document));
    let all = text(&bytes);
    assert_eq!(all.strip_prefix(VERTICES).expect("as before"), written);
    assert_eq!(text(&rewritten(&bytes)), all, "written again");
}

/// Each block is a repair and the faces, then what is said, and the vertices and faces of the file then.
#[test]
fn files_of_the_table_are_repaired_with_these_words() {
    let mut cases = 0;
    let (mut repair, mut faces, mut expected) = (Repair::All, String::new(), Vec::new());
    for line in include_str!("repairs.txt").lines() {
        if let Some(words) = line.strip_prefix("    ") {
            expected.push(words);
        } else if let Some(written) = line.strip_prefix("  = ") {
            check(repair, &faces, &expected, &text(&unescaped(written)));
            expected.clear();
            cases += 1;
        } else if let Some((name, given)) = line.split_once(": ") {
            repair = match name {
                "fans" => Repair::SeparateFans,
                "all" => Repair::All,
                _ => continue, // A heading.
            };
            faces = text(&unescaped(given));
        }
    }
    assert_eq!(cases, 10);
}

#[test]
fn three_fans_of_a_vertex_become_three_vertices() {
    let file = format!("{VERTICES}v 3 3 3\nf 1 2 3\nf 1 4 5\nf 6 7 1\n");
    let document = read(file.as_bytes()).repaired(Repair::SeparateFans);
    assert_eq!(document.triangles(), [[0, 1, 2], [7, 3, 4], [5, 6, 8]]);
    assert!(document.mesh().is_ok());
}

#[test]
fn separating_fans_drops_no_face_and_a_flipped_face_is_never_turned() {
    for (repair, faces, code) in [
        (
            Repair::SeparateFans,
            "f 1 2 3\nf 2 3 1\n",
            "E-MESH-DUPLICATE",
        ),
        (Repair::SeparateFans, "f 1 2 3\nf 3 2 1\n", "E-MESH-PILLOW"),
        (
            Repair::SeparateFans,
            "f 1 2 3\nf 2 1 4\nf 1 2 5\n",
            "E-MESH-EDGE",
        ),
        (Repair::All, "f 1 2 3\nf 1 2 4\n", "E-MESH-FLIP"),
        // Without its duplicate, the first face has a flipped neighbour.
        (Repair::All, "f 1 2 3\nf 1 2 3\nf 1 2 4\n", "E-MESH-FLIP"),
    ] {
        let document = read(format!("{VERTICES}{faces}").as_bytes()).repaired(repair);
        let error = document.mesh().expect_err("beyond this repair");
        let codes: Vec<_> = error.shown().iter().map(|one| one.code).collect();
        assert_eq!(codes, [code], "{faces}");
    }
}

#[test]
fn everything_else_of_the_document_stays() {
    let file = "# robe\no a\nv 0 0 0 0.5 1 0\nnl 7\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\nusemtl my mat\n\
                o b\nv 1 1 1\nv 2 1 1\nvt 0.25\nv 3 2 1\nnv 1 2 3\n# end\nf 1/1 4/1 5/1\nf 4 6 5\nf 4 6 5\np 1 -1\n";
    let document = read(file.as_bytes()).repaired(Repair::All);
    let mesh = document.mesh().unwrap_or_else(|error| panic!("{error}"));
    let written = write_as(&document, &mesh, &positions(&document));
    assert_eq!(
        text(&written),
        "# robe\no a\nv 0 0 0 0.5 1 0\nnl 7\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\nusemtl my mat\n\
         o b\nv 1 1 1\nv 2 1 1\nvt 0.25\nv 3 2 1\nnv 1 2 3\nv 0 0 0 0.5 1 0\n# end\n\
         f 7/1 4/1 5/1\nf 4 6 5\np 1 6\n",
    );
    assert_eq!(text(&rewritten(&written)), text(&written));
    // New vertices stand on the line of the one that they are copies of.
    let lines: Vec<_> = (0..7).map(|v| document.line_of_vertex(v)).collect();
    assert_eq!(lines, [3, 5, 6, 11, 12, 14, 3]);
    let lines: Vec<_> = (0..3).map(|t| document.line_of_triangle(t)).collect();
    assert_eq!(lines, [8, 17, 18]);
}

#[test]
fn what_arcsim_says_of_a_vertex_is_not_said_of_its_new_fans() {
    let start = "v 0 0 0\nnl 7\n# a\nnv 1 2 3\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\n";
    for (end, written) in [
        ("nl 9\n# b\n", "nl 9\nv 0 0 0\n# b\n"),
        ("vt 0\nvv 9\n# b\n", "v 0 0 0\nvt 0\nvv 9\n# b\n"),
    ] {
        let document = read(format!("{start}{end}f 1 2 3\nf 1 4 5\n").as_bytes());
        let document = document.repaired(Repair::SeparateFans);
        assert_eq!(
            document
                .diagnostics()
                .last()
                .map(ToString::to_string)
                .as_deref(),
            Some(
                "line 1: copies of vertices do not have what `nl`, `ny`, `nv` or `vv` says of these (2 statements, the first of this one)"
            )
        );
        let mesh = document.mesh().expect("repaired");
        let out = write_as(&document, &mesh, &positions(&document));
        assert_eq!(text(&out), format!("{start}{written}f 1 2 3\nf 6 4 5\n"));
        assert_eq!(text(&rewritten(&out)), text(&out));
    }
}

#[test]
fn a_mesh_is_returned_as_it_is() {
    let file = format!("{VERTICES}f 1 2 3\nf 3 2 4 5\n# end\n");
    let document = read(file.as_bytes());
    let before = format!("{document:?}");
    assert_eq!(format!("{:?}", document.repaired(Repair::All)), before);
}

#[test]
fn a_hundred_repairs_of_a_kind_are_reported_one_by_one() {
    let mut file = String::new();
    for i in 0..150 {
        file += &"v 0 0 0\n".repeat(5);
        let v = |n| 5 * i + n;
        file += &format!("f {} {} {}\n", v(1), v(2), v(3)).repeat(2);
        file += &format!("f {} {} {}\n", v(1), v(4), v(5));
    }
    let document = read(file.as_bytes()).repaired(Repair::All);
    let said = said(&document);
    assert_eq!(said.len(), 202);
    assert_eq!(
        said[100],
        "line 807: and 50 more faces are dropped (the first here)  [W-OBJ-REPAIR-DUPLICATE]"
    );
    assert_eq!(
        said[201],
        "line 801: and 50 more vertices with several fans get new vertices (the first here)  \
         [W-OBJ-REPAIR-BOWTIE]"
    );
    assert!(said[200].contains("the new vertex 850"), "{}", said[200]);
    assert_eq!(document.positions().len(), 900);
    assert!(document.mesh().is_ok());
}

/// What the rules say, by lists: which triangles stay.
fn naive(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let sorted = |mut t: [u32; 3]| {
        t.sort_unstable();
        t
    };
    let edges = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    let mut seen = BTreeSet::new();
    let first: Vec<_> = triangles
        .iter()
        .copied()
        .filter(|&t| seen.insert(sorted(t)))
        .collect();
    let mut faces_of = BTreeMap::<_, usize>::new();
    for (a, b) in first.iter().flat_map(|&t| edges(t)) {
        *faces_of.entry((a.min(b), a.max(b))).or_default() += 1;
    }
    let mut taken = BTreeSet::new();
    let mut kept = Vec::new();
    for t in first {
        let crowded = edges(t)
            .into_iter()
            .filter(|&(a, b)| faces_of[&(a.min(b), a.max(b))] > 2);
        if crowded.clone().all(|edge| !taken.contains(&edge)) {
            taken.extend(crowded);
            kept.push(t);
        }
    }
    kept
}

proptest! {
    #![proptest_config(super::properties(8))]

    /// Any triangles and quads: what is left is a mesh, or refused for flipped faces alone; and
    /// the faces that stay are those that the rules name, with the corners that they had.
    #[test]
    fn what_is_left_after_all_repairs_has_no_defect_but_flipped_faces(
        faces in prop::collection::vec(
            (prop::sample::subsequence((1..=9).collect::<Vec<u32>>(), 3..=4), any::<bool>()), 1..14),
    ) {
        let mut file: String = (1..=9u32).map(|v| format!("v {} {} {} 0.{v}\nvt {v}\n", v * v % 7, v * v * v % 11, v % 3)).collect();
        for (corners, flipped) in faces {
            file += "f";
            let mut corners = corners;
            if flipped {
                corners.reverse();
            }
            for v in corners {
                file += &format!(" {v}/{v}");
            }
            file += "\n";
        }
        let document = read(file.as_bytes());
        let repaired = document.clone().repaired(Repair::All);
        let roots: Vec<[u32; 3]> = (0..repaired.triangles().len())
            .map(|t| [0, 1, 2].map(|c| repaired.corner(t, c).texture.expect("all have one")))
            .collect();
        prop_assert_eq!(&roots, &naive(document.triangles()));
        for (t, root) in repaired.triangles().iter().zip(&roots) {
            for (&v, &root) in t.iter().zip(root) {
                let (v, root) = (v as usize, root as usize);
                prop_assert_eq!(repaired.positions()[v], document.positions()[root]);
                prop_assert_eq!(repaired.extra_numbers(v), document.extra_numbers(root));
            }
        }
        let Ok(mesh) = repaired.mesh() else {
            let error = repaired.mesh().expect_err("a flip");
            let is_flip = |defect: &Defect| matches!(defect, Defect::FlippedFace { .. });
            prop_assert!(error.error().defects().iter().all(is_flip), "{error}\n{file}");
            return Ok(());
        };
        let written = write_as(&repaired, &mesh, &positions(&repaired));
        prop_assert_eq!(text(&rewritten(&written)), text(&written));
        let again = read(&written);
        prop_assert_eq!(again.triangles(), repaired.triangles());
    }
}
