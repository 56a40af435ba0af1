//! A camera that nobody had to place: it has all of the mesh in its picture, as large as it can be.

use tearmesh::geometry::{check_point, cross, dot, length, max_abs};
use tearmesh::{Mesh, Place, Point, Vector};

use crate::bounds::Bounds;
use crate::camera::{Camera, CameraError, aside, tangent, unit};

/// The part of the picture, across and upward, that the mesh may fill.
const FILLED: f64 = 0.92;

/// How deep a box is, as a part of its longest side, that is looked at from a corner and not from
/// its broad side.
const DEEP: f64 = 0.4;

/// The default angle of view from the lower edge of a picture to the upper edge, in degrees.
pub const ANGLE_OF_VIEW: f64 = 35.0;

/// Places a camera so that the pieces of a mesh fit into its picture. Small pieces may be left out, so that
/// the crumbs of a tear that fly away do not decide what is seen: the largest pieces that hold nine tenths
/// of the area fit. The camera looks at the broad side of the mesh and a little from above. It looks from higher up at a mesh that lies flat, and from a corner at
/// a deep mesh.
///
/// `up` is upright in the picture, `degrees` is the angle of view from the lower edge to the upper edge, and
/// `size` is the width and height of the picture, in pixels.
///
/// ```
/// use tearmesh::{shapes, Vector};
///
/// let (mesh, positions) = shapes::grid(8, 8);
/// let camera = tearmesh_view::fit(&mesh, &positions, Vector::y(), 35.0, [800.0, 600.0])?;
/// let seen = camera.seen(positions.as_slice()[0]);
/// assert!(seen.x.abs() < seen.z && seen.y.abs() < seen.z);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`CameraError`] if `up` is zero or not finite, if `degrees` is not between 0 and 180, or if the mesh has no
/// visible face.
///
/// # Panics
///
/// If a vertex of the mesh is unknown to `place`.
pub fn fit(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    up: Vector,
    degrees: f64,
    size: [f64; 2],
) -> Result<Camera, CameraError> {
    fit_all([(mesh, place)], up, degrees, size)
}

/// Places one camera for several moments of a mesh, as [`fit`] does for one.
///
/// # Errors
///
/// As for [`fit`].
///
/// # Panics
///
/// If a vertex of a mesh is unknown to its places.
pub fn fit_all<'m, P: Place + ?Sized + 'm>(
    moments: impl IntoIterator<Item = (&'m Mesh, &'m P)>,
    up: Vector,
    degrees: f64,
    size: [f64; 2],
) -> Result<Camera, CameraError> {
    let up = unit(up).ok_or(CameraError::Up)?;
    let across = aside(up) - up * dot(up, aside(up));
    let across = unit(across).ok_or(CameraError::Up)?;
    let axes = [across, up, cross(across, up)];
    let moments = moments.into_iter();
    let shown = moments.flat_map(|(mesh, place)| large_pieces(mesh, place));
    let shown: Vec<Point> = shown.collect();
    let first = *shown.first().ok_or(CameraError::Empty)?;
    let along = shown
        .iter()
        .map(|&p| Point::from(axes.map(|axis| dot(p - first, axis))));
    let bounds = Bounds::around(along).expect("there is a first point");
    let halves = bounds.most.coords / 2.0 - bounds.least.coords / 2.0;
    let middle = bounds.least.coords / 2.0 + bounds.most.coords / 2.0;
    let middle = first + axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z;
    let backward = unit(backward(axes, halves)).expect("a sum of axes with positive weights");
    let right = unit(cross(up, backward)).expect("it is never looked straight down");
    let upward = cross(backward, right);
    let [width, height] = size;
    let tall = tangent(degrees / 2.0) * FILLED;
    let wide = tall * width / height;

    // The point at x, y, z from the middle, z away from the eye, is in the picture of a camera at
    // cx, cy, −far if |x − cx| ≤ wide (z + far), and likewise for y: four half-planes.
    let mut reach = [f64::NEG_INFINITY; 4];
    let mut nearest = f64::INFINITY;
    for &p in &shown {
        let from = p - middle;
        let [x, y, z] = [dot(from, right), dot(from, upward), -dot(from, backward)];
        nearest = nearest.min(z);
        let needed = [x - wide * z, -x - wide * z, y - tall * z, -y - tall * z];
        for (reach, needed) in reach.iter_mut().zip(needed) {
            *reach = reach.max(needed);
        }
    }
    let [r, l, t, b] = reach;
    let size_of = 2.0 * max_abs(halves);
    // What is a point has no size, and must be seen from somewhere.
    let least = size_of.max(max_abs(middle.coords) * 1e-6);
    let least = if least > 0.0 { least } else { 1.0 };
    let far = ((r + l) / 2.0 / wide).max((t + b) / 2.0 / tall);
    let far = far.max(least * 0.1 - nearest);
    let at = middle + right * ((r - l) / 2.0) + upward * ((t - b) / 2.0);
    Camera::new([at + backward * far, at], up, degrees, size)
}

/// The part of the area that has to be in the picture.
const SHOWN: f64 = 0.9;

/// The vertices of the largest pieces that hold enough of the area.
fn large_pieces(mesh: &Mesh, place: &(impl Place + ?Sized)) -> Vec<Point> {
    let components = mesh.components();
    let mut areas = vec![0.0; components.count()];
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
        let area = length(cross(b - a, c - a));
        areas[components.of(f)] += if area.is_finite() { area } else { 0.0 };
    }
    let mut by_area: Vec<usize> = (0..areas.len()).collect();
    by_area.sort_by(|&one, &other| areas[other].total_cmp(&areas[one]));
    let wanted = areas.iter().sum::<f64>() * SHOWN;
    let mut is_shown = vec![false; areas.len()];
    let mut sum = 0.0;
    for piece in by_area {
        // Pieces of no area, as all are if the mesh is a line, hide nothing.
        if sum > 0.0 && sum >= wanted {
            break;
        }
        is_shown[piece] = true;
        sum += areas[piece];
    }
    let vertices = mesh.vertices().filter(|&v| {
        let corner = mesh.half_edge_of(v);
        corner.is_some_and(|h| is_shown[components.of(h.face())])
    });
    let points = vertices.map(|v| place.at(v));
    points.filter(|&p| check_point(p).is_ok()).collect()
}

/// From what is looked at towards the eye, if half of the box along these axes is so long.
fn backward([across, up, depth]: [Vector; 3], halves: Vector) -> Vector {
    let [a, u, d] = halves.into();
    let longest = a.max(u).max(d);
    if u < a && u < d {
        // It lies flat.
        up * 0.9 + depth * 0.8 + across * 0.3
    } else if a < d {
        let aside = if a > DEEP * longest { 0.5 } else { 0.3 };
        across + depth * aside + up * 0.3
    } else {
        let aside = if d > DEEP * longest { 0.5 } else { 0.3 };
        depth + across * aside + up * 0.3
    }
}
