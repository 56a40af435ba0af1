//! The face at the middle of each pixel, against a ray that is cast through it at every face.

use proptest::prelude::*;
use tearmesh::{FaceId, Mesh, Point, Positions, Vector, VertexId};
use tearmesh_view::{Camera, PictureSize, faces_seen};

use crate::meshes::{Eye, crumpled, eye, soup};

/// What a ray says of a pixel: the face, or that rounding may decide.
#[derive(Debug, PartialEq)]
enum Answer {
    Face(Option<FaceId>),
    Close,
}

/// Casts a ray at every face (Möller and Trumbore, 1997).
fn cast(mesh: &Mesh, points: &[Point], eye: Point, direction: Vector) -> Answer {
    let mut hits = Vec::new();
    for face in mesh.faces() {
        let [a, b, c] = mesh
            .face_vertices(face)
            .map(|v: VertexId| points[v.index()]);
        let (ab, ac) = (b - a, c - a);
        let across = direction.cross(&ac);
        let volume = ab.dot(&across);
        let from = eye - a;
        let u = from.dot(&across) / volume;
        let turned = from.cross(&ab);
        let v = direction.dot(&turned) / volume;
        let distance = ac.dot(&turned) / volume;
        let inside = u.min(v).min(1.0 - u - v);
        if inside.abs() < 1e-6 || volume.abs() < 1e-9 || distance.abs() < 1e-6 {
            if distance > -1e-6 && inside > -1e-6 || volume.abs() < 1e-9 {
                return Answer::Close;
            }
        } else if inside > 0.0 && distance > 0.0 {
            hits.push((distance, face));
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    match hits[..] {
        [(first, _), (second, _), ..] if second - first < 1e-6 => Answer::Close,
        [(_, face), ..] => Answer::Face(Some(face)),
        [] => Answer::Face(None),
    }
}

/// Nearly upward, and aslant.
const UP: Vector = Vector::new(0.1, 1.0, 0.2);

/// The direction through the middle of a pixel, by angles.
fn direction(eye: &Eye, [width, height]: [f64; 2], [x, y]: [f64; 2]) -> Vector {
    let forward = (eye.at - eye.eye).normalize();
    let right = forward.cross(&UP).normalize();
    let up = right.cross(&forward);
    let half = (eye.degrees.to_radians() / 2.0).tan();
    let across = (2.0 * (x + 0.5) / width - 1.0) * half * width / height;
    let upward = (1.0 - 2.0 * (y + 0.5) / height) * half;
    forward + right * across + up * upward
}

/// Compares all pixels; gives how many there were, and for how many rounding may decide.
fn compare(mesh: &Mesh, positions: &Positions, eye: &Eye) -> Result<[usize; 2], TestCaseError> {
    let size = PictureSize::new(23, 17).expect("a size");
    let camera = Camera::new([eye.eye, eye.at], UP, eye.degrees, size.as_f64());
    let Ok(camera) = camera else {
        return Ok([0, 0]); // It looks straight up or down.
    };
    let seen = faces_seen(mesh, positions, &camera, size);
    let mut counts = [0, 0];
    for (at, &face) in seen.iter().enumerate() {
        let place = [at % 23, at / 23].map(|x| x as f64);
        let direction = direction(eye, size.as_f64(), place);
        let ray = camera.ray(place.map(|x| x + 0.5)).expect("a ray");
        let off = ray.direction().normalize() - direction.normalize();
        prop_assert!(ray.origin() == eye.eye && off.norm() < 1e-12, "{:?}", off);
        let answer = cast(mesh, positions.as_slice(), eye.eye, direction);
        counts[usize::from(answer == Answer::Close)] += 1;
        if let Answer::Face(expected) = answer {
            prop_assert_eq!(face, expected, "pixel {:?}", place);
        }
    }
    prop_assert!(counts[1] < 40, "{:?}", counts);
    Ok(counts)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_face_of_a_pixel_is_the_one_that_a_ray_meets_first((mesh, positions) in soup(), eye in eye()) {
        compare(&mesh, &positions, &eye)?;
    }

    #[test]
    fn so_it_is_on_a_crumpled_sheet((mesh, positions) in crumpled(), eye in eye()) {
        compare(&mesh, &positions, &eye)?;
    }

    /// The middles of some pixels lie on its edges and vertices.
    #[test]
    fn no_ray_passes_between_two_faces(cells in 1u32..9, scale in -60i32..60) {
        let (mesh, positions) = tearmesh::shapes::grid(cells, cells);
        let scale = 2f64.powi(scale);
        let points: Vec<Point> = positions.as_slice().iter().map(|p| p * scale).collect();
        let at = Point::new(0.5, 0.5, 0.0) * scale;
        let eye = Point::new(0.5, 0.5, 0.25) * scale;
        let size = PictureSize::new(17, 17).expect("a size");
        let camera = Camera::new([eye, at], Vector::y(), 90.0, size.as_f64()).expect("a camera");
        // It sees half of the sheet, from a quarter to three quarters, in each direction.
        let seen = faces_seen(&mesh, &points[..], &camera, size);
        prop_assert!(seen.iter().all(Option::is_some), "{:?}", seen);
    }
}
