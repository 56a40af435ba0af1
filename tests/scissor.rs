//! What `partition` promises, what its report says, and what a scissor refuses. (That planes are those of any
//! two rays, both errata of the paper included, is in `rays.rs` and `straight.rs`.)

use std::fmt::Write as _;

use tearmesh::{
    CutError, CutMethod, CutReport, CutTips, Edits, Mesh, Positions, Scissor, ScissorError, shapes,
};

use crate::oracle::naive_cut;
use crate::oracle::straight::{Cut, Surface};
use crate::straight::{cases, judged};
use crate::work::{Work, between, down, scissor};

#[test]
fn errors_of_scissors_say_what_is_wrong() {
    let (mut mesh, mut positions) = shapes::grid(2, 2);
    let (_, mut others) = shapes::grid(3, 3);
    let (slit, mut edits) = (between([0.5, 2.0], [0.5, -2.0]), Edits::new());
    let refused = |mesh: &mut Mesh, positions: &mut Positions, edits: &mut Edits| {
        let cut = slit.cut(CutMethod::Partition, mesh, positions, edits);
        cut.map_err(|error: CutError| error.to_string()).err()
    };
    let mut late = positions.clone();
    let other = refused(&mut mesh, &mut others, &mut edits);
    let done = refused(&mut mesh, &mut positions, &mut edits);
    let late = refused(&mut mesh, &mut late, &mut edits);
    let mut log = Edits::starting_at(edits.cursor());
    let mut turned = Edits::new();
    let across = between([2.0, 0.5], [-2.0, 0.5]);
    let (mut twin, mut foreign) = shapes::grid(2, 2);
    let cut = across.cut(CutMethod::Partition, &mut twin, &mut foreign, &mut turned);
    cut.expect("in step");
    let foreign = refused(&mut mesh, &mut foreign, &mut log);
    let told = [other, done, late, foreign].map(Option::unwrap_or_default);
    assert_eq!(
        told,
        [
            "16 positions for a mesh of 9 vertices",
            "",
            "the positions have seen 0 edits, and the log has 3: replay first",
            "the positions have followed another log, of 3 edits too",
        ]
    );
    assert_eq!(
        ScissorError::OneLine.to_string(),
        "the two rays are the same line, so they span no cutting plane"
    );
}

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let numbers = text.split(',').map(|x| x.parse().expect("a number"));
    let numbers: Vec<f64> = numbers.collect();
    numbers.try_into().expect("so many numbers")
}

/// What is said of a cut.
fn told(report: &CutReport, mesh: &Mesh) -> String {
    let mut told = format!(
        "{} splits, {} ghost pairs, {} faces crossed, {} of {} pieces, {} boundary loops, seam {:.3}",
        report.splits,
        report.ghost_pairs,
        report.faces_crossed,
        report.pieces,
        report.pieces_expected,
        mesh.boundary_loops().len(),
        report.seam_length,
    );
    let _ = match (report.missed, report.separated) {
        (true, _) => write!(told, ", missed by {}", report.nearest_vertex),
        (_, true) => write!(told, ", separated"),
        (_, false) => write!(told, ", not separated"),
    };
    told
}

#[test]
fn cuts_by_partition_match_the_table() {
    for row in include_str!("scissor.txt").lines() {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let [mesh, cuts, expected] = columns[..] else {
            continue;
        };
        let words: Vec<&str> = mesh.split(' ').collect();
        let size = |i: usize| words[i].parse::<u32>().expect("a size");
        let mut work = Work::new(match words[0] {
            "grid" => shapes::grid(size(1), size(1)),
            "falling" => shapes::grid_with_diagonals(size(1), size(1), |_, _| false),
            "tube" => shapes::tube(size(1), size(2)),
            other => {
                assert_eq!(other, "torus");
                shapes::torus(size(1), size(2))
            }
        });
        let mut last = String::new();
        for cut in cuts.split(';') {
            let ray = |word: &str| match word.split_once(':') {
                Some((origin, along)) => (numbers(origin), numbers(along)),
                None => down(numbers(word)),
            };
            let words: Vec<&str> = cut.split_whitespace().collect();
            let [.., a, b] = words[..] else {
                panic!("two rays: {row}")
            };
            let scissor = scissor([ray(a), ray(b)]).through(words[0] == "through");
            let scissor = match words[0] {
                "midpoint" => scissor.tips(CutTips::Midpoint),
                _ => scissor,
            };
            let (_, report) = work.cut(CutMethod::Partition, &scissor);
            assert_eq!(report.crumbs, 0, "{row}");
            assert_eq!(report.pieces + report.lost, report.pieces_expected, "{row}");
            last = told(&report, &work.mesh);
        }
        assert_eq!(last, expected, "{row}");
    }
}

/// What holds of a generic cut of any surface by `partition`.
fn partition_is_right(before: &Surface, cut: &Cut, scissor: &Scissor, name: &str) {
    let ideal = naive_cut::cut(before, cut);
    let facts = judged(before, cut, &ideal, name);
    let mut work = Work::of(before);
    let (_, report) = work.cut(CutMethod::Partition, scissor);
    assert_eq!(report.pieces_expected, facts.pieces, "{name}: {report:?}");
    let is_whole = |[a, b, c]: [u32; 3]| {
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        turns.iter().any(|face| ideal.faces.contains(face))
    };
    let is_crossed = |face: &&[u32; 3]| !is_whole(**face);
    let crossed = before.faces.iter().filter(is_crossed).count();
    assert_eq!(report.faces_crossed, crossed, "{name}");
    if report.splits > 0 {
        let slit = report.seam_length / report.seam_length_ratio;
        let off = (slit - facts.seam_length).abs();
        assert!(off < 1e-9, "{name}: {facts:?}, {report:?}");
    }
    // By the definition: both labels at a vertex strictly inside would show as a face strictly in
    // front that shares it with one strictly behind.
    let after = work.surface();
    let side = |face: &[u32; 3], sign: f64| {
        let distance = |&v: &u32| sign * cut.plane.distance(after.points[v as usize]);
        face.iter().all(|v| distance(v) > 1e-9)
    };
    let joins = |v: u32, sign| after.faces.iter().any(|f| f.contains(&v) && side(f, sign));
    for (v, &p) in after.points.iter().enumerate() {
        if v >= before.points.len() {
            assert!(cut.depth(p) >= -1e-12, "{name}: {v} is outside");
        }
        let joins = |sign| joins(v as u32, sign);
        let joins_both = cut.depth(p) > 1e-9 && joins(1.0) && joins(-1.0);
        assert!(!joins_both, "{name}: {v}");
    }
}

#[test]
fn partition_follows_the_oracle_on_all_surfaces() {
    for case in cases() {
        partition_is_right(&case.before, &case.cut, &case.scissor(), case.name);
    }
}
