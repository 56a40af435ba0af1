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
    // The corners of a vertex by fan, those of a fan in the order of a walk round the vertex; and of
    // each fan the smallest half-edge, and where its corners start and end.
    let (mut corners, mut fans) = (Vec::new(), Vec::new());
    for &v in vertices {
        corners.clear();
        fans.clear();
        let joined = |h: HalfEdgeId| mesh.pair(h).filter(|_| !is_cut(h));
        let mut before = None;
        for first in mesh.corners_of(v) {
            let before = before.replace(first);
            if joined(first).is_some() {
                continue;
            }
            let start = corners.len();
            let mut smallest = first;
            let mut at = Some(first);
            while let Some(h) = at {
                corners.push(h);
                smallest = smallest.min(h);
                at = joined(h.prev());
            }
            // Behind the corner where it started, a walk comes from the other side.
            if before.is_some() && corners.get(start + 1) == before.as_ref() {
                corners[start..].reverse();
            }
            fans.push((smallest, start, corners.len()));
        }
        fans.sort();
        for &(_, start, end) in fans.iter().skip(1) {
            split::into(mesh, v, &corners[start..end], fans[0].0, edits);
        }
    }
}
