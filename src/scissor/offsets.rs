//! The distance of each vertex from the cutting plane, computed once for all.

use crate::exact::ROUNDING;
use crate::geometry::{Plane, Point, max_abs};
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// For each vertex a number with the sign of its signed distance from the plane.
pub(super) struct Offsets {
    of: Vec<f64>,
    touched: Vec<FaceId>,
    /// What rounding alone explains of a distance.
    bound: f64,
    /// What counts as zero.
    zero: f64,
}

impl Offsets {
    /// Measures all vertices. If `rounded`, what rounding cannot vouch for is zero.
    pub(super) fn new(plane: &Plane, rounded: bool, mesh: &Mesh, positions: &Positions) -> Offsets {
        let mut reach = max_abs(plane.point().coords);
        let offset = |&p: &Point| {
            reach = reach.max(max_abs(p.coords));
            plane.offset(p)
        };
        let of: Vec<f64> = positions.as_slice().iter().map(offset).collect();
        let bound = ROUNDING * reach;
        let zero = if rounded { bound } else { 0.0 };
        // By vertex, whether it is behind the plane and whether it is in front: an eighth of the
        // offsets, so that what is looked up for every corner fits the cache.
        let side = |&d: &f64| u8::from(d < -zero) | u8::from(d > zero) << 1;
        let sides: Vec<u8> = of.iter().map(side).collect();
        let corners = mesh.indices().as_chunks::<3>().0.iter();
        let touches = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|v| sides[v as usize]);
            a & b & c == 0
        };
        let faces = mesh.faces().zip(corners);
        let touched = faces.filter(|(_, triangle)| touches(triangle));
        Offsets {
            touched: touched.map(|(f, _)| f).collect(),
            of,
            bound,
            zero,
        }
    }

    pub(super) fn bound(&self) -> f64 {
        self.bound
    }

    /// The number of vertices.
    pub(super) fn len(&self) -> usize {
        self.of.len()
    }

    /// The offset of each vertex, as it was computed.
    pub(super) fn all(&self) -> &[f64] {
        &self.of
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

    /// The faces that the plane meets at all, if only in a corner; ascending.
    pub(super) fn touched(&self) -> &[FaceId] {
        &self.touched
    }
}
