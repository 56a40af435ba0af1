//! The scissor: both errata of the paper, what `partition` promises, and what its report says.
//!
//! The oracles here share no code with the library: pieces are counted by flooding over
//! shared vertices, sides by the plain formula of a plane.

use proptest::prelude::*;
use tearmesh::{
    Cursor, CutError, CutMethod, CutReport, CutTips, Edits, Mesh, Point, Positions, Ray, Scissor,
    ScissorError, Vector, shapes,
};

use crate::pieces::pieces_by_vertices;

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray::new(origin.into(), direction.into()).expect("a usable ray")
}

fn scissor(a: ([f64; 3], [f64; 3]), b: ([f64; 3], [f64; 3])) -> Scissor {
    Scissor::new(ray(a.0, a.1), ray(b.0, b.1)).expect("the rays span a plane")
}

/// A vertical cut through the plane z = 0 between two points of it.
fn between(a: [f64; 2], b: [f64; 2]) -> Scissor {
    let down = [0.0, 0.0, -1.0];
    scissor(([a[0], a[1], 5.0], down), ([b[0], b[1], 5.0], down))
}

fn cut(scissor: &Scissor, mesh: &mut Mesh, positions: &mut Positions) -> CutReport {
    *positions = positions.clone().starting_at(Cursor::START);
    let report = scissor.cut_measured(CutMethod::Partition, mesh, positions, &mut Edits::new());
    assert_eq!(mesh.check(), []);
    report.expect("positions are in step").1
}

fn is_between(scissor: &Scissor, p: [f64; 3]) -> bool {
    scissor
        .sides()
        .expect("there are rays")
        .iter()
        .all(|side| side.offset(p.into()) >= 0.0)
}

// Erratum 1.

#[test]
fn erratum_1_a_point_between_parallel_rays_is_inside_both_side_planes() {
    let (a, b, v) = ([1.0, 2.0, 5.0], [4.0, -1.0, 3.0], [0.5, 0.25, -1.0]);
    let scissor = scissor((a, v), (b, v));
    let [a, b] = [Point::from(a), Point::from(b)];
    let v = Vector::from(v);
    let middle = middle_of(a, b);
    assert!(is_between(&scissor, middle.into()));

    // As printed, the normals point outward and select nothing (Souza et al. 2014 §V).
    let normal = (a - b).cross(&v);
    assert!(v.cross(&normal).dot(&(middle - a)) < 0.0);
    assert!(normal.cross(&v).dot(&(middle - b)) < 0.0);

    for outside in [a + (a - b), b + (b - a)] {
        assert!(!is_between(&scissor, outside.into()));
    }
}

fn middle_of(a: Point, b: Point) -> Point {
    Point::new((a.x + b.x) / 2.0, (a.y + b.y) / 2.0, (a.z + b.z) / 2.0)
}

#[test]
fn erratum_1_anti_parallel_rays_have_an_inside_too() {
    let scissor = scissor(
        ([0.0, 1.0, 5.0], [0.0, 0.0, -1.0]),
        ([0.0, -1.0, -5.0], [0.0, 0.0, 1.0]),
    );
    assert!(is_between(&scissor, [0.0, 0.0, 0.0]));
    assert!(!is_between(&scissor, [0.0, 1.5, 0.0]));
    assert!(!is_between(&scissor, [0.0, -1.5, 0.0]));
}

#[test]
fn the_strip_between_parallel_rays_extends_behind_their_origins() {
    assert!(is_between(
        &between([0.0, 1.0], [0.0, -1.0]),
        [0.0, 0.0, 99.0]
    ));
}

// Erratum 2.

#[test]
fn erratum_2_two_rays_from_one_eye_span_a_wedge() {
    let eye = [0.5, 0.5, 4.0];
    let scissor = scissor((eye, [-0.5, 0.01, -4.0]), (eye, [0.5, 0.01, -4.0]));
    let aim = [0.5, 0.51, 0.0];
    assert!(scissor.plane().distance(aim.into()).abs() < 1e-15);
    assert!(is_between(&scissor, aim));
    assert!(!is_between(&scissor, [1.1, 0.51, 0.0]));
    assert!(!is_between(&scissor, [-0.1, 0.51, 0.0]));
    // Nothing behind the eye is cut.
    assert!(!is_between(&scissor, [0.5, 0.49, 8.0]));

    let (mut mesh, mut positions) = shapes::grid(10, 10);
    let report = cut(&scissor, &mut mesh, &mut positions);
    assert_eq!((report.pieces, report.separated), (2, true));
}

#[test]
fn erratum_2_an_eye_that_rounding_moved_is_still_one_eye() {
    let a = ray([0.1 + 0.2, 0.0, 1.0], [1.0, 0.0, -1.0]);
    let b = ray([0.3, 0.0, 1.0], [0.0, 1.0, -1.0]);
    let normal = Scissor::new(a, b).expect("a plane").plane().normal();
    let truth = Vector::new(1.0, 1.0, 1.0) / 3f64.sqrt();
    assert!((normal - truth).norm() < 1e-15, "{normal}");
}

#[test]
fn an_origin_on_the_line_of_the_other_ray_is_no_obstacle() {
    let scissor = scissor(
        ([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]),
        ([0.0, 0.0, 3.0], [1.0, 0.0, 0.0]),
    );
    assert_eq!(scissor.plane().normal().y.abs(), 1.0);
}

#[test]
fn rays_on_one_line_span_no_plane() {
    let a = ray([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    for b in [
        ray([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]),
        ray([0.1, 0.2, 0.3], [-2.0, -4.0, -6.0]),
        ray([1.1, 2.2, 3.3], [1.0, 2.0, 3.0]),
        ray([0.1 - 7e5, 0.2 - 14e5, 0.3 - 21e5], [-1e-9, -2e-9, -3e-9]),
    ] {
        assert_eq!(Scissor::new(a, b), Err(ScissorError::OneLine), "{b:?}");
    }
}

#[test]
fn directions_of_any_length_give_the_same_scissor() {
    let reference = between([0.3, 2.0], [0.3, -2.0]);
    for size in [1e-300, 1e-9, 1024.0, 1e300] {
        let a = ray([0.3, 2.0, 5.0], [0.0, 0.0, -size]);
        let b = ray([0.3, -2.0, 5.0], [0.0, 0.0, -1.0 / size]);
        let scissor = Scissor::new(a, b).expect("a plane");
        assert_eq!(
            scissor.plane().normal(),
            reference.plane().normal(),
            "{size}"
        );
        assert!(is_between(&scissor, [0.3, 0.0, 0.0]));
    }
}

#[test]
fn a_skew_ray_says_how_far_it_leaves_the_plane() {
    let down = [0.0, 0.0, -1.0];
    let skew = scissor(
        ([0.0, 1.0, 5.0], down),
        ([0.0, -1.0, 5.0], [3.0, 0.0, -4.0]),
    )
    .skew();
    assert!((skew - 0.6).abs() < 1e-15, "{skew}");
    assert_eq!(between([0.0, 1.0], [0.0, -1.0]).skew(), 0.0);
    let upright = scissor(([0.0, 1.0, 5.0], down), ([0.0, -1.0, 5.0], [1.0, 0.0, 0.0]));
    assert_eq!(upright.skew(), 1.0);
    assert!(is_between(&upright, [0.0, 0.0, 0.0]));
    assert!(!is_between(&upright, [0.0, -1.1, 0.0]));
}

// What a cut does.

#[test]
fn a_cut_along_a_grid_line_splits_exactly_the_line() {
    let (mut mesh, mut positions) = shapes::grid(8, 8);
    let report = cut(&between([0.5, 2.0], [0.5, -2.0]), &mut mesh, &mut positions);
    assert_eq!(
        (report.splits, report.ghost_pairs, report.faces_crossed),
        (9, 16, 0)
    );
    assert_eq!(
        (
            report.pieces,
            report.pieces_expected,
            report.crumbs,
            report.lost
        ),
        (2, 2, 0, 0)
    );
    assert_eq!((report.seam_length, report.seam_length_ratio), (1.0, 1.0));
    assert_eq!(report.seam_deviation_max, 0.0);
    assert!(report.separated && !report.missed);
    assert!((report.angle_min_deg - 45.0).abs() < 1e-12);
    assert!((report.altitude_min - 0.125 / 2f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_plane_that_only_touches_cuts_nothing() {
    let (mut mesh, mut positions) = shapes::grid(4, 4);
    let before = mesh.clone();
    let report = cut(&between([0.0, 2.0], [0.0, -2.0]), &mut mesh, &mut positions);
    assert_eq!(mesh, before);
    assert_eq!(
        (report.splits, report.pieces, report.pieces_expected),
        (0, 1, 1)
    );
    assert!(report.missed);
    assert_eq!(report.nearest_vertex, 0.0);
}

#[test]
fn a_miss_says_how_far_away_the_mesh_is() {
    let (mut mesh, mut positions) = shapes::grid(4, 4);
    let report = cut(&between([9.0, 2.0], [9.0, -2.0]), &mut mesh, &mut positions);
    assert!(report.missed);
    assert_eq!((report.splits, report.nearest_vertex), (0, 8.0));
    let report = cut(&between([0.5, 5.0], [0.5, 4.0]), &mut mesh, &mut positions);
    assert!(report.missed);
    assert_eq!(report.nearest_vertex, 3.0);
}

#[test]
fn a_finite_cut_splits_only_vertices_between_the_side_planes() {
    let (mut mesh, mut positions) = shapes::grid(10, 10);
    let report = cut(
        &between([0.52, 0.25], [0.52, 0.75]),
        &mut mesh,
        &mut positions,
    );
    // The seam follows x = 0.5; vertices at y = 0.3 … 0.7 lie between the side planes.
    assert_eq!(
        (report.splits, report.pieces, report.pieces_expected),
        (5, 1, 1)
    );
    assert!(report.separated);
    for v in mesh.vertices().skip(121) {
        let p = positions.at(v);
        assert!((0.25..=0.75).contains(&p.y), "{p}");
    }
}

#[test]
fn midpoint_tips_cut_fewer_edges() {
    let ghost_pairs = |slit: Scissor| {
        [CutTips::Vertex, CutTips::Midpoint].map(|tips| {
            let (mut mesh, mut positions) = shapes::grid(10, 10);
            cut(&slit.clone().tips(tips), &mut mesh, &mut positions).ghost_pairs
        })
    };
    // Edges 0.2–0.3 to 0.7–0.8 of the seam; the outer two have midpoints at 0.25 and 0.75.
    assert_eq!(ghost_pairs(between([0.52, 0.24], [0.52, 0.76])), [12, 12]);
    assert_eq!(ghost_pairs(between([0.52, 0.28], [0.52, 0.72])), [12, 8]);
}

#[test]
fn vertices_on_a_side_plane_are_not_strictly_between() {
    // By midpoints the edges from y = 0.3 to 0.7 are cut; the two vertices at their ends, which lie
    // on the side planes, stay shared.
    let (mut mesh, mut positions) = shapes::grid(10, 10);
    let slit = between([0.52, 0.3], [0.52, 0.7]).tips(CutTips::Midpoint);
    let report = cut(&slit, &mut mesh, &mut positions);
    assert_eq!(
        (report.splits, report.ghost_pairs, report.separated),
        (3, 8, true)
    );
    // A hair further out, they lie between.
    let (mut mesh, mut positions) = shapes::grid(10, 10);
    let slit = between([0.52, 0.299], [0.52, 0.701]).tips(CutTips::Midpoint);
    assert!(!cut(&slit, &mut mesh, &mut positions).separated);
}

#[test]
fn what_is_wrong_is_said_in_words() {
    assert_eq!(
        ScissorError::OneLine.to_string(),
        "the two rays are the same line, so they span no cutting plane"
    );
    assert_eq!(
        CutError::Positions {
            vertices: 9,
            positions: 16
        }
        .to_string(),
        "16 positions for a mesh of 9 vertices"
    );
    let at = |number: u64| Cursor::from_bytes((u128::from(number) << 64).to_be_bytes());
    let unreplayed = |seen, made| CutError::Unreplayed {
        seen: at(seen),
        made: at(made),
    };
    assert_eq!(
        unreplayed(1, 3).to_string(),
        "the positions have seen 1 edits, and the log has 3: replay first"
    );
    assert_eq!(
        unreplayed(3, 3).to_string(),
        "the positions have followed another log, of 3 edits too"
    );
}

#[test]
fn a_strip_narrower_than_an_edge_is_not_called_separated() {
    let (mut mesh, mut positions) = shapes::grid(4, 4);
    let report = cut(
        &between([0.5, 0.30], [0.5, 0.45]),
        &mut mesh,
        &mut positions,
    );
    assert_eq!(
        (report.splits, report.separated, report.missed),
        (0, false, false)
    );
}

#[test]
fn a_sleeve_falls_apart_across_and_opens_along() {
    let across = scissor(
        ([-9.0, 5.0, 0.52], [0.0, -1.0, 0.0]),
        ([9.0, 5.0, 0.52], [0.0, -1.0, 0.0]),
    );
    let (mut mesh, mut positions) = shapes::tube(12, 8);
    let report = cut(&across, &mut mesh, &mut positions);
    assert_eq!(
        (report.pieces, report.pieces_expected, report.separated),
        (2, 2, true)
    );
    assert_eq!(mesh.boundary_loops().len(), 4);

    // The plane x = 0.1 goes through the tube twice; both walls are cut.
    let along = scissor(
        ([0.1, 5.0, -1.0], [0.0, -1.0, 0.0]),
        ([0.1, 5.0, 2.0], [0.0, -1.0, 0.0]),
    );
    let (mut mesh, mut positions) = shapes::tube(12, 8);
    let report = cut(&along, &mut mesh, &mut positions);
    assert_eq!((report.pieces, report.pieces_expected), (2, 2));

    // Between x = 0 and x = 5 only one wall is.
    let one_wall = scissor(
        ([0.0, 0.1, -1.0], [0.0, 0.0, 1.0]),
        ([5.0, 0.1, -1.0], [0.0, 0.0, 1.0]),
    );
    let (mut mesh, mut positions) = shapes::tube(12, 8);
    let report = cut(&one_wall, &mut mesh, &mut positions);
    assert_eq!(
        (report.pieces, report.pieces_expected, report.separated),
        (1, 1, true)
    );
    assert_eq!(mesh.boundary_loops().len(), 1);
}

#[test]
fn a_torus_opens_with_one_cut_and_falls_apart_with_a_through_cut() {
    let half = scissor(
        ([0.0, 0.01, 5.0], [0.0, 0.0, -1.0]),
        ([3.0, 0.01, 5.0], [0.0, 0.0, -1.0]),
    );
    let (mut mesh, mut positions) = shapes::torus(16, 10);
    let report = cut(&half, &mut mesh, &mut positions);
    assert_eq!(
        (report.pieces, report.pieces_expected, report.separated),
        (1, 1, true)
    );
    assert_eq!(mesh.boundary_loops().len(), 2);
    let (mut mesh, mut positions) = shapes::torus(16, 10);
    let report = cut(&half.through(true), &mut mesh, &mut positions);
    assert_eq!((report.pieces, report.pieces_expected), (2, 2));
}

#[test]
fn a_strip_that_no_edge_can_follow_is_counted_as_lost() {
    let (mut mesh, mut positions) = shapes::grid(4, 4);
    let first = cut(&between([0.5, 2.0], [0.5, -2.0]), &mut mesh, &mut positions);
    // Between the seam and the second slit lies a strip without an edge of its own.
    let second = cut(
        &between([0.51, 2.0], [0.51, -2.0]),
        &mut mesh,
        &mut positions,
    );
    assert_eq!((first.pieces, first.lost), (2, 0));
    assert_eq!(
        (second.pieces, second.pieces_expected, second.lost),
        (2, 3, 1)
    );
}

#[test]
fn two_triangles_are_cut_apart_and_a_corner_can_be_cut_off() {
    let (mut mesh, mut positions) = shapes::grid(1, 1);
    let report = cut(&between([0.9, -1.0], [0.1, 2.0]), &mut mesh, &mut positions);
    assert_eq!(
        (report.pieces, report.pieces_expected, report.separated),
        (2, 2, true)
    );
    let (mut mesh, mut positions) = shapes::grid_with_diagonals(3, 3, |_, _| false);
    let report = cut(
        &between([0.52, 1.2], [1.2, 0.52]),
        &mut mesh,
        &mut positions,
    );
    assert_eq!((report.pieces, report.pieces_expected), (2, 2));
}

#[test]
fn no_crumb_is_left_in_a_corner() {
    // Without the rule for corners, the upper right face becomes a piece of its own.
    let (mut mesh, mut positions) = shapes::grid_with_diagonals(3, 3, |_, _| false);
    let (sin, cos) = 0.5174f64.sin_cos();
    let end = |t: f64| [0.34145 + t * cos, 0.57387 + t * sin];
    let report = cut(&between(end(5.0), end(-5.0)), &mut mesh, &mut positions);
    assert_eq!((report.pieces, report.crumbs), (2, 0));
}

#[test]
fn later_cuts_cross_earlier_ones() {
    let (mut mesh, mut positions) = shapes::grid(9, 9);
    let mut edits = Edits::new();
    let mut pieces = Vec::new();
    for slit in [
        between([0.4, 2.0], [0.4, -2.0]),
        between([2.0, 0.6], [-2.0, 0.6]),
    ] {
        let report = slit.cut_measured(CutMethod::Partition, &mut mesh, &mut positions, &mut edits);
        pieces.push(report.expect("in step").1.pieces);
        assert_eq!(mesh.check(), []);
    }
    assert_eq!(pieces, [2, 4]);
    assert_eq!(positions.seen(), edits.cursor());
    assert_eq!(positions.len(), mesh.vertex_count());
}

#[test]
fn positions_of_another_mesh_are_refused() {
    let (mut mesh, mut positions) = shapes::grid(2, 2);
    let (_, mut others) = shapes::grid(3, 3);
    let slit = between([0.5, 2.0], [0.5, -2.0]);
    let mut edits = Edits::new();
    assert_eq!(
        slit.cut(CutMethod::Partition, &mut mesh, &mut others, &mut edits)
            .err(),
        Some(CutError::Positions {
            vertices: 9,
            positions: 16
        })
    );
    let mut late = positions.clone();
    slit.cut(CutMethod::Partition, &mut mesh, &mut positions, &mut edits)
        .expect("in step");
    assert_eq!(
        slit.cut(CutMethod::Partition, &mut mesh, &mut late, &mut edits)
            .err(),
        Some(CutError::Unreplayed {
            seen: Cursor::START,
            made: edits.cursor()
        })
    );
}

// Random cuts of random sheets.

/// The unit square in `n` × `n` cells with random diagonals; inner vertices are moved by up to
/// `jitter` cells, the border stays. Up to 0.24 no face turns over.
fn jittered(n: u32, jitter: f64, noise: &[(f64, f64, bool)]) -> (Mesh, Positions) {
    let noise = |i: usize| noise[i % noise.len()];
    let (mesh, flat) = shapes::grid_with_diagonals(n, n, |x, y| noise((x + y * n) as usize).2);
    let cell = 1.0 / f64::from(n);
    let inner = |x: f64| x > 0.0 && x < 1.0;
    let points = flat.as_slice().iter().enumerate().map(|(i, p)| {
        let (dx, dy, _) = noise(i);
        let move_by = if inner(p.x) && inner(p.y) {
            jitter * cell
        } else {
            0.0
        };
        [p.x + dx * move_by, p.y + dy * move_by, 0.0]
    });
    (
        mesh,
        Positions::new(points.collect::<Vec<_>>()).expect("finite"),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_through_cut_divides_every_sheet_and_the_sides_share_no_vertex(
        n in 3u32..12,
        jitter in prop::sample::select(vec![0.0, 0.12, 0.24]),
        noise in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, any::<bool>()), 1..200),
        angle in 0.0..3.2f64,
        through in (0.3..0.7f64, 0.3..0.7f64),
    ) {
        let (mut mesh, mut positions) = jittered(n, jitter, &noise);
        let (sin, cos) = angle.sin_cos();
        let end = |t: f64| [through.0 + t * cos, through.1 + t * sin];
        let input = (mesh.clone(), positions.clone());
        let report = cut(&between(end(5.0), end(-5.0)), &mut mesh, &mut positions);

        prop_assert_eq!(report.pieces_expected, 2);
        prop_assert_eq!((report.pieces, report.crumbs, report.lost), (2, 0, 0));
        prop_assert!(report.separated);
        prop_assert_eq!(mesh.vertex_count(), input.0.vertex_count() + report.splits);
        prop_assert!(report.seam_length_ratio < 1.6);
        let mean_edge = report.seam_deviation_max / report.seam_deviation_max_edges;
        prop_assert!((0.9..1.6).contains(&(mean_edge * f64::from(n))), "{}", mean_edge);
        // The chord of the unit square along the line.
        let reach = |at: f64, by: f64| if by > 0.0 { (1.0 - at) / by } else { -at / by };
        let forth = reach(through.0, cos).min(reach(through.1, sin));
        let back = reach(through.0, -cos).min(reach(through.1, -sin));
        let slit = report.seam_length / report.seam_length_ratio;
        prop_assert!((slit - forth - back).abs() < 1e-12, "{}", slit);
        for h in mesh.half_edges() {
            prop_assert_eq!(positions.at(mesh.origin(h)), input.1.at(input.0.origin(h)));
        }

        // A face wholly on one side is never joined to one on the other, not by a vertex either.
        let piece = pieces_by_vertices(&mesh);
        let mut sides = vec![[false; 2]; piece.len()];
        for (f, face) in mesh.indices().chunks(3).enumerate() {
            let distance = |&v: &u32| {
                let p = positions.as_slice()[v as usize];
                (p.x - through.0) * sin - (p.y - through.1) * cos
            };
            sides[piece[f]][0] |= face.iter().all(|v| distance(v) > 1e-9);
            sides[piece[f]][1] |= face.iter().all(|v| distance(v) < -1e-9);
        }
        prop_assert!(sides.iter().all(|&side| side != [true, true]));
    }

    #[test]
    fn a_finite_cut_separates_what_lies_strictly_between_the_side_planes(
        n in 4u32..12,
        noise in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, any::<bool>()), 1..200),
        angle in 0.0..3.2f64,
        centre in (0.4..0.6f64, 0.4..0.6f64),
        half_length in 0.05..0.3f64,
    ) {
        let (mut mesh, mut positions) = jittered(n, 0.24, &noise);
        let (sin, cos) = angle.sin_cos();
        let end = |t: f64| [centre.0 + t * cos, centre.1 + t * sin];
        let vertices = mesh.vertex_count();
        let report = cut(&between(end(half_length), end(-half_length)), &mut mesh, &mut positions);
        prop_assert_eq!((report.pieces_expected, report.lost), (1, 0));

        // The slit lies inside the flat sheet, so its length is that between the rays.
        if report.splits > 0 {
            let slit = report.seam_length / report.seam_length_ratio;
            prop_assert!((slit - 2.0 * half_length).abs() < 1e-12, "{}", slit);
        }
        // A face is crossed where the line enters and leaves it, if that overlaps the slit.
        let place = |v: u32| {
            let p = positions.as_slice()[v as usize];
            let (x, y) = (p.x - centre.0, p.y - centre.1);
            (x * cos + y * sin, y * cos - x * sin)
        };
        let crossed = mesh.indices().chunks(3).filter(|face| {
            let corners = [place(face[0]), place(face[1]), place(face[2])];
            let crossings = (0..3).filter_map(|i| {
                let ((s, d), (t, e)) = (corners[i], corners[(i + 1) % 3]);
                (d * e < 0.0).then(|| (s * e - t * d) / (e - d))
            });
            let along: Vec<f64> = crossings.collect();
            along.len() == 2
                && along[0].min(along[1]) <= half_length
                && along[0].max(along[1]) >= -half_length
        });
        prop_assert_eq!(crossed.count(), report.faces_crossed);
        for v in mesh.vertices().skip(vertices) {
            let p = positions.at(v);
            let along = (p.x - centre.0) * cos + (p.y - centre.1) * sin;
            prop_assert!(along.abs() <= half_length + 1e-12);
        }
        // By the definition: both labels at a vertex strictly inside would show as a
        // face strictly in front that shares it with one strictly behind.
        let inside = |p: Point| {
            ((p.x - centre.0) * cos + (p.y - centre.1) * sin).abs() < half_length - 1e-9
        };
        for v in mesh.vertices().filter(|&v| inside(positions.at(v))) {
            let side = |d: f64| mesh.faces_of(v).any(|f| {
                mesh.face_vertices(f).iter().all(|&c| {
                    let p = positions.at(c);
                    d * ((p.x - centre.0) * sin - (p.y - centre.1) * cos) > 1e-9
                })
            });
            prop_assert!(!(side(1.0) && side(-1.0)), "{} joins both sides", v);
        }
    }
}
