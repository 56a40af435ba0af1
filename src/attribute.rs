//! Data beside the mesh that a split copies, or leaves alone.
//!
//! A split duplicates a vertex and moves corners. What belongs to the vertex is copied
//! to the new one ([`PerVertex`]). What belongs to the corner, such as a texture
//! coordinate, stays with it ([`PerCorner`]): a split never makes a texture seam.

use crate::edit::{Edit, Follower};
use crate::id::{HalfEdgeId, VertexId};

/// One value for each vertex. The new vertex of a split has a copy of the old one's.
///
/// ```
/// use tearmesh::{shapes, split, Edits, FaceId, PerVertex, VertexId};
///
/// let (mut mesh, _) = shapes::grid(1, 1);
/// let mut colours = PerVertex::new(vec!["red", "green", "blue", "black"]);
/// let mut edits = Edits::new();
/// let v = VertexId::new(0).unwrap();
/// split::faces(&mut mesh, v, &[FaceId::new(0).unwrap()], &mut edits)?;
/// edits.replay(&mut colours);
/// assert_eq!(colours[VertexId::new(4).unwrap()], "red");
/// # Ok::<(), tearmesh::split::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerVertex<T> {
    values: Vec<T>,
    next_edit: u64,
}

impl<T: Clone> PerVertex<T> {
    /// The values of vertices 0, 1, 2, …, which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        PerVertex {
            values,
            next_edit: 0,
        }
    }

    /// The same values, for a log whose next record has this number.
    #[must_use]
    pub fn starting_at(self, next_edit: u64) -> Self {
        PerVertex { next_edit, ..self }
    }

    /// Makes room for this many more vertices, so that as many splits can be replayed without
    /// allocation but that of the clones.
    pub fn reserve(&mut self, vertices: usize) {
        self.values.reserve(vertices);
    }

    /// The values of all vertices, by id.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T> std::ops::Index<VertexId> for PerVertex<T> {
    type Output = T;

    fn index(&self, v: VertexId) -> &T {
        &self.values[v.index()]
    }
}

impl<T: Clone> Follower for PerVertex<T> {
    fn next_edit(&self) -> u64 {
        self.next_edit
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => {
                let count = self.values.len();
                assert_eq!(split.new.index(), count, "values are in step with the mesh");
                self.values.push(self[split.old].clone());
            }
        }
        self.next_edit = edit.number() + 1;
    }
}

/// One value for each corner. A split leaves them where they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerCorner<T> {
    values: Vec<T>,
    next_edit: u64,
}

impl<T> PerCorner<T> {
    /// The values of corners 0, 1, 2, … (three a face), which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        PerCorner {
            values,
            next_edit: 0,
        }
    }

    /// The same values, for a log whose next record has this number.
    #[must_use]
    pub fn starting_at(self, next_edit: u64) -> Self {
        PerCorner { next_edit, ..self }
    }

    /// The values of all corners, by half-edge.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T> std::ops::Index<HalfEdgeId> for PerCorner<T> {
    type Output = T;

    fn index(&self, h: HalfEdgeId) -> &T {
        &self.values[h.index()]
    }
}

impl<T> Follower for PerCorner<T> {
    fn next_edit(&self) -> u64 {
        self.next_edit
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            // The corners move with their faces to another vertex, and keep their values.
            Edit::Split(_) => {}
        }
        self.next_edit = edit.number() + 1;
    }
}
