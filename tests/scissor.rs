//! The scissor: both errata of the paper, what `partition` promises, and what its report says.
//!
//! The oracles here share no code with the library: pieces are counted by flooding over
//! shared vertices, sides by the plain formula of a plane.

use std::fmt::Write as _;

use tearmesh::{
    CutError, CutMethod, CutReport, CutTips, Edits, Mesh, Point, Positions, Scissor, ScissorError,
    Vector, shapes,
};

use crate::oracle::naive_cut;
use crate::oracle::straight::{Cut, Surface, is_generic};
use crate::random::Random;
use crate::straight::{cases, judged, random_generic_cut};
use crate::surfaces::{jittered, pieces_by_vertices};
use crate::work::{Rays, Work, between, down, ray, scissor};

fn is_between(scissor: &Scissor, p: [f64; 3]) -> bool {
    let sides = scissor.sides().expect("there are rays");
    sides.iter().all(|side| side.offset(p.into()) >= 0.0)
}

/// Erratum 1: as printed, the normals of the side planes point outward and select nothing (Souza et
/// al. 2014 §V). Erratum 2: two rays from one eye span a wedge.
#[test]
fn errata_points_are_between_rays_of_every_kind() {
    let eye = [0.5, 0.5, 4.0];
    let way = [0.5, 0.25, -1.0];
    type Row<'r> = (Rays, &'r [[f64; 3]], &'r [[f64; 3]]);
    let rows: [Row<'_>; 5] = [
        // Parallel: the middle, and beyond either origin.
        (
            [([1.0, 2.0, 5.0], way), ([4.0, -1.0, 3.0], way)],
            &[[2.5, 0.5, 4.0]],
            &[[-2.0, 5.0, 7.0], [7.0, -4.0, 1.0]],
        ),
        // The strip extends behind the origins.
        (
            [down([0.0, 1.0]), down([0.0, -1.0])],
            &[[0.0, 0.0, 99.0]],
            &[[0.0, 1.5, 0.0], [0.0, -1.5, 0.0]],
        ),
        // Anti-parallel.
        (
            [down([0.0, 1.0]), ([0.0, -1.0, -5.0], [0.0, 0.0, 1.0])],
            &[[0.0; 3]],
            &[[0.0, 1.5, 0.0], [0.0, -1.5, 0.0]],
        ),
        // From one eye: nothing behind it is cut.
        (
            [(eye, [-0.5, 0.01, -4.0]), (eye, [0.5, 0.01, -4.0])],
            &[[0.5, 0.51, 0.0]],
            &[[1.1, 0.51, 0.0], [-0.1, 0.51, 0.0], [0.5, 0.49, 8.0]],
        ),
        // Skew.
        (
            [down([0.0, 1.0]), ([0.0, -1.0, 5.0], [1.0, 0.0, 0.0])],
            &[[0.0; 3]],
            &[[0.0, -1.1, 0.0]],
        ),
    ];
    for (rays, inside, outside) in rows {
        let scissor = scissor(rays);
        assert!(inside.iter().all(|&p| is_between(&scissor, p)), "{rays:?}");
        assert!(
            !outside.iter().any(|&p| is_between(&scissor, p)),
            "{rays:?}"
        );
    }
    let [(a, v), (b, _)] = rows[0].0;
    let [a, b] = [a, b].map(Point::from);
    let (v, middle) = (Vector::from(v), Point::new(2.5, 0.5, 4.0));
    let normal = (a - b).cross(&v);
    assert!(v.cross(&normal).dot(&(middle - a)) < 0.0);
    assert!(normal.cross(&v).dot(&(middle - b)) < 0.0);
}

#[test]
fn a_plane_is_spanned_unless_both_rays_are_one_line() {
    // An eye that rounding moved is still one eye.
    let moved = [
        ([0.1 + 0.2, 0.0, 1.0], [1.0, 0.0, -1.0]),
        ([0.3, 0.0, 1.0], [0.0, 1.0, -1.0]),
    ];
    let truth = Vector::new(1.0, 1.0, 1.0) / 3f64.sqrt();
    assert!((scissor(moved).plane().normal() - truth).norm() < 1e-15);
    // An origin may lie on the line of the other ray.
    let on_line = [down([0.0, 0.0]), ([0.0, 0.0, 3.0], [1.0, 0.0, 0.0])];
    assert_eq!(scissor(on_line).plane().normal().y.abs(), 1.0);
    let (origin, along) = ([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    for other in [
        (origin, along),
        (origin, [-2.0, -4.0, -6.0]),
        ([1.1, 2.2, 3.3], along),
        ([0.1 - 7e5, 0.2 - 14e5, 0.3 - 21e5], [-1e-9, -2e-9, -3e-9]),
    ] {
        let none = Scissor::new(ray((origin, along)), ray(other));
        assert_eq!(none, Err(ScissorError::OneLine), "{other:?}");
    }
    // Directions of any length give the same scissor.
    let reference = between([0.3, 2.0], [0.3, -2.0]).plane().normal();
    for size in [1e-300, 1e-9, 1024.0, 1e300] {
        let a = ([0.3, 2.0, 5.0], [0.0, 0.0, -size]);
        let b = ([0.3, -2.0, 5.0], [0.0, 0.0, -1.0 / size]);
        assert_eq!(scissor([a, b]).plane().normal(), reference, "{size}");
    }
    // A skew ray says how far it leaves the plane.
    for (along, skew) in [([3.0, 0.0, -4.0], 0.6), ([0.0, 0.0, -1.0], 0.0)] {
        let rays = [down([0.0, 1.0]), ([0.0, -1.0, 5.0], along)];
        assert!((scissor(rays).skew() - skew).abs() < 1e-15);
    }
}

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
fn cuts_by_partition_leave_what_is_foretold() {
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

/// A through cut divides every sheet, and the sides share no vertex.
#[test]
fn partition_divides_sheets_and_follows_the_oracle() {
    let mut random = Random(109);
    let mut cuts = 0;
    for _ in 0..300 {
        let sheet = jittered(3 + random.below(9) as u32, &mut random);
        let (finite, cut) = random_generic_cut(&sheet, &mut random);
        partition_is_right(&sheet, &cut, &finite, "jittered");
        let (sin, cos) = (std::f64::consts::PI * random.next()).sin_cos();
        let [x, y] = [(); 2].map(|()| 0.3 + 0.4 * random.next());
        let rays = [5.0, -5.0].map(|t| down([x + t * cos, y + t * sin]));
        let cut = Cut::between(rays).through();
        if !is_generic(&sheet, &cut) {
            continue;
        }
        let through = scissor(rays).through(true);
        partition_is_right(&sheet, &cut, &through, "jittered");
        let mut work = Work::of(&sheet);
        let (_, report) = work.cut(CutMethod::Partition, &through);
        let counts = (report.pieces, report.pieces_expected, report.separated);
        assert_eq!(counts, (2, 2, true), "{report:?}");
        assert!(report.seam_length_ratio < 1.6, "{report:?}");
        let after = work.surface();
        let piece = pieces_by_vertices(&after.faces);
        let mut sides = vec![[false; 2]; piece.len()];
        for (f, face) in after.faces.iter().enumerate() {
            let distance = face.map(|v| cut.plane.distance(after.points[v as usize]));
            sides[piece[f]][0] |= distance.iter().all(|d| *d > 1e-9);
            sides[piece[f]][1] |= distance.iter().all(|d| *d < -1e-9);
        }
        assert!(sides.iter().all(|&side| side != [true, true]));
        cuts += 1;
    }
    assert!(cuts > 250, "{cuts}");
}
