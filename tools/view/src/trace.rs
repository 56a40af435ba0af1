//! Where a cut would go: the line in which its plane meets the faces between its rays.

use tearmesh::geometry::between;
use tearmesh::{Mesh, Place, Plane, Point, Scissor};

/// Returns the segments in which the plane of a scissor intersects the faces of a mesh, clipped to the
/// part between its rays if the scissor has rays. There is at most one segment per face, and segments
/// are in the order of the faces.
///
/// The cut method `exact` without a snap cuts along these segments. Points on the plane count as in front
/// of it, as for every cut. A face that only touches the plane has no segment.
///
/// ```
/// use tearmesh::{shapes, Point, Ray, Scissor, Vector};
///
/// let (mesh, positions) = shapes::grid(8, 8);
/// let down = |x, y| Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0));
/// let scissor = Scissor::new(down(0.3, 0.25)?, down(0.3, 0.75)?)?;
/// let lengths = tearmesh_view::trace(&mesh, &positions, &scissor).into_iter();
/// let length: f64 = lengths.map(|[a, b]| (b - a).norm()).sum();
/// assert!((length - 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
///
/// If a vertex of the mesh is unknown to `place`.
#[must_use]
pub fn trace(mesh: &Mesh, place: &(impl Place + ?Sized), scissor: &Scissor) -> Vec<[Point; 2]> {
    let plane = scissor.plane();
    let met = mesh.faces().filter_map(|f| {
        let segment = met(&plane, mesh.face_vertices(f).map(|v| place.at(v)))?;
        match scissor.sides() {
            None => Some(segment),
            Some([a, b]) => inside(&b, inside(&a, segment)?),
        }
    });
    met.collect()
}

/// Where a plane meets a triangle.
fn met(plane: &Plane, corners: [Point; 3]) -> Option<[Point; 2]> {
    let offsets = corners.map(|p| plane.offset(p));
    let mut ends = [0, 1, 2].into_iter().filter_map(|i| {
        let j = (i + 1) % 3;
        let is_crossed = (offsets[i] < 0.0) != (offsets[j] < 0.0);
        is_crossed.then(|| crossing([corners[i], corners[j]], [offsets[i], offsets[j]]))
    });
    Some([ends.next()?, ends.next()?])
}

/// The part of a segment in front of a plane.
fn inside(plane: &Plane, [p, q]: [Point; 2]) -> Option<[Point; 2]> {
    let depths = [p, q].map(|end| plane.offset(end));
    match depths.map(|depth| depth < 0.0) {
        [false, false] => Some([p, q]),
        [true, true] => None,
        [true, false] => Some([crossing([p, q], depths), q]),
        [false, true] => Some([p, crossing([p, q], depths)]),
    }
}

/// Where the way from one point to another crosses a plane that is so far from them.
fn crossing([p, q]: [Point; 2], [from, to]: [f64; 2]) -> Point {
    between(p, q, from / (from - to))
}
