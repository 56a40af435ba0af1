//! The classification of faces as lying in front of a plane or behind it.
//!
//! A face is behind a plane if its centre is strictly behind it (Souza et al. 2014 §IV: "the ones
//! whose centers are behind the plane are assigned to the new vertex"). Three times the signed
//! distance of the centre is the sum of the signed distances of the corners. They are summed in
//! ascending order of vertices, so the result does not depend on the order of corners. A sum of
//! zero counts as front. If the plane passes through a vertex v of the face, v contributes exactly
//! zero, and the condition for the back is n·(b − v) + n·(c − v) < 0.

use crate::geometry::{Plane, Side};
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// Returns the side of a plane on which the centre of a face lies. A centre on the plane counts as front.
///
/// # Panics
///
/// If `f` is not in this mesh (I2), or `place` does not store the positions of its vertices.
#[must_use]
pub fn face(mesh: &Mesh, f: FaceId, plane: &Plane, place: &(impl Place + ?Sized)) -> Side {
    side(mesh, f, |v| plane.offset(place.at(v)))
}

/// The side of a face's centre, from the offsets of its vertices that were computed before.
pub(crate) fn side(mesh: &Mesh, f: FaceId, offset: impl Fn(VertexId) -> f64) -> Side {
    let mut corners = mesh.face_vertices(f);
    corners.sort();
    let [a, b, c] = corners.map(offset);
    Side::of(a + b + c)
}
