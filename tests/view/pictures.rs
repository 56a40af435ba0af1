//! Whole pictures: golden ones, cameras that are found, and meshes that are strange.

use proptest::prelude::*;
use tearmesh::{CutMethod, Edits, Mesh, Plane, Point, Positions, Ray, Scissor, Vector, shapes};
use tearmesh_view::{
    Camera, CameraError, Picture, PictureSize, RenderOptions, fit, render, write_drawn,
};

use crate::digest;
use crate::meshes::{crumpled, soup};

fn size(width: u32, height: u32) -> PictureSize {
    PictureSize::new(width, height).expect("a size")
}

/// A torus cut in two, with all that can be drawn. Whoever changes how pictures look looks at it, and
/// says so in the commit.
#[test]
fn a_golden_picture_is_the_same_on_every_machine() {
    let (mut mesh, mut positions) = shapes::torus(24, 12);
    let across = |y| Ray::new(Point::new(-5.0, y, 0.3), Vector::x()).expect("a ray");
    let scissor = Scissor::new(across(-3.0), across(3.0)).expect("a plane");
    let log = &mut Edits::new();
    scissor
        .cut(CutMethod::Exact, &mut mesh, &mut positions, log)
        .expect("a cut");
    let next = [
        across(0.2),
        Ray::new(Point::new(-5.0, 0.3, 1.0), Vector::x()).expect("a ray"),
    ];
    let options = RenderOptions {
        edges: true,
        bounding_box: true,
        cuts: vec![Scissor::new(next[0], next[1]).expect("a plane")],
        rays: next.to_vec(),
        ground: Some(Vector::y()),
        finer: 2,
        fringe: true,
        ..RenderOptions::default()
    };
    let camera = fit(&mesh, &positions, Vector::y(), 35.0, [160.0, 120.0]);
    let camera = camera.expect("a camera");
    let picture = render(&mesh, &positions, &camera, size(160, 120), &options);
    let digest = digest::after(digest::EMPTY, picture.pixels().iter().copied());
    assert_eq!(digest, GOLDEN, "{digest:#018x}");
}

const GOLDEN: u64 = 0xd0c8_f46c_f205_97fe;

#[test]
fn a_png_has_the_pixels_of_its_picture() {
    let (mesh, positions) = shapes::octahedron();
    let camera = fit(&mesh, &positions, Vector::y(), 35.0, [31.0, 17.0]);
    let camera = camera.expect("a camera");
    let picture = render(
        &mesh,
        &positions,
        &camera,
        size(31, 17),
        &RenderOptions::default(),
    );
    let mut file = Vec::new();
    picture.write_png(&mut file).expect("bytes");
    let mut reader = png::Decoder::new(std::io::Cursor::new(&file))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("a picture");
    assert_eq!(
        (info.width, info.height, info.color_type),
        (31, 17, png::ColorType::Rgb)
    );
    assert_eq!(pixels, picture.pixels());
}

/// Four threads hang out of each side of a torn edge that gapes, and each line of a finer figure is two.
#[test]
fn a_drawn_surface_is_written_with_its_fringe() {
    let (mut mesh, mut positions) = shapes::grid(9, 9);
    let plane = Plane::new(Point::new(0.43, 0.0, 0.0), Vector::x()).expect("a plane");
    let (scissor, log) = (Scissor::by_plane(plane), &mut Edits::new());
    let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, log);
    assert!(cut.is_ok());
    let components = mesh.components();
    let mut points = positions.as_slice().to_vec();
    for v in mesh.vertices() {
        let corner = mesh.half_edge_of(v).expect("a face");
        points[v.index()].y -= 0.5 * components.of(corner.face()) as f64;
    }
    let options = RenderOptions {
        finer: 2,
        fringe: true,
        ..RenderOptions::default()
    };
    let mut file = Vec::new();
    write_drawn(&mesh, &points[..], &options, &mut file).expect("bytes");
    let text = String::from_utf8(file).expect("a text");
    let (surface, fringe) = text.split_once("g fringe\n").expect("a group");
    let count = |word: &str| {
        surface
            .lines()
            .filter(|line| line.starts_with(word))
            .count()
    };
    let torn = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
    assert_eq!(fringe.lines().count(), torn.count() * 4 * 2);
    assert!(fringe.lines().all(|line| line.starts_with("l ")));
    assert_eq!(count("f "), 4 * mesh.face_count());
    assert_eq!(count("v "), count("vn "));
    let numbers = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    let largest = numbers
        .filter_map(|number| number.parse::<usize>().ok())
        .max();
    assert_eq!(largest, Some(count("v ")));
}

/// The dust of a tear may be anywhere: only large pieces decide what is seen.
#[test]
fn a_crumb_far_away_does_not_make_the_rest_small() {
    let (mesh, positions) = shapes::grid(8, 8);
    let alone = fit(&mesh, &positions, Vector::y(), 35.0, [40.0, 30.0]);
    let mut faces: Vec<[u32; 3]> = mesh.indices().as_chunks().0.to_vec();
    let mut points = positions.as_slice().to_vec();
    let first = points.len() as u32;
    faces.push([first, first + 1, first + 2]);
    let crumb = [[50.0, 0.0, 0.0], [50.1, 0.0, 0.0], [50.0, 0.1, 0.0]];
    points.extend(crumb.map(Point::from));
    let mesh = Mesh::build(points.len(), &faces).expect("a mesh");
    let with_crumb = fit(&mesh, &points[..], Vector::y(), 35.0, [40.0, 30.0]);
    assert_eq!(with_crumb, alone);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// At every scale and place, and as large as can be: it touches the part of the picture that it may
    /// fill, across or upward.
    #[test]
    fn a_camera_that_is_found_sees_all(
        (mesh, positions) in crumpled(),
        exponent in -150i32..150,
        shift in prop::array::uniform3(-1e3..1e3),
        up in prop::array::uniform3(-1.0..1.0),
        angle in 5.0..80.0,
        [width, height] in prop::array::uniform2(300.0..999.0),
    ) {
        let scale = 2f64.powi(exponent);
        let moved = positions.as_slice().iter().map(|p| (p + Vector::from(shift)) * scale);
        let positions = Positions::new(moved).expect("they are finite");
        let camera = fit(&mesh, &positions, Vector::from(up), angle, [width, height]);
        let camera = camera.expect("up is a direction");
        let mut most = 0.0f64;
        for &p in positions.as_slice() {
            let seen = camera.seen(p);
            prop_assert!(seen.z > 0.0);
            let [x, y] = [seen.x / seen.z, seen.y / seen.z].map(f64::abs);
            prop_assert!(x < 0.93 && y < 0.93, "{} {}", x, y);
            most = most.max(x).max(y);
        }
        prop_assert!(most > 0.5, "{}", most);
    }

    #[test]
    fn no_camera_and_no_mesh_make_it_panic(
        (mesh, positions) in soup(),
        numbers in prop::array::uniform9(any::<f64>()),
        angle in any::<f64>(),
    ) {
        let [a, b, c, d, e, f, x, y, z] = numbers;
        let look = [Point::new(a, b, c), Point::new(d, e, f)];
        if let Ok(camera) = Camera::new(look, Vector::new(x, y, z), angle, [40.0, 30.0]) {
            let _ = render(&mesh, &positions, &camera, size(40, 30), &RenderOptions::default());
        }
        // As the camera of the command: numbers are finite.
        let look = look.map(|p| p.map(|x| if x.is_finite() { x } else { 1.0 }));
        if let Ok(camera) = Camera::new(look, Vector::y(), 40.0, [40.0, 30.0]) {
            let options = RenderOptions { edges: true, bounding_box: true, ..RenderOptions::default() };
            let _ = render(&mesh, &positions, &camera, size(40, 30), &options);
        }
    }
}

/// Draws what is there, by the camera that is found; none if there is nothing.
fn drawn(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Option<Picture> {
    let mesh = Mesh::build(points.len(), triangles).expect("a mesh");
    let positions = Positions::new(points.to_vec()).expect("they are finite");
    let camera = fit(&mesh, &positions, Vector::y(), 35.0, [40.0, 30.0]);
    let camera = camera.map_err(|error| assert_eq!(error, CameraError::Empty));
    let options = RenderOptions {
        bounding_box: true,
        ..RenderOptions::default()
    };
    Some(render(
        &mesh,
        &positions,
        &camera.ok()?,
        size(40, 30),
        &options,
    ))
}

#[test]
fn strange_meshes_have_pictures_or_none() {
    let triangle = [[0u32, 1, 2]];
    let shown = |points: &[[f64; 3]]| {
        let picture = drawn(points, &triangle).expect("a picture");
        let background = picture.at(0, 0);
        picture
            .pixels()
            .as_chunks::<3>()
            .0
            .iter()
            .filter(|pixel| **pixel != background)
            .count()
    };
    assert!(drawn(&[[0.0; 3]; 3], &[]).is_none(), "no face, no picture");
    // Small, large and far ones look alike.
    let plain = shown(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert!(plain > 200, "{plain}");
    for scale in [1e-100, 1e-30, 1e30, 1e70] {
        let points = [[0.0, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, 0.0]];
        assert_eq!(shown(&points), plain, "{scale}");
    }
    let far = shown(&[[1e6, 0.0, 0.0], [1e6 + 1.0, 0.0, 0.0], [1e6, 1.0, 0.0]]);
    assert!(far.abs_diff(plain) <= 4, "{far} {plain}");
    // A point, and a line.
    assert!(shown(&[[0.0; 3]; 3]) > 0);
    assert!(shown(&[[1e30; 3]; 3]) > 0);
    assert!(shown(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]) > 10);
}
