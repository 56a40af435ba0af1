//! The half-edge mesh: which triangles meet where, and nothing else.
//!
//! A [`Mesh`] is made of triangles by [`Mesh::build`], which accepts an oriented 2-manifold with or
//! without boundary and refuses anything else. After that three operations change it: the vertex
//! split (`split.rs`), its inverse the merge (`mend.rs`), and the insertion of vertices
//! (`insert.rs`). A torn mesh need no longer be a manifold: two fans of triangles may share a
//! vertex without sharing an edge (Souza et al. 2014, Fig. 2). All faces of such a vertex are still
//! found, because a half-edge that loses its pair keeps it as its *ghost pair* (§IV-B, Fig. 3).
//!
//! **The state of a half-edge.** In the paper, `pair` is erased when an edge is
//! torn, and saved in `ghost pair`. At any time at most one of the two is set, and
//! splits and merges never change their union. So both are one link and one bit here, "both
//! set" cannot be written down, and a ghost pair cannot be overwritten or lost.
//!
//! **What is stored.** Half-edge `h` is corner `h % 3` of face `h / 3`, so `face`,
//! `next` and `prev` are arithmetic. Stored are: the origin of each half-edge (which is
//! also the index buffer, see [`Mesh::indices`]), its link, and for each vertex its
//! smallest half-edge: 24 bytes a face and 4 a vertex. Why no pointers or hash maps:
//! ids survive, copies are cheap, and a mesh can be compared bit for bit.

mod build;
mod check;
mod components;
mod defect;
mod diagnose;
mod pieces;
mod torn;
mod walk;
mod well_formed;

use std::iter::FusedIterator;

pub use check::{Invariant, Violation};
pub use components::Components;
pub(crate) use components::{WALL, smallest};
pub use defect::{BuildError, Defect, Faces, Fans, Listed};
pub use pieces::DerivedMesh;
pub use torn::TornError;
pub use walk::Corners;

use crate::id::{FaceId, HalfEdgeId, VertexId};

/// An oriented triangle mesh that tears.
///
/// ```
/// use tearmesh::Mesh;
///
/// // Two triangles that share the edge 1-2.
/// let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
/// let h = mesh.half_edges().find(|&h| mesh.pair(h).is_some()).unwrap();
/// assert_eq!(mesh.origin(h), mesh.target(mesh.pair(h).unwrap()));
/// assert_eq!(mesh.edges().count(), 5);
/// # Ok::<(), tearmesh::BuildError>(())
/// ```
#[derive(Clone)]
pub struct Mesh {
    /// The vertex at which each half-edge starts, as `u32` so that
    /// [`Mesh::indices`] costs nothing.
    origin: Vec<u32>,
    link: Vec<Link>,
    /// For each vertex the smallest half-edge that starts there, or [`NO_HALF_EDGE`].
    /// "Smallest" makes it a function of `origin`, so an undone split leaves no trace.
    outgoing: Vec<u32>,
    /// How many times a vertex slid. No part of what the mesh is: [`PartialEq`] leaves it out.
    slides: u32,
}

/// How many vertices and faces a mesh has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshSize {
    pub(crate) vertices: u32,
    pub(crate) faces: u32,
}

const NO_HALF_EDGE: u32 = u32::MAX;

/// The opposite half-edge, and whether the link to it is torn.
///
/// 31 bits hold the half-edge, the top bit the tear. All bits set stand for the
/// original boundary, where there is no opposite.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Link(u32);

impl Link {
    const BOUNDARY: Link = Link(u32::MAX);
    const TORN: u32 = 1 << 31;

    const fn to(opposite: HalfEdgeId) -> Link {
        Link(opposite.to_u32())
    }

    #[inline]
    fn opposite(self) -> Option<HalfEdgeId> {
        (self != Self::BOUNDARY).then(|| HalfEdgeId::from_u32(self.0 & !Self::TORN))
    }

    /// Whether it leads to a pair: the edge is neither torn nor on the boundary.
    #[inline]
    const fn is_pair(self) -> bool {
        self.0 < Self::TORN
    }

    /// This link with its torn mark, redirected to the half-edge `opposite`.
    const fn renumbered(self, opposite: HalfEdgeId) -> Link {
        Link(Link::to(opposite).0 | self.0 & Self::TORN)
    }
}

impl Mesh {
    /// The largest number of faces that a mesh can have. Each face has three half-edges, and their
    /// ids stay below 2^31, so that a half-edge id and a torn mark fit into 32 bits.
    pub const MAX_FACES: usize = (1 << 31) / 3;

    /// The largest number of vertices that a mesh can be built with. Later operations never create
    /// more vertices with faces than there are half-edges, so all vertex ids fit the id type.
    pub const MAX_VERTICES: usize = 1 << 31;

    /// Returns the number of vertices, including those without faces.
    #[inline]
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.outgoing.len()
    }

    /// Returns the number of faces. Only an insertion changes it.
    #[inline]
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.origin.len() / 3
    }

    /// Returns the number of half-edges: three per face.
    #[inline]
    #[must_use]
    pub fn half_edge_count(&self) -> usize {
        self.origin.len()
    }

    /// Returns all vertices, in ascending order of their ids.
    pub fn vertices(
        &self,
    ) -> impl ExactSizeIterator<Item = VertexId> + DoubleEndedIterator + FusedIterator + Clone + use<>
    {
        (0..self.vertex_count() as u32).map(VertexId::from_u32)
    }

    /// Returns the vertex with this index, which has to be less than [`Mesh::vertex_count`].
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn vertex(&self, index: usize) -> VertexId {
        VertexId::among(self.vertex_count(), index)
    }

    /// Returns the face with this index, which has to be less than [`Mesh::face_count`].
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn face(&self, index: usize) -> FaceId {
        FaceId::among(self.face_count(), index)
    }

    /// Returns the half-edge with this index, which has to be less than [`Mesh::half_edge_count`].
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn half_edge(&self, index: usize) -> HalfEdgeId {
        HalfEdgeId::among(self.half_edge_count(), index)
    }

    /// Returns all faces, in ascending order of their ids.
    pub fn faces(
        &self,
    ) -> impl ExactSizeIterator<Item = FaceId> + DoubleEndedIterator + FusedIterator + Clone + use<>
    {
        (0..self.face_count() as u32).map(FaceId::from_u32)
    }

    /// Returns all half-edges, in ascending order of their ids.
    pub fn half_edges(
        &self,
    ) -> impl ExactSizeIterator<Item = HalfEdgeId> + DoubleEndedIterator + FusedIterator + Clone + use<>
    {
        (0..self.half_edge_count() as u32).map(HalfEdgeId::from_u32)
    }

    /// Returns the half-edge on the other side of the edge of `h`, or `None` if the edge is torn or
    /// has only one face.
    ///
    /// # Panics
    ///
    /// If `h` is not in this mesh. The same holds for all queries of a mesh; the message names the
    /// id and the invariant I2.
    #[inline]
    #[must_use]
    pub fn pair(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let link = h.of(&self.link);
        link.is_pair().then(|| HalfEdgeId::from_u32(link.0))
    }

    /// Returns the half-edge that was the pair of `h` before their edge was torn (Souza et al. 2014
    /// §IV-B), or `None` if the edge is not torn.
    #[inline]
    #[must_use]
    pub fn ghost_pair(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let link = h.of(&self.link);
        link.opposite().filter(|_| !link.is_pair())
    }

    /// Returns the pair of `h`, or its ghost pair if the edge is torn. Returns `None` only for an
    /// edge on the original boundary, which has one face.
    #[inline]
    #[must_use]
    pub fn pair_or_ghost(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        h.of(&self.link).opposite()
    }

    /// Returns the vertex at which a half-edge starts.
    #[inline]
    #[must_use]
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        VertexId::from_u32(*h.of(&self.origin))
    }

    /// Returns the vertex at which a half-edge ends.
    #[inline]
    #[must_use]
    pub fn target(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.next())
    }

    /// Returns the three vertices of a face. Vertex `i` is the origin of half-edge `i` of the face.
    #[inline]
    #[must_use]
    pub fn face_vertices(&self, f: FaceId) -> [VertexId; 3] {
        self.half_edges_of(f).map(|h| self.origin(h))
    }

    /// The half-edges of a face, which has to be one of this mesh.
    #[inline]
    #[track_caller]
    pub(crate) fn half_edges_of(&self, f: FaceId) -> [HalfEdgeId; 3] {
        if 3 * f.index() >= self.origin.len() {
            f.is_foreign(self.face_count());
        }
        f.half_edges()
    }

    /// Returns the smallest half-edge that starts at `v`, or `None` if `v` has no face.
    #[inline]
    #[must_use]
    pub fn half_edge_of(&self, v: VertexId) -> Option<HalfEdgeId> {
        let h = *v.of(&self.outgoing);
        (h != NO_HALF_EDGE).then(|| HalfEdgeId::from_u32(h))
    }

    /// Returns the vertices of all faces, three per face, as a slice of the mesh's own storage.
    /// This is an index buffer.
    #[inline]
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.origin
    }

    /// Returns each edge once, as one of its half-edges: the smaller one of each pair, and each half-edge
    /// without a pair. A torn edge counts as two edges. The half-edges are in ascending order.
    #[must_use]
    pub fn edges(&self) -> impl FusedIterator<Item = HalfEdgeId> + Clone + '_ {
        self.half_edges().filter(|&h| self.is_edge(h))
    }

    /// Whether a half-edge is the one by which [`Mesh::edges`] lists its edge.
    #[inline]
    pub(crate) fn is_edge(&self, h: HalfEdgeId) -> bool {
        // A link that is torn, and that of a boundary, is larger than any half-edge.
        h.of(&self.link).0 > h.to_u32()
    }

    /// For each face in ascending order, which of its half-edges are those by which [`Mesh::edges`] lists
    /// their edges.
    pub(crate) fn edges_of_faces(&self) -> impl Iterator<Item = [bool; 3]> + '_ {
        let links = self.link.as_chunks::<3>().0.iter().zip(0..);
        links.map(|(links, f)| [0, 1, 2].map(|i| links[i].0 > 3 * f + i as u32))
    }

    /// Reserves memory for `vertices` more vertices, so that this many splits do not reallocate.
    pub fn reserve(&mut self, vertices: usize) {
        self.outgoing.reserve(vertices);
    }

    /// Reserves memory for `faces` more faces, so that inserting this many does not reallocate. On
    /// a large mesh a reallocation takes longer than a cut.
    pub fn reserve_faces(&mut self, faces: usize) {
        self.origin.reserve(3 * faces);
        self.link.reserve(3 * faces);
    }

    /// What the log notes of a mesh with each record.
    #[inline]
    pub(crate) fn size(&self) -> MeshSize {
        MeshSize {
            vertices: self.vertex_count() as u32,
            faces: self.face_count() as u32,
        }
    }

    /// Counts a slide, and returns how many there were before.
    pub(crate) fn count_slide(&mut self) -> u32 {
        self.slides += 1;
        self.slides - 1
    }

    /// Relabels the origin of a corner. For the three operations alone: the invariants that
    /// tie origins to links are theirs to restore.
    #[inline]
    pub(crate) fn set_origin(&mut self, h: HalfEdgeId, v: VertexId) {
        self.origin[h.index()] = v.to_u32();
    }

    #[inline]
    pub(crate) fn set_half_edge_of(&mut self, v: VertexId, h: HalfEdgeId) {
        self.outgoing[v.index()] = h.to_u32();
    }

    /// The id that [`Mesh::push_vertex`] will give.
    #[inline]
    pub(crate) fn next_vertex(&self) -> VertexId {
        VertexId::from_u32(self.outgoing.len() as u32)
    }

    #[inline]
    pub(crate) fn push_vertex(&mut self, h: HalfEdgeId) {
        self.outgoing.push(h.to_u32());
    }

    /// Forgets a vertex, whose id the last one gets. The corners of both are the caller's to relabel.
    pub(crate) fn swap_remove_vertex(&mut self, v: VertexId) {
        self.outgoing.swap_remove(v.index());
    }

    /// Appends a face that is linked to nothing yet.
    pub(crate) fn push_face(&mut self, vertices: [VertexId; 3]) {
        self.origin.extend(vertices.map(VertexId::to_u32));
        self.link.extend([Link::BOUNDARY; 3]);
    }

    /// Removes the link of a half-edge. The caller must also update the opposite half-edge.
    pub(crate) fn unlink(&mut self, h: HalfEdgeId) {
        self.link[h.index()] = Link::BOUNDARY;
    }

    /// Links two half-edges, as a pair or as ghost pairs. For `insert.rs` alone, which links
    /// the parts of an edge as the edge was.
    pub(crate) fn link(&mut self, h: HalfEdgeId, g: HalfEdgeId, torn: bool) {
        let mark = if torn { Link::TORN } else { 0 };
        self.link[h.index()] = Link(Link::to(g).0 | mark);
        self.link[g.index()] = Link(Link::to(h).0 | mark);
    }

    /// Makes a pair a ghost pair, on both of its sides. For `split.rs` alone.
    #[inline]
    pub(crate) fn tear(&mut self, h: HalfEdgeId, opposite: HalfEdgeId) {
        debug_assert_eq!(
            [h, opposite].map(|h| self.pair(h)),
            [Some(opposite), Some(h)],
            "I4: the link is an involution"
        );
        self.link[h.index()].0 |= Link::TORN;
        self.link[opposite.index()].0 |= Link::TORN;
    }

    /// Makes a ghost pair a pair again, on both of its sides. For `mend.rs` alone.
    pub(crate) fn sew(&mut self, h: HalfEdgeId, opposite: HalfEdgeId) {
        debug_assert_eq!(
            [h, opposite].map(|h| self.ghost_pair(h)),
            [Some(opposite), Some(h)],
            "I4: the link is an involution"
        );
        self.link[h.index()].0 &= !Link::TORN;
        self.link[opposite.index()].0 &= !Link::TORN;
    }
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Mesh) -> bool {
        self.origin == other.origin && self.link == other.link && self.outgoing == other.outgoing
    }
}

impl Eq for Mesh {}

impl std::fmt::Debug for Mesh {
    /// Counts, never a million lines.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (vertices, faces) = (self.vertex_count(), self.face_count());
        write!(f, "Mesh({vertices} vertices, {faces} faces)")
    }
}
