//! Repairs by the rules, and how many of them are told; what is done and said is in `files.txt`.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use tearmesh::Defect;
use tearmesh_obj::Repair;

use super::{positions, read, rewritten, text, write_as};

#[test]
fn copies_stand_on_the_line_of_the_last_vertex() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\nf 1 4 5\n";
    let document = read(file.as_bytes()).repaired(Repair::All);
    let lines = (0..6).map(|v| document.line_of_vertex(v));
    assert!(lines.eq([1, 2, 3, 5, 6, 6]));
    let lines = (0..2).map(|t| document.line_of_triangle(t));
    assert!(lines.eq([7, 8]));
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
    let said = document.diagnostics().iter();
    let said: Vec<String> = said.map(|one| format!("{one}  [{}]", one.code)).collect();
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
    #![proptest_config(super::properties())]

    /// Any triangles and quads: what is left is a mesh, or refused for flipped faces alone; and
    /// the faces that stay are those that the rules name, with the corners that they had.
    #[test]
    fn repairs_leave_no_defect_but_flipped_faces(
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
