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
use crate::id::{FaceId, HalfEdgeId, VertexId};
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
        for faces in fans.leaving() {
            split::faces(mesh, v, faces, edits).expect("a fan is some of a vertex's faces");
        }
    }
}

/// The faces of a vertex, grouped by fan. Reused from vertex to vertex.
#[derive(Default)]
struct Fans {
    faces: Vec<FaceId>,
    /// The smallest half-edge of each fan, and where its faces end.
    fans: Vec<(HalfEdgeId, usize, usize)>,
}

impl Fans {
    /// Groups the faces of `v` by the edges at `v` that join them: those with a pair for
    /// which `is_cut` does not hold.
    fn find(&mut self, mesh: &Mesh, v: VertexId, is_cut: impl Fn(HalfEdgeId) -> bool) {
        self.faces.clear();
        self.fans.clear();
        let joined = |h: HalfEdgeId| mesh.pair(h).filter(|_| !is_cut(h));
        for first in mesh.corners_of(v).filter(|&h| joined(h).is_none()) {
            let start = self.faces.len();
            let mut smallest = first;
            let mut at = Some(first);
            while let Some(h) = at {
                self.faces.push(h.face());
                smallest = smallest.min(h);
                at = joined(h.prev());
            }
            self.fans.push((smallest, start, self.faces.len()));
        }
        self.fans.sort();
    }

    /// The faces of each fan that does not keep the vertex.
    fn leaving(&self) -> impl Iterator<Item = &[FaceId]> {
        self.fans
            .iter()
            .skip(1)
            .map(|&(_, start, end)| &self.faces[start..end])
    }
}
