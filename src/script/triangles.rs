//! A follower that keeps a list of the triangles.

use crate::edit::{Cursor, Edit, Follower};
use crate::mesh::Mesh;

/// The triangles of a mesh, updated from the records of its log alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangles {
    indices: Vec<u32>,
    seen: Cursor,
}

impl Triangles {
    pub(super) fn new(mesh: &Mesh) -> Triangles {
        Triangles {
            indices: mesh.indices().to_vec(),
            seen: Cursor::START,
        }
    }

    /// Returns the three vertices of each face, indexed by face.
    #[must_use]
    pub fn as_slice(&self) -> &[[u32; 3]] {
        self.indices.as_chunks().0
    }
}

impl Follower for Triangles {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for op in edit.corner_ops() {
            op.apply_to_indices(&mut self.indices);
        }
    }
}
