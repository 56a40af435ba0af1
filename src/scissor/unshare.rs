//! Giving each side of a seam its own vertices.
//!
//! At each vertex of the seam, faces that are joined through edges that are not seam stay
//! together: a *fan*. The fan with the smallest half-edge keeps the vertex, every other one gets
//! a vertex of its own. So both sides share no vertex there, and tips, ends on the boundary and
//! places where cuts meet need no rule of their own. (One split where there are more than two
//! fans would leave bow-ties.)
//!
//! The order of the splits does not change the fans: a split tears seam edges only,
//! and those separate fans before and after.

use crate::edit::Edits;
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::split;

/// Splits these vertices, in this order, by the edges for which `is_cut` holds.
pub(super) fn by_fan(
    mesh: &mut Mesh,
    vertices: &[VertexId],
    is_cut: impl Fn(HalfEdgeId) -> bool,
    edits: &mut Edits,
) {
    let mut fans = Fans::default();
    for &v in vertices {
        fans.find(mesh, v, &is_cut);
        for corners in fans.leaving() {
            split::off(mesh, v, corners, edits);
        }
    }
}

/// The corners of a vertex, grouped by fan. Reused from vertex to vertex.
#[derive(Default)]
struct Fans {
    corners: Vec<HalfEdgeId>,
    /// The smallest half-edge of each fan, and where its corners start and end.
    fans: Vec<(HalfEdgeId, usize, usize)>,
}

impl Fans {
    /// Groups the corners of `v` by the edges at `v` that join them: those with a pair for
    /// which `is_cut` does not hold. Those of a fan are in the order of a walk round `v`.
    fn find(&mut self, mesh: &Mesh, v: VertexId, is_cut: impl Fn(HalfEdgeId) -> bool) {
        self.corners.clear();
        self.fans.clear();
        let joined = |h: HalfEdgeId| mesh.pair(h).filter(|_| !is_cut(h));
        let mut before = None;
        for first in mesh.corners_of(v) {
            let before = before.replace(first);
            if joined(first).is_some() {
                continue;
            }
            let start = self.corners.len();
            let mut smallest = first;
            let mut at = Some(first);
            while let Some(h) = at {
                self.corners.push(h);
                smallest = smallest.min(h);
                at = joined(h.prev());
            }
            // Behind the corner where it started, a walk comes from the other side.
            if before.is_some() && self.corners.get(start + 1) == before.as_ref() {
                self.corners[start..].reverse();
            }
            self.fans.push((smallest, start, self.corners.len()));
        }
        self.fans.sort();
    }

    /// The corners of each fan that does not keep the vertex.
    fn leaving(&self) -> impl Iterator<Item = &[HalfEdgeId]> {
        self.fans
            .iter()
            .skip(1)
            .map(|&(_, start, end)| &self.corners[start..end])
    }
}
