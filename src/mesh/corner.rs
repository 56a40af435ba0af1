//! A half-edge that knows its mesh.

use std::fmt;

use super::Mesh;
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A half-edge together with its mesh, so that a way over the mesh reads from left to right.
///
/// It is made by [`Mesh::corner`], costs as much as the queries of the mesh that it stands for, and
/// borrows the mesh. Keep its [`id`](Corner::id) to edit the mesh.
///
/// ```
/// use tearmesh::shapes;
///
/// let (mesh, _) = shapes::grid(2, 2);
/// // The half-edge from vertex 4 to vertex 8, and the vertex across it.
/// let [from, to] = [4, 8].map(|v| mesh.vertex(v));
/// let h = mesh.corners_of(from).find(|&h| mesh.target(h) == to).unwrap();
/// let across = mesh.corner(h).pair().unwrap().prev();
/// assert_eq!((across.origin(), across.target()), (mesh.vertex(5), to));
/// assert_eq!(mesh.origin(mesh.pair(h).unwrap().prev()), across.origin());
/// ```
#[derive(Clone, Copy)]
pub struct Corner<'m> {
    mesh: &'m Mesh,
    id: HalfEdgeId,
}

impl Mesh {
    /// Returns a half-edge with this mesh, to walk from.
    #[inline]
    #[must_use]
    pub fn corner(&self, h: HalfEdgeId) -> Corner<'_> {
        Corner { mesh: self, id: h }
    }
}

impl<'m> Corner<'m> {
    /// Returns the half-edge itself.
    #[inline]
    #[must_use]
    pub fn id(self) -> HalfEdgeId {
        self.id
    }

    /// Returns the next half-edge of the same face: see [`HalfEdgeId::next`].
    #[inline]
    #[must_use]
    pub fn next(self) -> Corner<'m> {
        self.mesh.corner(self.id.next())
    }

    /// Returns the previous half-edge of the same face: see [`HalfEdgeId::prev`].
    #[inline]
    #[must_use]
    pub fn prev(self) -> Corner<'m> {
        self.mesh.corner(self.id.prev())
    }

    /// Returns the half-edge across the edge, if the edge is not torn: see [`Mesh::pair`].
    #[inline]
    #[must_use]
    pub fn pair(self) -> Option<Corner<'m>> {
        self.mesh.pair(self.id).map(|h| self.mesh.corner(h))
    }

    /// Returns the half-edge across a torn edge: see [`Mesh::ghost_pair`].
    #[inline]
    #[must_use]
    pub fn ghost_pair(self) -> Option<Corner<'m>> {
        self.mesh.ghost_pair(self.id).map(|h| self.mesh.corner(h))
    }

    /// Returns the vertex at which the half-edge starts: see [`Mesh::origin`].
    #[inline]
    #[must_use]
    pub fn origin(self) -> VertexId {
        self.mesh.origin(self.id)
    }

    /// Returns the vertex at which the half-edge ends: see [`Mesh::target`].
    #[inline]
    #[must_use]
    pub fn target(self) -> VertexId {
        self.mesh.target(self.id)
    }

    /// Returns the face of the half-edge.
    #[inline]
    #[must_use]
    pub fn face(self) -> FaceId {
        self.id.face()
    }
}

impl fmt::Debug for Corner<'_> {
    /// The half-edge alone, never its mesh.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.id, f)
    }
}
