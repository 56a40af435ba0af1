//! Giving each side of a seam its own vertices: how a slit opens, and how a seam is unpicked.
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

/// Splits these vertices, in this order, by the edges for which `is_cut` holds for either half-edge.
/// Fans of such a vertex that shared no edge before come apart as well.
///
/// ```text
///   o-----a-----o            o----a a----o
///   | \   #   / |            | \  | |  / |
///   |   \ # /   |            |   \| |/   |
///   o-----v-----o     ->     o----v v----o    The edges # are cut. The mesh ends at a, so a comes
///   |   / # \   |            |   / V \   |    apart; v does, where two edges are cut; w stays.
///   | /   #   \ |            | /  / \  \ |
///   o-----w-----o            o-----w-----o
/// ```
///
/// # Panics
///
/// If a vertex is not in this mesh (I2).
///
/// ```
/// use tearmesh::{Edits, HalfEdgeId, Mesh, unshare};
///
/// // Two triangles, sewn along the edge 1-2.
/// let mut mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
/// let seam = [1, 2].map(|v| mesh.vertex(v));
/// let is_seam = |h: HalfEdgeId| [1, 3].contains(&h.index());
/// unshare::by_fan(&mut mesh, &seam, is_seam, &mut Edits::new());
/// assert_eq!(mesh.indices(), [0, 1, 2, 5, 4, 3]);
/// # Ok::<(), tearmesh::BuildError>(())
/// ```
pub fn by_fan(
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
        let joined = |h: HalfEdgeId| mesh.pair(h).filter(|&g| !is_cut(h) && !is_cut(g));
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
