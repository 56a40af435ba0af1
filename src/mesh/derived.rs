//! A mesh that was derived from another one, with maps back to it.

use super::Mesh;
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A mesh that was derived from another one, its *source*. It knows from which vertex, face and
/// corner of the source each of its own comes. [`Mesh::pieces`] and
/// [`Insertions::undone`](crate::Insertions::undone) make such meshes.
///
/// The log of a new mesh starts anew: its followers begin at [`Cursor::START`](crate::Cursor::START),
/// with values that are taken over from those of the source.
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

    /// The derived mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The derived mesh, without its maps.
    #[must_use]
    pub fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// For each vertex, the vertex of the source that it comes from. Ascending; two vertices may
    /// come from the same one.
    #[must_use]
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// For each face, the face of the source that it comes from. Ascending.
    #[must_use]
    pub fn faces(&self) -> &[FaceId] {
        &self.faces
    }

    /// For each corner, which is also a half-edge, the corner of the source that it comes from.
    #[must_use]
    pub fn corners(&self) -> &[HalfEdgeId] {
        &self.corners
    }

    /// The vertices that come from a vertex of the source; empty if it is not in this mesh.
    /// Logarithmic.
    pub fn vertices_of(&self, source: VertexId) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        let start = self.vertices.partition_point(|&v| v < source);
        let end = self.vertices.partition_point(|&v| v <= source);
        (start as u32..end as u32).map(VertexId::from_u32)
    }

    /// The face that comes from a face of the source, if it is in this mesh. Logarithmic.
    #[must_use]
    pub fn face_of(&self, source: FaceId) -> Option<FaceId> {
        let at = self.faces.binary_search(&source).ok()?;
        Some(FaceId::from_u32(at as u32))
    }

    /// The corner that comes from a corner of the source, if it is in this mesh. Logarithmic.
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

    /// Selects the values of this mesh's vertices from those of the source.
    ///
    /// # Panics
    ///
    /// If there is not a value for each vertex of the source.
    #[must_use]
    pub fn vertex_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        let values = self.vertices.iter().map(|v| v.of(of_source).clone());
        values.collect()
    }

    /// Selects the values of this mesh's faces from those of the source.
    ///
    /// # Panics
    ///
    /// If there is not a value for each face of the source.
    #[must_use]
    pub fn face_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        self.faces.iter().map(|f| f.of(of_source).clone()).collect()
    }

    /// Selects the values of this mesh's corners from those of the source.
    ///
    /// # Panics
    ///
    /// If there are not three values for each face of the source.
    #[must_use]
    pub fn corner_values<T: Clone>(&self, of_source: &[T]) -> Vec<T> {
        let values = self.corners.iter().map(|h| h.of(of_source).clone());
        values.collect()
    }
}
