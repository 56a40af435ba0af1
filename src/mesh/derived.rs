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
    /// The corners in the order of those of the source; empty where this is their own.
    corners_by_source: Vec<HalfEdgeId>,
}

impl DerivedMesh {
    pub(crate) fn new(
        mesh: Mesh,
        vertices: Vec<VertexId>,
        faces: Vec<FaceId>,
        corners: Vec<HalfEdgeId>,
    ) -> DerivedMesh {
        let mut corners_by_source = Vec::new();
        if !corners.is_sorted() {
            corners_by_source.extend(mesh.half_edges());
            corners_by_source.sort_unstable_by_key(|h| corners[h.index()]);
        }
        DerivedMesh {
            mesh,
            vertices,
            faces,
            corners,
            corners_by_source,
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

    /// Returns the vertices of the derived mesh that come from the vertex `source` of the source
    /// mesh. The result is empty if there are none. Logarithmic.
    pub fn vertices_of(&self, source: VertexId) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        let start = self.vertices.partition_point(|&v| v < source);
        let end = self.vertices.partition_point(|&v| v <= source);
        (start as u32..end as u32).map(VertexId::from_u32)
    }

    /// Returns the face of the derived mesh that comes from the given face of the source, or `None`
    /// if there is none. Logarithmic.
    #[must_use]
    pub fn face_of(&self, source: FaceId) -> Option<FaceId> {
        let at = self.faces.binary_search(&source).ok()?;
        Some(FaceId::from_u32(at as u32))
    }

    /// Returns the corner of the derived mesh that comes from the given corner of the source, or
    /// `None` if there is none. Logarithmic.
    #[must_use]
    pub fn corner_of(&self, source: HalfEdgeId) -> Option<HalfEdgeId> {
        if self.corners_by_source.is_empty() {
            let at = self.corners.binary_search(&source).ok()?;
            return Some(HalfEdgeId::from_u32(at as u32));
        }
        let own = |h: &HalfEdgeId| self.corners[h.index()];
        let at = self.corners_by_source.binary_search_by_key(&source, own);
        at.ok().map(|at| self.corners_by_source[at])
    }

    /// Returns the values of the derived mesh's vertices, copied from `of_source`, which has one
    /// value for each vertex of the source.
    ///
    /// # Panics
    ///
    /// If `of_source` does not have a value for each vertex of the source.
    #[must_use]
    pub fn vertex_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        let values = self.vertices.iter().map(|v| v.of(of_source).clone());
        values.collect()
    }

    /// Returns the values of the derived mesh's faces, copied from `of_source`, which has one value
    /// for each face of the source.
    ///
    /// # Panics
    ///
    /// If `of_source` does not have a value for each face of the source.
    #[must_use]
    pub fn face_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        self.faces.iter().map(|f| f.of(of_source).clone()).collect()
    }

    /// Returns the values of the derived mesh's corners, copied from `of_source`, which has three
    /// values for each face of the source.
    ///
    /// # Panics
    ///
    /// If `of_source` does not have three values for each face of the source.
    #[must_use]
    pub fn corner_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        let values = self.corners.iter().map(|h| h.of(of_source).clone());
        values.collect()
    }
}
