//! A mesh that was derived from another one, with maps back to it.

use super::Mesh;
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A mesh that was derived from another one, its *source*. Each of its vertices, faces and corners
/// is mapped to the one in the source that it comes from. [`Mesh::pieces`] and
/// [`Insertions::undone`](crate::Insertions::undone) return such meshes.
///
/// The derived mesh needs a new log. Its followers start at
/// [`Cursor::START`](crate::Cursor::START), with values that are copied from those of the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DerivedMesh {
    mesh: Mesh,
    /// Ascending.
    vertices: Vec<VertexId>,
    /// Strictly ascending.
    faces: Vec<FaceId>,
    corners: Vec<HalfEdgeId>,
}

impl DerivedMesh {
    pub(crate) fn new(
        mesh: Mesh,
        vertices: Vec<VertexId>,
        faces: Vec<FaceId>,
        corners: Vec<HalfEdgeId>,
    ) -> DerivedMesh {
        DerivedMesh {
            mesh,
            vertices,
            faces,
            corners,
        }
    }

    /// Returns the derived mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns the derived mesh and discards the maps.
    #[must_use]
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// Returns the vertex of the source that each vertex of the derived mesh comes from. The list is
    /// indexed by derived vertex and ascending; it may contain a vertex of the source more than once.
    #[must_use]
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// Returns the face of the source that each face of the derived mesh comes from. The list is
    /// indexed by derived face and ascending.
    #[must_use]
    pub fn faces(&self) -> &[FaceId] {
        &self.faces
    }

    /// Returns the corner of the source that each corner of the derived mesh comes from. The list
    /// is indexed by derived half-edge.
    #[must_use]
    pub fn corners(&self) -> &[HalfEdgeId] {
        &self.corners
    }
}
