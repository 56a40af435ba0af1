//! A table of cuts by all methods, what `partition` promises, and what a scissor refuses. (That planes are those
//! of any two rays, both errata of the paper included, is in `rays.rs` and `straight.rs`.)

use std::fmt::Write as _;

use tearmesh::{
    Cut as Made, CutError, CutLayers, CutMethod, CutReport, CutTips, Edits, Follower as _, Mesh,
    PerCorner, Point, Positions, Scissor, ScissorError, Side, shapes,
};

use crate::oracle::naive_cut;
use crate::oracle::straight::{Cut, Surface};
use crate::straight::{cases, judged};
use crate::work::{Work, between, down, ray, scissor};

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
    let rays = [[0.0; 3], [1.0, 1e-15, 0.0]].map(|at| ray((at, [1.0, 0.0, 0.0])));
    let nearly = Scissor::new(rays[0], rays[1]).err();
    assert_eq!(nearly, Some(ScissorError::OneLine));
}

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let numbers = text.split(',').map(|x| x.parse().expect("a number"));
    let numbers: Vec<f64> = numbers.collect();
    numbers.try_into().expect("so many numbers")
}

/// What is said of a cut.
fn told(cut: &Made, report: &CutReport, mesh: &Mesh) -> String {
    let sides = [Some(Side::Front), Some(Side::Back), None];
    let faces = |side| cut.sides().iter().filter(|of| of.1 == side).count();
    let mut told = format!(
        "{} inserted, {} splits, {} ghost pairs, {} faces crossed, {} of {} pieces, {} boundary loops, seam {:.3}, sides {:?}",
        report.vertices_inserted,
        report.splits,
        report.ghost_pairs,
        report.faces_crossed,
        report.pieces,
        report.pieces_expected,
        mesh.boundary_loops().len(),
        report.seam_length,
        sides.map(faces),
    );
    if !report.tip_overshoots.is_empty() {
        let tips = report.tip_overshoots.iter();
        let thousandths: Vec<i32> = tips.map(|x| (1e3 * x).round() as i32).collect();
        let _ = write!(told, ", tips {thousandths:?}");
    }
    let _ = match (report.missed, report.separated) {
        (true, _) => write!(told, ", missed by {}", report.nearest_vertex),
        (_, true) => write!(told, ", separated"),
        (_, false) => write!(told, ", not separated"),
    };
    told
}

/// A mesh by its name and size.
fn named(words: &[&str]) -> Work {
    let size = |i: usize| words[i].parse::<u32>().expect("a size");
    Work::new(match words[0] {
        "grid" => shapes::grid(size(1), size(1)),
        "falling" => shapes::grid_with_diagonals(size(1), size(1), |_, _| false),
        "tube" => shapes::tube(size(1), size(2)),
        "torus" => shapes::torus(size(1), size(2)),
        other => panic!("{other}"),
    })
}

/// Sews what is at a place, or moves the last vertex there.
fn change(work: &mut Work, action: &str, [x, y, by]: [f64; 3]) {
    let (mut points, place) = (work.positions.as_slice().to_vec(), Point::new(x, y, 0.0));
    if action == "sew" {
        work.sew(|v| points[v.index()] == place);
        return;
    }
    let last = points.iter().rposition(|&p| p == place);
    points[last.expect("a vertex")].y += by;
    let corner = |h| points[work.mesh.origin(h).index()].into();
    let corners = work.mesh.half_edges().map(corner).collect();
    work.corners = PerCorner::new(corners).starting_at(work.edits.cursor());
    let positions = Positions::new(points).expect("finite");
    work.positions = positions.starting_at(work.edits.cursor());
}

/// The scissor of two rays and the words before them, and the method.
fn described(words: &[&str]) -> (CutMethod, Scissor) {
    let ray = |word: &str| match word.split_once(':') {
        Some((origin, along)) => (numbers(origin), numbers(along)),
        None => down(numbers(word)),
    };
    let [words @ .., a, b] = words else {
        panic!("two rays: {words:?}")
    };
    let (mut method, mut scissor) = (
        CutMethod::Partition,
        scissor([ray(a), ray(b)]).with_snap(0.0),
    );
    for &word in words {
        match word {
            "exact" => method = CutMethod::Exact,
            "uniform" => method = CutMethod::Uniform,
            "through" => scissor = scissor.with_through(true),
            "midpoint" => scissor = scissor.with_tips(CutTips::Midpoint),
            "first" => scissor = scissor.with_layers(CutLayers::First),
            "sliding" => scissor = scissor.with_snap_move(true),
            snap => scissor = scissor.with_snap(numbers::<1>(snap)[0]),
        }
    }
    (method, scissor)
}

#[test]
fn cuts_match_the_table() {
    let mut wrong = Vec::new();
    for row in include_str!("scissor.txt").lines() {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let [mesh, steps, expected] = columns[..] else {
            continue;
        };
        let mut work = named(&mesh.split(' ').collect::<Vec<_>>());
        let mut last = String::new();
        for step in steps.split(';') {
            let words: Vec<&str> = step.split_whitespace().collect();
            if let [action @ ("sew" | "part"), place] = words[..] {
                change(&mut work, action, numbers(place));
                continue;
            }
            let (method, scissor) = described(&words);
            let (cut, report) = work.cut(method, &scissor);
            last = told(&cut, &report, &work.mesh);
        }
        if last != expected {
            wrong.push(format!("{mesh} | {steps} | {last}"));
        }
    }
    assert_eq!(wrong.join("\n"), "", "what came of cuts");
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
