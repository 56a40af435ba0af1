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
use crate::mesh::{Mesh, WALL, smallest};
use crate::sets::DisjointSets;

/// The faces near the plane, and the parts of the rest that hang together.
pub(super) struct PieceCounts {
    /// By face, an element: the part of a far face that is beside one near the plane, and for a face near the
    /// plane, its place among those after the number of all faces. Of no other face is the element asked for.
    element: Vec<u32>,
    /// The number of parts that are beside faces near the plane.
    parts: u32,
    /// The number of parts that are not, which no cut changes.
    apart: usize,
    /// The faces near the plane, ascending.
    near: Vec<FaceId>,
}

/// Vertices of one side, joined by edges, that count as on the plane.
#[derive(Clone, Debug, Default)]
pub(super) struct Pinch {
    /// With repetitions.
    pub(super) chain: Vec<VertexId>,
    /// Where parts hang together that count as apart, once for each piece more that there are for that.
    pub(super) at: Vec<VertexId>,
}

impl PieceCounts {
    /// Looks at a mesh that is to be cut where `touched` faces are. O(n log n), and linear unless the faces are
    /// in a contrived order.
    pub(super) fn new(mesh: &Mesh, touched: &[FaceId]) -> PieceCounts {
        let near = round(mesh, touched);
        let (mut element, all) = mesh.parts_between(&near);
        let neighbours = near.iter().flat_map(|&f| mesh.neighbours(f));
        let far: Vec<FaceId> = neighbours.filter(|g| element[g.index()] != WALL).collect();
        let mut beside: Vec<(u32, FaceId)> = far
            .into_iter()
            .map(|g| (smallest(&mut element, g.to_u32()), g))
            .collect();
        beside.sort_unstable();
        let mut parts = 0;
        for of_part in beside.chunk_by(|one, other| one.0 == other.0) {
            for (_, g) in of_part {
                element[g.index()] = parts;
            }
            parts += 1;
        }
        for (f, i) in near.iter().zip(0..) {
            element[f.index()] = element.len() as u32 + i;
        }
        let apart = (all - parts) as usize;
        PieceCounts {
            element,
            parts,
            apart,
            near,
        }
    }

    /// Whether a cut leaves a face as it is, asked before the cut.
    #[inline]
    pub(super) fn is_far(&self, f: FaceId) -> bool {
        (self.element[f.index()] as usize) < self.element.len()
    }

    /// The faces that the cut may have changed or made, asked after it; ascending.
    pub(super) fn near_now<'m>(&'m self, mesh: &Mesh) -> impl Iterator<Item = FaceId> + 'm {
        let made = (self.element.len()..mesh.face_count()).filter_map(FaceId::new);
        self.near.iter().copied().chain(made)
    }

    /// The faces that share a vertex with some that the cut met, once vertices are inserted;
    /// ascending.
    pub(super) fn round(&self, mesh: &Mesh, met: &[FaceId]) -> Vec<FaceId> {
        let is_marked = corners(mesh, met);
        let is_round = |&f: &FaceId| mesh.face_vertices(f).iter().any(|v| is_marked[v.index()]);
        self.near_now(mesh).filter(is_round).collect()
    }

    /// The pieces of the mesh, as it was looked at or after the cut.
    pub(super) fn count(&self, mesh: &Mesh) -> usize {
        let first_new = self.element.len(); // That and all beyond were made by the cut.
        let first_node = self.parts + self.near.len() as u32;
        let node = |f: FaceId| match f.index().checked_sub(first_new) {
            Some(made) => first_node + made as u32,
            None => self.node(f, 1, 0),
        };
        let mut sets = DisjointSets::new(first_node + (mesh.face_count() - first_new) as u32);
        for f in self.near_now(mesh) {
            for g in mesh.neighbours(f) {
                sets.join(node(f), node(g));
            }
        }
        self.apart + sets.count()
    }

    /// The element that stands for part number `which` of a face. A face near the plane has `each`
    /// parts, and any other face has one.
    fn node(&self, f: FaceId, each: u32, which: u32) -> u32 {
        let element = self.element[f.index()];
        match element.checked_sub(self.element.len() as u32) {
            Some(at) => self.parts + each * at + which,
            None => element,
        }
    }

    /// The pieces that there should be, asked before the cut. `sign` is zero for a vertex on the
    /// plane; `is_slit` says of a face with vertices on both sides whether the slit crosses it from
    /// node to node, `is_slit_along` of an edge on the plane, by either half-edge, whether it is slit
    /// from end to end. `passed` is the side of a vertex that counts as on the plane although it is
    /// not, and zero for any other.
    ///
    /// The second result are the vertices at which parts hang together that count as apart.
    pub(super) fn expected(
        &self,
        mesh: &Mesh,
        sign: impl Fn(VertexId) -> f64,
        is_slit: impl Fn(FaceId) -> bool,
        is_slit_along: impl Fn(HalfEdgeId) -> bool,
        passed: impl Fn(VertexId) -> f64,
    ) -> (usize, Vec<Pinch>) {
        let signs = |f: FaceId| mesh.face_vertices(f).map(&sign);
        // Of a face that is not crossed; one that lies on the plane is in front.
        let lone_side = |signs: [f64; 3]| Side::of(signs.into_iter().fold(0.0, f64::min));
        let node = |f: FaceId, side: Side| self.node(f, 2, side as u32);
        let mut sets = DisjointSets::new(self.parts + 2 * self.near.len() as u32);
        let mut missing = 0;
        for &f in &self.near {
            let of_corners = signs(f);
            let is_crossed =
                of_corners.iter().any(|&d| d < 0.0) && of_corners.iter().any(|&d| d > 0.0);
            match is_crossed {
                true if is_slit(f) => {}
                true => sets.join(node(f, Side::Front), node(f, Side::Back)),
                false => missing += 1, // It has one part.
            }
            for (h, i) in f.half_edges().into_iter().zip(0..) {
                let Some(g) = mesh.pair(h).map(HalfEdgeId::face) else {
                    continue;
                };
                let ends = [of_corners[i], of_corners[(i + 1) % 3]];
                if ends == [0.0; 2] && !is_slit_along(h) {
                    sets.join(node(f, lone_side(of_corners)), node(g, lone_side(signs(g))));
                }
                if ends.iter().any(|&d| d > 0.0) {
                    sets.join(node(f, Side::Front), node(g, Side::Front));
                }
                if ends.iter().any(|&d| d < 0.0) {
                    sets.join(node(f, Side::Back), node(g, Side::Back));
                }
            }
        }
        let pieces = self.apart + sets.count() - missing;
        (pieces, self.pinched(mesh, &mut sets, signs, passed))
    }

    /// Joins the parts round the vertices that the plane was taken to pass through: as far as they are
    /// on the side of the vertex, they hang together there, and along the edge between two vertices
    /// of one side.
    fn pinched(
        &self,
        mesh: &Mesh,
        sets: &mut DisjointSets,
        signs: impl Fn(FaceId) -> [f64; 3],
        passed: impl Fn(VertexId) -> f64,
    ) -> Vec<Pinch> {
        let corners = self.near.iter().flat_map(|f| f.half_edges());
        let corners: Vec<HalfEdgeId> = corners.filter(|&h| passed(mesh.origin(h)) != 0.0).collect();
        let side = |h: HalfEdgeId| Side::of(passed(mesh.origin(h)));
        let mut chains = DisjointSets::new(corners.len() as u32);
        for (&h, i) in corners.iter().zip(0..) {
            let in_face = [h.next(), h.prev()].map(Some);
            let round = mesh.pair(h).map(HalfEdgeId::next);
            for other in in_face.into_iter().chain([round]).flatten() {
                if let Ok(at) = corners.binary_search(&other)
                    && side(h) == side(other)
                {
                    chains.join(i, at as u32);
                }
            }
        }
        let mut parts: Vec<Option<u32>> = vec![None; corners.len()];
        let mut pinches: Vec<Pinch> = vec![Pinch::default(); corners.len()];
        for (&h, &chain) in corners.iter().zip(chains.representatives()) {
            let pinch = &mut pinches[chain as usize];
            pinch.chain.push(mesh.origin(h));
            let is_there = |d: f64| d != 0.0 && Side::of(d) == side(h);
            if !signs(h.face()).into_iter().any(is_there) {
                continue;
            }
            let part = self.node(h.face(), 2, side(h) as u32);
            let other = *parts[chain as usize].get_or_insert(part);
            if sets.representative(part) != sets.representative(other) {
                sets.join(part, other);
                pinch.at.push(mesh.origin(h));
            }
        }
        pinches.retain(|pinch| !pinch.at.is_empty());
        pinches
    }
}

/// The faces that share a vertex with some that are to be cut, and those across from them behind a tear, where
/// an insertion divides faces as well; ascending.
fn round(mesh: &Mesh, touched: &[FaceId]) -> Vec<FaceId> {
    let mut is_left = corners(mesh, touched);
    let half_edges = || touched.iter().flat_map(|f| f.half_edges());
    let across = half_edges().filter_map(|h| mesh.ghost_pair(h));
    let mut near: Vec<FaceId> = across.map(HalfEdgeId::face).collect();
    for h in half_edges() {
        if !is_left[mesh.origin(h).index()] {
            continue;
        }
        // Once for all copies of the vertex: a walk round each would cost a hub that is torn the square of
        // its faces.
        let marked = mesh.orbit(h).filter(|&h| is_left[mesh.origin(h).index()]);
        near.extend(marked.map(HalfEdgeId::face));
        for copy in mesh.orbit(h) {
            is_left[mesh.origin(copy).index()] = false;
        }
    }
    near.sort_unstable();
    near.dedup();
    near
}

/// Whether each vertex is a corner of one of these faces. A walk round a hub that is torn would cost
/// the square of its faces.
fn corners(mesh: &Mesh, faces: &[FaceId]) -> Vec<bool> {
    let mut is_corner = vec![false; mesh.vertex_count()];
    for v in faces.iter().flat_map(|&f| mesh.face_vertices(f)) {
        is_corner[v.index()] = true;
    }
    is_corner
}
