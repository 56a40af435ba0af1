//! How far each vertex is from the cutting plane, once for all.

use super::ROUNDING;
use crate::geometry::{Plane, max_abs};
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// For each vertex a number with the sign of its signed distance from the plane.
pub(super) struct Offsets {
    of: Vec<f64>,
    /// What rounding alone explains of a distance.
    bound: f64,
}

impl Offsets {
    pub(super) fn new(plane: &Plane, positions: &Positions) -> Offsets {
        let points = positions.as_slice();
        let reach = points.iter().map(|p| max_abs(p.coords));
        let reach = reach.fold(max_abs(plane.point().coords), f64::max);
        Offsets {
            of: points.iter().map(|&p| plane.offset(p)).collect(),
            bound: ROUNDING * reach,
        }
    }

    /// The same, and zero where rounding cannot vouch for the sign.
    pub(super) fn rounded(self) -> Offsets {
        let Offsets { mut of, bound } = self;
        for offset in &mut of {
            if offset.abs() <= bound {
                *offset = 0.0;
            }
        }
        Offsets { of, bound }
    }

    pub(super) fn bound(&self) -> f64 {
        self.bound
    }

    #[inline]
    pub(super) fn of(&self, v: VertexId) -> f64 {
        self.of[v.index()]
    }

    /// Whether a face has vertices strictly on both sides of the plane.
    pub(super) fn cross(&self, mesh: &Mesh, f: FaceId) -> bool {
        let offsets = mesh.corners(f).map(|v| self.of(v));
        offsets.iter().any(|&d| d < 0.0) && offsets.iter().any(|&d| d > 0.0)
    }

    /// Whether the plane meets a face at all, if only in a corner.
    #[inline]
    pub(super) fn touch(&self, mesh: &Mesh, f: FaceId) -> bool {
        let [a, b, c] = mesh.corners(f).map(|v| self.of(v));
        a.min(b).min(c) <= 0.0 && a.max(b).max(c) >= 0.0
    }
}
