//! Pieces before a cut, after it, and into how many it should divide the mesh.
//!
//! A cut changes what hangs together near the plane alone: at faces that share a vertex with one that
//! the plane touches. What is farther away is walked over once, before the cut, and each part of it
//! that hangs together is one node from then on; the three counts are of these and of the faces near
//! the plane.
//!
//! How many pieces there should be: each face has a part in front and a part behind, as far as it has
//! either. The parts of a face are one unless the slit crosses the face fully; parts of neighbours
//! are one where they meet along an edge. What remains apart is a piece. What is in front and where
//! the slit runs is for the cut to say: whoever rounded a second time would see a piece more or less
//! than the cut where a ray passes a boundary exactly, or by less than the snap.

use crate::geometry::Side;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::sets::DisjointSets;

/// The faces near the plane, and the parts of the rest that hang together.
pub(super) struct Census {
    /// The part of each face that is far away; NEAR of the others.
    part: Vec<u32>,
    parts: u32,
    /// Ascending.
    near: Vec<FaceId>,
}

const NEAR: u32 = u32::MAX;
const UNSEEN: u32 = u32::MAX - 1;

impl Census {
    /// Looks at a mesh that is to be cut where `touched` faces are. Linear.
    pub(super) fn new(mesh: &Mesh, touched: &[FaceId]) -> Census {
        // An insertion divides the faces on both sides of a torn edge.
        let across = |h: HalfEdgeId| mesh.ghost_pair(h).map(HalfEdgeId::face);
        let half_edges = touched.iter().flat_map(|f| f.half_edges());
        let mut near = round(mesh, touched, mesh.faces());
        near.extend(half_edges.filter_map(across));
        near.sort_unstable();
        near.dedup();
        let mut census = Census {
            part: vec![UNSEEN; mesh.face_count()],
            parts: 0,
            near,
        };
        for f in &census.near {
            census.part[f.index()] = NEAR;
        }
        let mut stack = Vec::new();
        for seed in mesh.faces() {
            if census.part[seed.index()] != UNSEEN {
                continue;
            }
            census.part[seed.index()] = census.parts;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                for g in mesh.neighbours(f) {
                    if census.part[g.index()] == UNSEEN {
                        census.part[g.index()] = census.parts;
                        stack.push(g);
                    }
                }
            }
            census.parts += 1;
        }
        census
    }

    /// The faces that share a vertex with some that the cut met, once vertices are inserted;
    /// ascending.
    pub(super) fn round(&self, mesh: &Mesh, met: &[FaceId]) -> Vec<FaceId> {
        let new = (self.part.len()..mesh.face_count()).filter_map(FaceId::new);
        round(mesh, met, self.near.iter().copied().chain(new))
    }

    /// The pieces of the mesh as it was looked at.
    pub(super) fn before(&self, mesh: &Mesh) -> usize {
        self.count(mesh, mesh.face_count())
    }

    /// The pieces after the cut.
    pub(super) fn after(&self, mesh: &Mesh) -> usize {
        self.count(mesh, self.part.len())
    }

    /// Faces from number `first_new` on were made by the cut.
    fn count(&self, mesh: &Mesh, first_new: usize) -> usize {
        let new = || (first_new..mesh.face_count()).filter_map(FaceId::new);
        let first_node = self.parts + self.near.len() as u32;
        let node = |f: FaceId| match f.index().checked_sub(first_new) {
            Some(made) => first_node + made as u32,
            None => self.node(f, 1, 0),
        };
        let mut sets = DisjointSets::new(first_node + (mesh.face_count() - first_new) as u32);
        for f in self.near.iter().copied().chain(new()) {
            for g in mesh.neighbours(f) {
                sets.join(node(f), node(g));
            }
        }
        sets.count()
    }

    /// The number of a face, where each near the plane has so many, from 0.
    fn node(&self, f: FaceId, each: u32, which: u32) -> u32 {
        match self.part[f.index()] {
            NEAR => {
                let at = self.near.binary_search(&f);
                let at = at.expect("what a cut changes is near the plane");
                self.parts + each * at as u32 + which
            }
            part => part,
        }
    }

    /// The pieces that there should be, asked before the cut. `sign` is zero for a vertex on the
    /// plane; `is_slit` says of a face with vertices on both sides whether the slit crosses it from
    /// node to node, `is_slit_along` of an edge on the plane, by either half-edge, whether it is slit
    /// from end to end.
    pub(super) fn expected(
        &self,
        mesh: &Mesh,
        sign: impl Fn(VertexId) -> f64,
        is_slit: impl Fn(FaceId) -> bool,
        is_slit_along: impl Fn(HalfEdgeId) -> bool,
    ) -> usize {
        let signs = |f: FaceId| mesh.face_vertices(f).map(&sign);
        let is_crossed = |f: FaceId| {
            let signs = signs(f);
            signs.iter().any(|&d| d < 0.0) && signs.iter().any(|&d| d > 0.0)
        };
        // Of a face that is not crossed; one that lies on the plane is in front.
        let lone_side = |f: FaceId| Side::of(signs(f).into_iter().fold(0.0, f64::min));
        let node = |f: FaceId, side: Side| self.node(f, 2, side as u32);
        let mut sets = DisjointSets::new(self.parts + 2 * self.near.len() as u32);
        let mut missing = 0;
        for &f in &self.near {
            match (is_crossed(f), is_slit(f)) {
                (true, true) => {}
                (true, false) => sets.join(node(f, Side::Front), node(f, Side::Back)),
                (false, _) => missing += 1, // It has one part.
            }
            for h in f.half_edges() {
                let Some(g) = mesh.pair(h).map(HalfEdgeId::face) else {
                    continue;
                };
                let ends = [mesh.origin(h), mesh.target(h)].map(&sign);
                if ends == [0.0; 2] && !is_slit_along(h) {
                    sets.join(node(f, lone_side(f)), node(g, lone_side(g)));
                }
                if ends.iter().any(|&d| d > 0.0) {
                    sets.join(node(f, Side::Front), node(g, Side::Front));
                }
                if ends.iter().any(|&d| d < 0.0) {
                    sets.join(node(f, Side::Back), node(g, Side::Back));
                }
            }
        }
        sets.count() - missing
    }
}

/// Those of some faces that share a vertex with some others. Walks round a hub that is torn would
/// cost the square of its faces.
fn round(mesh: &Mesh, others: &[FaceId], of: impl Iterator<Item = FaceId>) -> Vec<FaceId> {
    let mut marked = vec![false; mesh.vertex_count()];
    for v in others.iter().flat_map(|&f| mesh.face_vertices(f)) {
        marked[v.index()] = true;
    }
    let is_round = |&f: &FaceId| mesh.face_vertices(f).iter().any(|v| marked[v.index()]);
    of.filter(is_round).collect()
}
