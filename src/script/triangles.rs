//! A follower that has the triangles.

use crate::edit::{Edit, Follower};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;

/// The triangles of a mesh, kept up to date by the records alone: the smallest follower
/// that understands all of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangles {
    of: Vec<[u32; 3]>,
    next_edit: u64,
}

impl Triangles {
    pub(super) fn new(mesh: &Mesh) -> Triangles {
        let of = mesh.faces().map(|f| mesh.face_vertices(f).map(u32::from));
        Triangles {
            of: of.collect(),
            next_edit: 0,
        }
    }

    /// The vertices of each face, by id.
    #[must_use]
    pub fn as_slice(&self) -> &[[u32; 3]] {
        &self.of
    }

    fn relabel(&mut self, corners: &[HalfEdgeId], v: VertexId) {
        for h in corners {
            self.of[h.face().index()][h.corner()] = v.into();
        }
    }
}

impl Follower for Triangles {
    fn next_edit(&self) -> u64 {
        self.next_edit
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => self.relabel(split.corners, split.new),
            Edit::Insert(insert) => {
                for child in insert.children {
                    let vertices = child.vertices.map(u32::from);
                    if child.face == child.parent {
                        self.of[child.face.index()] = vertices;
                    } else {
                        assert_eq!(child.face.index(), self.of.len(), "faces are in step");
                        self.of.push(vertices);
                    }
                }
            }
            Edit::Merge(merge) => {
                self.relabel(merge.corners, merge.kept);
                if let Some(renumbered) = merge.renumbered {
                    self.relabel(renumbered.corners, renumbered.to);
                }
            }
            Edit::Slide(_) => {}
        }
        self.next_edit = edit.number() + 1;
    }
}
