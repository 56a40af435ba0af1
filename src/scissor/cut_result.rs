//! The result of a cut, from which reports are made.

use crate::edit::Edits;
use crate::geometry::Side;
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;

/// Faces and their sides of a cut, by face; `None` for one that may lie on both, beyond a tip.
pub(super) type Sides = Vec<(FaceId, Option<Side>)>;

/// The side of a face, if it is among them and has one.
pub(super) fn side_of(sides: &[(FaceId, Option<Side>)], f: FaceId) -> Option<Side> {
    let at = sides.binary_search_by_key(&f, |&(face, _)| face).ok()?;
    sides[at].1
}

/// The faces whose sides a report asks for, once all vertices are inserted.
pub(super) type CrumbFilter<'j> = &'j dyn Fn(&Mesh, &Edits) -> Vec<FaceId>;

/// The result of a cut by any method.
#[derive(Default)]
pub(super) struct CutResult {
    /// The side on which the method meant each face to be that has a vertex on the seam.
    pub(super) touched: Sides,
    /// The sides of the faces that the caller asked for.
    pub(super) judged: Sides,
    /// The splits that were tried in vain.
    pub(super) refused: usize,
    /// The vertices at which each side plane ended a cut of the method `exact`.
    pub(super) ends: [Vec<VertexId>; 2],
    /// Vertices of the seam that leave the plane inside a face, so that no face gets thin.
    pub(super) off_plane: Vec<VertexId>,
}

/// The faces that have one of these vertices, ascending.
pub(super) fn faces_at(mesh: &Mesh, vertices: &[VertexId]) -> Vec<FaceId> {
    let faces = vertices.iter().flat_map(|&v| mesh.faces_of(v));
    let mut faces: Vec<FaceId> = faces.collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}
