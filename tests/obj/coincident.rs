//! Boundary edges that lie on each other, in files whose record was dropped.

use std::collections::BTreeMap;

use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{Mesh, Positions, mend};
use tearmesh_obj::Document;

use super::plain::Plain;
use super::random::Random;
use super::work::{Work, files};
use super::{read, text};

/// A file as a program writes it that knows no comments.
fn without_comments(bytes: &[u8]) -> String {
    let lines = text(bytes);
    let lines = lines.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| format!("{line}\n")).collect()
}

/// The mesh of a document, and its seams that coincide.
fn seams(document: &Document) -> (Mesh, UnsewnSeams) {
    let mesh = document.mesh().expect("each fan has its own vertices");
    let positions = Positions::new(document.positions().iter().copied()).expect("finite");
    let seams = UnsewnSeams::find(&mesh, &positions);
    (mesh, seams)
}

/// The same file with minus zero for every other zero of its places.
fn with_minus_zeros(file: &str) -> String {
    let mut is_next = false;
    let mut signed = |word: &str| {
        is_next ^= word == "0";
        let sign = if word == "0" && is_next { "-" } else { "" };
        format!("{sign}{word}")
    };
    let lines = file.lines().map(|line| match line.strip_prefix("v ") {
        Some(places) => {
            let words: Vec<_> = places.split(' ').map(&mut signed).collect();
            format!("v {}\n", words.join(" "))
        }
        None => format!("{line}\n"),
    });
    lines.collect()
}

/// How many edges two faces have at one place.
fn edges_shared_by_place(file: &str) -> usize {
    let file = Plain::read(file);
    let mut faces: BTreeMap<[[u64; 3]; 2], usize> = BTreeMap::new();
    for face in &file.faces {
        for i in 0..3 {
            let ends = [face[i], face[(i + 1) % 3]].map(|v| file.at(v));
            let mut ends = ends.map(|at| at.map(|x| (x + 0.0).to_bits()));
            ends.sort_unstable();
            *faces.entry(ends).or_default() += 1;
        }
    }
    faces.values().filter(|&&faces| faces == 2).count()
}

/// Straight cuts whose record is dropped, and some of whose zeros have lost their sign or got one: sewn by
/// places, every edge is whole that two faces have.
#[test]
fn torn_edges_are_sewn_without_a_record() {
    let (mut sewn, mut signed) = (0, 0);
    for (name, bytes) in files().into_iter().filter(|(name, _)| name != "late") {
        for seed in 0..8 {
            let document = read(&bytes);
            let mut work = Work::on(&document);
            let mut random = Random(seed);
            work.cut_sliding(&mut random);
            let mut dropped = without_comments(&work.written());
            if seed % 2 == 1 {
                dropped = with_minus_zeros(&dropped);
                signed += dropped.matches(" -0 ").count();
            }
            let document = read(dropped.as_bytes());
            assert!(!document.has_record());
            let (mesh, seams) = seams(&document);
            let all = work.mesh.half_edges();
            let torn = all.filter(|&h| work.mesh.ghost_pair(h).is_some()).count();
            assert_eq!(2 * seams.edges().len(), torn, "{name} {seed}");
            let torn = document.torn_from(&seams.lowest(&mesh));
            let (document, mesh) = torn.expect("it was a surface");
            let mut work = Work::on(&document);
            assert_eq!(work.mesh, mesh);
            let all = mend::stitches(&work.mesh, |_| true);
            assert_eq!(all, seams.stitches(&mesh));
            work.sew(&all);
            let written = text(&work.written());
            assert!(!written.contains('#'), "nothing is left to record");
            let whole = read(written.as_bytes()).mesh().expect("a mesh");
            let inside = whole.edges().filter(|&h| whole.pair(h).is_some()).count();
            assert_eq!(inside, edges_shared_by_place(&dropped), "{name} {seed}");
            sewn += seams.edges().len();
        }
    }
    assert!(sewn > 500 && signed > 300, "{sewn}, {signed}");
}

#[test]
fn edges_of_no_surface_stay_apart() {
    // A lens of two faces, three edges at one place, two that run the same way, and one without a length.
    for file in [
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 6 5 4\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 -1 0\n\
         f 1 2 3\nf 5 4 6\nf 8 7 9\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 4 5 6\n",
        "v 0 0 0\nv 0 0 0\nv 0 1 0\nv 0 0 0\nv 0 0 0\nv 0 0 1\nf 1 2 3\nf 5 4 6\n",
    ] {
        let (_, seams) = seams(&read(file.as_bytes()));
        assert!(seams.is_empty(), "{file}");
    }
}

/// The kernel compares numbers, in which −0 is 0.
#[test]
fn regression_minus_zero_is_the_place_of_zero() {
    let file = "v 0 0 0\nv 1 0 -0\nv 0 1 0\nv 1 -0 0\nv -0 1 0\nv 1 1 0\nf 1 2 3\nf 5 4 6\n";
    let (mesh, seams) = seams(&read(file.as_bytes()));
    assert_eq!(seams.lowest(&mesh), [0, 1, 2, 1, 2, 5]);
}

#[test]
fn numbers_that_other_statements_name_are_not_changed() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 5 4 6\nl 1 6\n";
    let document = read(file.as_bytes());
    let (mesh, seams) = seams(&document);
    let refused = document.torn_from(&seams.lowest(&mesh));
    let said = "`l` may name a vertex by its number, which sewing would change";
    assert_eq!(refused.expect_err("6 would be 4").to_string(), said);
}
