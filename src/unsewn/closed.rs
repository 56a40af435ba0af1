//! Seams that are closed while a cut is made.

use super::sides::joined;
use crate::edit::{Cursor, Edit, Follower, InsertedPoint, Mix};
use crate::id::VertexId;
use crate::mesh::Mesh;

/// Seams that are closed for a while, so that a cut can cross them: see [`UnsewnSeams::close`](super::UnsewnSeams::close).
///
/// It follows the log of the mesh. Replay every edit on it before the seams are reopened.
#[derive(Clone, Debug)]
pub struct ClosedSeams {
    /// By vertex: vertices that are one but for tears have the same. Seams do not matter. Empty if there
    /// are none.
    pub(super) classes: Vec<u32>,
    pub(super) next: u32,
    pub(super) seen: Cursor,
}

impl ClosedSeams {
    /// Sets the place in the mesh's log at which the seams were closed. The default is [`Cursor::START`].
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> ClosedSeams {
        ClosedSeams { seen, ..self }
    }

    /// Removes the links that [`UnsewnSeams::close`](super::UnsewnSeams::close) added, and those of the parts into which they
    /// were divided since. Linear.
    ///
    /// # Panics
    ///
    /// If this has not followed all edits of the mesh.
    pub fn reopen(self, mesh: &mut Mesh) {
        if self.classes.is_empty() {
            return;
        }
        let count = mesh.vertex_count();
        assert_eq!(
            self.classes.len(),
            count,
            "the seams have followed the mesh"
        );
        let class = |v: VertexId| self.classes[v.index()];
        mesh.open_seams(|mesh, h, g| {
            let pairs = joined(mesh, [h, g]);
            pairs.into_iter().any(|[a, b]| class(a) != class(b))
        });
    }

    fn push_class(&mut self) {
        self.classes.push(self.next);
        self.next += 1;
    }

    /// Whether two points are on the two sides of an edge that is torn without any seam closed.
    fn are_twins(&self, one: &InsertedPoint, other: &InsertedPoint) -> bool {
        let (Mix::Between { ends, t }, Mix::Between { ends: across, t: u }) = (one.at, other.at)
        else {
            return false;
        };
        let class = |v: VertexId| self.classes[v.index()];
        t == u && ends.map(class) == across.map(class)
    }
}

impl Follower for ClosedSeams {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        if self.classes.is_empty() {
            return;
        }
        match edit {
            Edit::Split(split) => self.classes.push(self.classes[split.old.index()]),
            Edit::Insert(insert) => {
                let mut before: Option<&InsertedPoint> = None;
                for point in insert.points {
                    match before.filter(|one| self.are_twins(one, point)) {
                        Some(one) => {
                            self.classes.push(self.classes[one.vertex.index()]);
                            before = None;
                        }
                        None => {
                            self.push_class();
                            before = Some(point);
                        }
                    }
                }
            }
            Edit::Merge(merge) => _ = self.classes.swap_remove(merge.gone.index()),
            Edit::Slide(_) => {}
        }
    }
}
