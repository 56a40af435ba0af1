//! The vertices that closed seams would make one, and where that is no surface.

use super::groups::for_each_group;
use super::sides::joined;
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::sets::DisjointSets;

/// No class.
const NONE: u32 = u32::MAX;

/// The vertices of a mesh as they would be one with all seams closed.
pub(super) struct Classes {
    of: DisjointSets,
    /// By the smallest vertex of a class, whether a seam joins it.
    is_joined: Vec<bool>,
}

impl Classes {
    pub(super) fn of(mesh: &Mesh, edges: &[[HalfEdgeId; 2]]) -> Classes {
        let count = mesh.vertex_count() as u32;
        let mut of = DisjointSets::new(count);
        if mesh.is_torn() {
            for (root, v) in mesh.roots().into_iter().zip(0..) {
                of.join(root, v);
            }
        }
        let pairs = edges.iter().flat_map(|&edge| joined(mesh, edge));
        pairs.for_each(|[a, b]| of.join(a.to_u32(), b.to_u32()));
        let mut is_joined = vec![false; count as usize];
        let roots = of.representatives();
        for &[h, _] in edges {
            for end in [mesh.origin(h), mesh.target(h)] {
                is_joined[roots[end.index()] as usize] = true;
            }
        }
        Classes { of, is_joined }
    }

    /// The class of a vertex.
    pub(super) fn root(&mut self, v: VertexId) -> u32 {
        self.of.representative(v.to_u32())
    }

    /// Whether a seam joins a class.
    pub(super) fn is_joined(&self, root: u32) -> bool {
        self.is_joined[root as usize]
    }

    /// The classes joined by seams at which the closed mesh would have a directed edge twice (I11).
    ///
    /// It has one wherever it would have a face with one vertex twice (I3) or two faces with the same
    /// vertices (I13). Classes are joined along edges, so such a face has neighbours, and one of them has
    /// the directed edge that is there twice.
    pub(super) fn defects(&mut self, mesh: &Mesh) -> Vec<u32> {
        let roots = self.of.representatives();
        let root = |h: HalfEdgeId| roots[mesh.origin(h).index()];
        // An edge between such a class and another one is seen at the former.
        let mut corners = Vec::new();
        for (v, &root) in mesh.vertices().zip(roots) {
            if self.is_joined[root as usize] {
                corners.extend(mesh.corners_of(v));
            }
        }
        let mut bad = Vec::new();
        // By vertex, the class at which a face was seen with it as the next, and with it as the last.
        let mut seen = vec![[NONE; 2]; roots.len()];
        let key = |h: HalfEdgeId| root(h) as usize;
        for_each_group(&corners, roots.len(), key, |at_root| {
            let at = root(at_root[0]);
            let is_bad = |&h: &HalfEdgeId| {
                let [next, last] = [h.next(), h.prev()].map(root);
                let was_next = std::mem::replace(&mut seen[next as usize][0], at);
                let was_last = std::mem::replace(&mut seen[last as usize][1], at);
                was_next == at || was_last == at
            };
            if at_root.iter().any(is_bad) {
                bad.push(at);
            }
        });
        bad
    }

    /// The same classes joined along the seams: connected seams, by their smallest vertices.
    pub(super) fn connected(&self, mesh: &Mesh, edges: &[[HalfEdgeId; 2]]) -> DisjointSets {
        let mut connected = self.of.clone();
        for &[h, _] in edges {
            let [a, b] = [mesh.origin(h), mesh.target(h)].map(VertexId::to_u32);
            connected.join(a, b);
        }
        connected
    }
}
