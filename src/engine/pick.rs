//! Picking: finding the face that a ray meets first, such as the one under the mouse pointer.
//!
//! ```text
//!            ray
//!             │           Which side of each edge the ray passes is the sign of a determinant.
//!       c─────┼──b        A face is met if no two of its three differ. The face across an edge
//!        ╲  . ▼ ╱         asks for the same determinant, turned over: where it is zero the ray
//!         ╲    ╱          goes through the edge, and meets both.
//!          ╲  ╱
//!           a             The determinants, as parts of their sum, are the weights of the corners.
//! ```
//!
//! The differences between the vertices and the origin of the ray are rounded once. The signs
//! computed from them are exact, so no ray slips between two faces or through a vertex. (Woop,
//! Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, fall back on higher
//! precision if a determinant is zero. Here products are computed without rounding whenever
//! rounding could have changed the sign.) This holds if no product of three coordinates is below
//! the range of `f64`, that is, for coordinates of at least 1e-90 units.
//!
//! All faces are tested, in the order of their ids. The cost is linear, and no search tree must be
//! updated while the mesh moves and tears.

use crate::attribute::Blend as _;
use crate::exact::{ExactSum, ROUNDING, product};
use crate::geometry::{Point, Ray, Vector, cross, dot, length, scaled};
use crate::id::FaceId;
use crate::mesh::Mesh;
use crate::place::Place;

/// The point at which a ray meets a face: see [`first_hit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The face that the ray meets.
    pub face: FaceId,
    /// The barycentric coordinates of the hit point, in the order of the face's corners. Their sum
    /// is one up to rounding. The weight of a corner is exactly zero if the ray passes through the
    /// opposite edge, and exactly one if it passes through the corner.
    pub weights: [f64; 3],
    /// The distance of the hit point from the origin of the ray, in units of the model.
    pub distance: f64,
}

impl RayHit {
    /// Returns the point at which the ray meets the face.
    ///
    /// # Panics
    ///
    /// If the face is not one of this mesh, or `place` does not store the positions of its vertices.
    #[must_use]
    pub fn point(&self, mesh: &Mesh, place: &(impl Place + ?Sized)) -> Point {
        let corners = mesh.face_vertices(self.face).map(|v| place.at(v));
        Point::weighted(corners.each_ref(), self.weights)
    }
}

/// Returns the nearest face that a ray meets, from either side, or `None` if it meets no face.
///
/// If several faces are equally near, the result is the one with the lowest id. Faces whose edges or
/// vertices coincide, torn or not, meet a ray through them at exactly the same distance. For faces that
/// overlap, the distances agree up to rounding. A ray in the plane of a face does not meet this face.
///
/// ```
/// use tearmesh::engine::pick;
/// use tearmesh::{insert::Plan, shapes, Edits, Point, Ray, Vector};
///
/// // Put a vertex where the mouse points.
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let mouse = Ray::new(Point::new(0.3, 0.55, 2.0), Vector::new(0.0, 0.0, -1.0))?;
/// let hit = pick::first_hit(&mesh, &positions, &mouse).expect("the sheet is below");
/// assert_eq!(hit.distance, 2.0);
///
/// let (mut edits, mut plan) = (Edits::new(), Plan::new());
/// plan.in_face(hit.face, hit.weights); // refused where the ray goes through an edge: a weight is zero
/// plan.apply(&mut mesh, &mut edits)?;
/// edits.replay(&mut positions);
/// assert!((positions.as_slice()[81] - Point::new(0.3, 0.55, 0.0)).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
///
/// If `place` does not store the position of a vertex of the mesh.
#[must_use]
pub fn first_hit(mesh: &Mesh, place: &(impl Place + ?Sized), ray: &Ray) -> Option<RayHit> {
    hits(mesh, place, ray).min_by(|one, other| one.distance.total_cmp(&other.distance))
}

/// All faces that a ray meets, in the order of their ids.
pub(crate) fn hits(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    ray: &Ray,
) -> impl Iterator<Item = RayHit> {
    let direction = scaled(ray.direction()).expect("a ray has a direction");
    let (per_distance, along, origin) = (length(direction), direction.iamax(), ray.origin());
    mesh.faces().filter_map(move |face| {
        let corners = mesh.face_vertices(face).map(|v| place.at(v));
        let seen = corners.map(|corner: Point| corner - origin);
        if passes_by(seen, direction, along) {
            return None;
        }
        let (weights, side) = weights(seen, direction)?;
        // A sum of two numbers beside a zero does not depend on their order, so the faces of an edge agree.
        let [a, b, c] = [0, 1, 2].map(|i| weights[i] * dot(seen[i], direction));
        let distance = match side {
            0.0 => 0.0,
            _ => (a + b + c) / per_distance,
        };
        let is_in_front = side >= 0.0 && !distance.is_nan();
        is_in_front.then_some(RayHit {
            face,
            weights,
            // What is in front is not behind by rounding. Adding zero makes -0 a 0.
            distance: distance.max(0.0) + 0.0,
        })
    })
}

/// Whether all corners of a triangle are on one side of a plane through the line from the origin, beyond rounding:
/// then the line does not meet it. The planes are parallel to two of the axes and `along` is the third, the one to
/// which the direction is nearest. Nearly all faces are refused here, for a seventh of what [`weights`] costs.
fn passes_by(corners: [Vector; 3], direction: Vector, along: usize) -> bool {
    let is_beside = |axis: usize| {
        let sides = corners.map(|corner| {
            let parts = [
                corner[axis] * direction[along],
                corner[along] * direction[axis],
            ];
            let side = parts[0] - parts[1];
            let is_sure = side.abs() > ROUNDING * (parts[0].abs() + parts[1].abs());
            if is_sure { side } else { 0.0 }
        });
        sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
    };
    is_beside((along + 1) % 3) || is_beside((along + 2) % 3)
}

/// The weights of the corners of a triangle where a line through the origin meets it, and a number with
/// the sign of the distance: zero just where the origin is in the plane of the triangle. None where the
/// line does not meet it, or runs along its plane.
fn weights(corners: [Vector; 3], direction: Vector) -> Option<([f64; 3], f64)> {
    let [a, b, c] = corners;
    let parts = [[b, c], [c, a], [a, b]].map(|[from, to]| determinant(direction, from, to));
    let all = |is: fn(f64) -> bool| parts.into_iter().all(is);
    if !(all(|part| part >= 0.0) || all(|part| part <= 0.0)) {
        return None;
    }
    let mut weights = [0.0; 3];
    let met = [0, 1, 2].map(|i| parts[i] != 0.0);
    match met {
        [false, false, false] => return None,
        [true, true, true] => {
            let [a, b, c] = parts;
            weights = parts.map(|part| part / (a + b + c));
        }
        _ => {
            // On an edge its ends alone tell where, so that both of its faces say the same.
            let off = |i: usize| length(cross(corners[i], direction));
            let ends: Vec<usize> = (0..3).filter(|&i| met[i]).collect();
            match ends[..] {
                [i, j] => {
                    let whole = off(i) + off(j);
                    let part = |other: usize| match whole > 0.0 {
                        true => off(other) / whole,
                        false => 0.5,
                    };
                    weights[i] = part(j);
                    weights[j] = part(i);
                }
                _ => weights[ends[0]] = 1.0,
            }
        }
    }
    // Whatever their lengths, the sign of their volume is the same. A corner at the origin has no direction.
    let side = match corners.map(scaled) {
        [Some(a), Some(b), Some(c)] => determinant(a, b, c),
        _ => dot(a, cross(b, c)),
    };
    let is_from_behind = all(|part| part <= 0.0);
    Some((weights, if is_from_behind { -side } else { side }))
}

/// d · (p × q), with the sign that it has without rounding; of (q, p) it is the same number negated.
fn determinant(d: Vector, p: Vector, q: Vector) -> f64 {
    let rough = dot(d, cross(p, q));
    let products = [[p.y, q.z, d.x], [p.z, q.x, d.y], [p.x, q.y, d.z]];
    let others = [[p.z, q.y, d.x], [p.x, q.z, d.y], [p.y, q.x, d.z]];
    let size = |[a, b, c]: [f64; 3]| (a * b * c).abs();
    let bound: f64 = ROUNDING
        * (0..3)
            .map(|i| size(products[i]) + size(others[i]))
            .sum::<f64>();
    if rough.abs() > bound || !bound.is_finite() {
        return rough;
    }
    let mut sum = ExactSum::new();
    for ([a, b, c], sign) in products
        .map(|abc| (abc, 1.0))
        .into_iter()
        .chain(others.map(|abc| (abc, -1.0)))
    {
        for part in product(a, b) {
            sum.extend(product(part, sign * c));
        }
    }
    sum.to_f64()
}
