//! The side of each face, where vertices may lie on the plane.
//!
//! The sign of any vertex that is not on the plane decides. Faces that lie on it as a whole
//! are taken by connected patch: where all faces round a patch agree, it has their side, for
//! touching is not cutting; where they do not, each of its faces has the side of its centre.

use crate::classify;
use crate::geometry::Side;
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;

/// The sides of faces that lie on the plane as a whole.
pub(super) struct Patches {
    /// By face.
    faces: Vec<(FaceId, Side)>,
}

impl Patches {
    /// Looks at those of `among` and at whatever they are joined to. `sign` is zero for vertices on the
    /// plane; `offset` tells the centres of faces apart.
    pub(super) fn new(
        mesh: &Mesh,
        among: impl Iterator<Item = FaceId>,
        sign: &impl Fn(VertexId) -> f64,
        offset: &impl Fn(VertexId) -> f64,
    ) -> Patches {
        let mut faces = Vec::new();
        let mut seen: Vec<bool> = Vec::new();
        for f in among.filter(|&f| by_vertex(mesh, f, sign).is_none()) {
            seen.resize(mesh.face_count(), false);
            if std::mem::replace(&mut seen[f.index()], true) {
                continue;
            }
            let mut patch = vec![f];
            let mut round = [false; 2];
            let mut next = 0;
            while let Some(&face) = patch.get(next) {
                next += 1;
                for g in mesh.neighbours(face) {
                    if let Some(side) = by_vertex(mesh, g, sign) {
                        round[usize::from(side == Side::Back)] = true;
                    } else if !std::mem::replace(&mut seen[g.index()], true) {
                        patch.push(g);
                    }
                }
            }
            let side = |face: FaceId| match round {
                [_, false] => Side::Front,
                [false, true] => Side::Back,
                [true, true] => classify::side(mesh, face, offset),
            };
            faces.extend(patch.into_iter().map(|face| (face, side(face))));
        }
        faces.sort_unstable();
        Patches { faces }
    }

    /// The side of a face among these.
    pub(super) fn side(&self, mesh: &Mesh, f: FaceId, sign: &impl Fn(VertexId) -> f64) -> Side {
        by_vertex(mesh, f, sign).unwrap_or_else(|| {
            let at = self.faces.binary_search_by_key(&f, |&(face, _)| face);
            at.map_or(Side::Front, |at| self.faces[at].1)
        })
    }
}

/// The side of a face with a vertex that is not on the plane.
fn by_vertex(mesh: &Mesh, f: FaceId, sign: &impl Fn(VertexId) -> f64) -> Option<Side> {
    let signs = mesh.face_vertices(f).map(sign);
    signs.into_iter().find(|&d| d != 0.0).map(Side::of)
}
