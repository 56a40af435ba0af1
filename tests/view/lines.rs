//! Seams, boundaries and traces of cuts.

use proptest::prelude::*;
use tearmesh::{CutLayers, CutMethod, Edits, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};
use tearmesh_view::{Camera, Picture, PictureSize, RenderOptions, fit, palette, render, trace};

fn down(x: f64, y: f64) -> Ray {
    Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0)).expect("a ray")
}

fn cut(mesh: &mut Mesh, positions: &mut Positions, rays: [Ray; 2], snap: f64) -> Vec<[Point; 2]> {
    let scissor = Scissor::new(rays[0], rays[1])
        .expect("a plane")
        .with_snap(snap);
    let cut = scissor.cut(CutMethod::Exact, mesh, positions, &mut Edits::new());
    let cut = cut.expect("a cut");
    let ends = |h| [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
    let lips = cut.seam().flat_map(|line| line.lips.iter());
    lips.map(|&[front, _]| ends(front)).collect()
}

fn picture(mesh: &Mesh, positions: &Positions) -> Picture {
    let size = PictureSize::new(320, 240).expect("a size");
    let camera = fit(mesh, positions, Vector::y(), 35.0, size.as_f64());
    let camera = camera.expect("a camera");
    render(mesh, positions, &camera, size, &RenderOptions::default())
}

/// How many pixels are nearer to a colour than this.
fn count(picture: &Picture, color: palette::Color) -> usize {
    let is_near = |pixel: &&[u8; 3]| {
        // A thin line between two rows of pixels covers three quarters of each.
        let off = pixel.iter().zip(color).map(|(&a, b)| a.abs_diff(b));
        off.max() < Some(70)
    };
    picture
        .pixels()
        .as_chunks::<3>()
        .0
        .iter()
        .filter(is_near)
        .count()
}

/// The two lips lie on each other: without its line, a cut that moved nothing cannot be seen.
#[test]
fn a_seam_is_seen_in_a_sheet_that_did_not_move() {
    let (mut mesh, mut positions) = shapes::grid(12, 12);
    assert_eq!(count(&picture(&mesh, &positions), palette::LIGHT.seam), 0);
    cut(
        &mut mesh,
        &mut positions,
        [down(0.3, 0.2), down(0.7, 0.8)],
        0.05,
    );
    let shown = picture(&mesh, &positions);
    // Some 120 pixels long and one and a half wide, of which some are only half covered.
    let red = count(&shown, palette::LIGHT.seam);
    assert!((60..250).contains(&red), "{red}");
    // Seen straight on, all of the sheet is equally far away, but for rounding.
    let look = [Point::new(0.5, 0.5, 1.7), Point::new(0.5, 0.5, 0.0)];
    let size = PictureSize::new(320, 240).expect("a size");
    let camera = Camera::new(look, Vector::y(), 35.0, size.as_f64()).expect("a camera");
    let shown = render(&mesh, &positions, &camera, size, &RenderOptions::default());
    let red = count(&shown, palette::LIGHT.seam);
    assert!((60..250).contains(&red), "{red}");
}

#[test]
fn a_seam_that_gapes_is_drawn_stronger_than_one_that_does_not() {
    let (mut mesh, mut positions) = shapes::grid(12, 12);
    cut(
        &mut mesh,
        &mut positions,
        [down(0.41, -1.0), down(0.41, 2.0)],
        0.05,
    );
    let closed = count(&picture(&mesh, &positions), palette::LIGHT.seam);
    let components = mesh.components();
    let apart = mesh.vertices().map(|v| {
        let corner = mesh.half_edge_of(v).expect("a corner");
        let aside = components.of(corner.face()) as f64 * 0.1;
        positions.at(v) + Vector::x() * aside
    });
    let apart = Positions::new(apart.collect::<Vec<_>>()).expect("they are small");
    let open = count(&picture(&mesh, &apart), palette::LIGHT.seam);
    // Two sides, and each of them wider.
    assert!(open > 2 * closed, "{open} {closed}");
}

#[test]
fn a_seam_behind_the_surface_is_hidden() {
    // A slit in the front of a tube, and not in its back.
    let (mut mesh, mut positions) = shapes::tube(40, 20);
    let towards = |y| Ray::new(Point::new(9.0, y, 0.5), -Vector::x()).expect("a ray");
    let scissor = Scissor::new(towards(-0.2), towards(0.2)).expect("a plane");
    let scissor = scissor.with_layers(CutLayers::First);
    let log = &mut Edits::new();
    let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, log);
    assert_eq!(cut.expect("a cut").seam().count(), 1);
    let red = |x| {
        let size = PictureSize::new(320, 240).expect("a size");
        let look = [Point::new(x, 0.0, 0.5), Point::new(0.0, 0.0, 0.5)];
        let camera = Camera::new(look, Vector::z(), 35.0, size.as_f64()).expect("a camera");
        let options = RenderOptions::default();
        count(
            &render(&mesh, &positions, &camera, size, &options),
            palette::LIGHT.seam,
        )
    };
    let [front, back] = [red(8.0), red(-8.0)];
    assert!(front > 20 && back == 0, "{front} {back}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Where a cut would go is where it goes, if it takes no vertex for a crossing and no tip has to
    /// move: every end of a piece of the seam lies on a segment of the trace.
    #[test]
    fn a_cut_goes_along_its_trace(
        bumps in prop::collection::vec(-0.05..0.05, 81),
        ends in prop::array::uniform4(-0.2..1.2),
    ) {
        let (mut mesh, positions) = shapes::grid(8, 8);
        let points = positions.as_slice().iter().zip(bumps);
        let points = points.map(|(p, z)| Point::new(p.x, p.y, z));
        let mut positions = Positions::new(points).expect("they are small");
        let [ax, ay, bx, by]: [f64; 4] = ends;
        prop_assume!((ax - bx).abs() + (ay - by).abs() > 0.2);
        let rays = [down(ax, ay), down(bx, by)];
        let scissor = Scissor::new(rays[0], rays[1]).expect("a plane");
        let traced = trace(&mesh, &positions, &scissor);
        let seam = cut(&mut mesh, &mut positions, rays, 0.0);
        let length = |lines: &[[Point; 2]]| -> f64 { lines.iter().map(|[a, b]| (b - a).norm()).sum() };
        for p in seam.iter().flatten() {
            let off = traced.iter().map(|&segment| distance(*p, segment)).fold(9.0, f64::min);
            prop_assert!(off < 0.13 / 8.0, "{p} is {off} off");
        }
        prop_assert!((length(&seam) - length(&traced)).abs() < 0.26 / 8.0);
    }
}

/// How far a point is from a segment.
fn distance(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - (a + along * if part.is_nan() { 0.0 } else { part })).norm()
}
