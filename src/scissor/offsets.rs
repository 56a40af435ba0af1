//! How far each vertex is from the cutting plane, once for all.

use crate::exact::ROUNDING;
use crate::geometry::{Plane, Point, max_abs};
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// For each vertex a number with the sign of its signed distance from the plane.
pub(super) struct Offsets {
    of: Vec<f64>,
    /// What rounding alone explains of a distance.
    bound: f64,
    /// What counts as zero.
    zero: f64,
}

impl Offsets {
    pub(super) fn new(plane: &Plane, positions: &Positions) -> Offsets {
        let mut reach = max_abs(plane.point().coords);
        let offset = |&p: &Point| {
            reach = reach.max(max_abs(p.coords));
            plane.offset(p)
        };
        let of = positions.as_slice().iter().map(offset).collect();
        Offsets {
            of,
            bound: ROUNDING * reach,
            zero: 0.0,
        }
    }

    /// The same, and zero where rounding cannot vouch for the sign.
    pub(super) fn rounded(self) -> Offsets {
        Offsets {
            zero: self.bound,
            ..self
        }
    }

    pub(super) fn bound(&self) -> f64 {
        self.bound
    }

    /// The number of vertices.
    pub(super) fn len(&self) -> usize {
        self.of.len()
    }

    #[inline]
    pub(super) fn of(&self, v: VertexId) -> f64 {
        let offset = self.of[v.index()];
        if offset.abs() <= self.zero {
            0.0
        } else {
            offset
        }
    }

    /// Whether a face has vertices strictly on both sides of the plane.
    pub(super) fn cross(&self, mesh: &Mesh, f: FaceId) -> bool {
        let offsets = mesh.face_vertices(f).map(|v| self.of(v));
        offsets.iter().any(|&d| d < 0.0) && offsets.iter().any(|&d| d > 0.0)
    }

    /// The faces that the plane meets at all, if only in a corner.
    pub(super) fn touched(&self, mesh: &Mesh) -> Vec<FaceId> {
        // An eighth of the offsets: what is looked up for every corner should fit the cache.
        let side = |&d: &f64| u8::from(d < -self.zero) | u8::from(d > self.zero) << 1;
        let sides: Vec<u8> = self.of.iter().map(side).collect();
        let corners = mesh.indices().as_chunks::<3>().0.iter();
        let touches = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|v| sides[v as usize]);
            a & b & c == 0
        };
        let faces = mesh.faces().zip(corners);
        faces
            .filter(|(_, triangle)| touches(triangle))
            .map(|(f, _)| f)
            .collect()
    }
}
