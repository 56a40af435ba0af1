//! The mean edge of a mesh before a cut, and its smallest altitude away from the cut.
//!
//! A face away from the plane is the same before a cut and after it. So one pass before the cut looks at all
//! faces, for both numbers, and after the cut only the faces near the plane are looked at again.

use crate::geometry::{AltitudeMin, Point, Vector, dot};
use crate::id::FaceId;
use crate::mesh::Mesh;
use crate::place::Positions;

/// A mesh before a cut.
pub(super) struct Survey {
    /// The mean length of the edges.
    pub(super) mean_edge: f64,
    /// The smallest altitude of the faces that are not near the plane.
    altitude_far: AltitudeMin,
}

impl Survey {
    /// Looks at a mesh of which the cut may change all faces that are not far. Linear.
    pub(super) fn new(
        mesh: &Mesh,
        positions: &Positions,
        is_far: impl Fn(FaceId) -> bool,
    ) -> Survey {
        let points = positions.as_slice();
        let (mut sum, mut count) = (0.0, 0u32);
        let mut altitude_far = AltitudeMin::NONE;
        let triangles = mesh.indices().as_chunks::<3>().0.iter();
        for ((&triangle, is_edge), f) in triangles.zip(mesh.edges_of_faces()).zip(mesh.faces()) {
            let sides = sides(triangle.map(|v| points[v as usize]));
            for (side, is_edge) in sides.into_iter().zip(is_edge) {
                // Which half-edge lists an edge is as good as random, so a branch would be taken wrongly a
                // quarter of the time. Zero leaves the sum as it is.
                let mask = u64::from(is_edge).wrapping_neg();
                sum += f64::from_bits(dot(side, side).to_bits() & mask).sqrt();
                count += u32::from(is_edge);
            }
            if is_far(f) {
                altitude_far.take(sides);
            }
        }
        Survey {
            mean_edge: sum / f64::from(count.max(1)),
            altitude_far,
        }
    }

    /// The smallest altitude of a mesh after a cut, of which `near` are the faces that the cut may have
    /// changed or made; 0 for a mesh without faces.
    pub(super) fn altitude_min(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        near: impl Iterator<Item = FaceId>,
    ) -> f64 {
        let mut altitude = self.altitude_far;
        for f in near {
            altitude.take(sides(mesh.face_vertices(f).map(|v| positions.at(v))));
        }
        altitude.least().unwrap_or(0.0)
    }
}

/// The sides of a triangle. The first runs from the first corner to the second.
#[inline]
fn sides([a, b, c]: [Point; 3]) -> [Vector; 3] {
    [b - a, c - b, a - c]
}
