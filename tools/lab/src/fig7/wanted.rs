//! What a simulation splits, and by which plane.
//!
//! The log of a mesh says which faces went to a new vertex, and not why. By the paper's rule the plane goes
//! through the vertex, and its normal leads to the other end of the overstretched edge; so it is
//! found among those that lead to a neighbour: one that divides the faces as they were divided.

use tearmesh::geometry::{Plane, Side};
use tearmesh::{Edit, Edits, FaceId, Mesh, Point, VertexId, classify, split};

/// A vertex that is to be split, and the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    /// The vertex.
    pub(super) vertex: VertexId,
    /// Faces whose centres are behind it go to a new vertex.
    pub(super) plane: Plane,
}

/// A mesh that follows a simulation a step behind, to see what it splits.
#[derive(Debug)]
pub(super) struct Wanted {
    mesh: Mesh,
    edits: Edits,
    splits: Vec<Split>,
    moved: Vec<FaceId>,
}

impl Wanted {
    /// Before anything was torn.
    pub(super) fn new(mesh: &Mesh) -> Wanted {
        Wanted {
            mesh: mesh.clone(),
            edits: Edits::new(),
            splits: Vec::new(),
            moved: Vec::new(),
        }
    }

    /// The splits in the log of a step, after which vertices are at these places.
    ///
    /// # Panics
    ///
    /// If the log has other edits, or splits that are not by the paper's rule.
    pub(super) fn of_step(&mut self, edits: &Edits, places: &[Point]) -> &[Split] {
        self.splits.clear();
        self.edits.clear();
        for edit in edits.iter() {
            let Edit::Split(done) = edit else {
                panic!("a rip does nothing but split");
            };
            self.moved.clear();
            self.moved
                .extend(done.corners.iter().map(|corner| corner.face()));
            let plane = self.plane(done.old, places);
            let plane = plane.expect("a rip splits by a plane that leads to a neighbour");
            let again = split::by_plane(&mut self.mesh, done.old, &plane, places, &mut self.edits);
            assert!(again.is_some(), "what was split can be split");
            self.splits.push(Split {
                vertex: done.old,
                plane,
            });
        }
        &self.splits
    }

    /// The plane through a vertex toward its first neighbour that has all faces that moved behind it, and
    /// no other.
    fn plane(&self, v: VertexId, places: &[Point]) -> Option<Plane> {
        let mesh = &self.mesh;
        let at = |v: VertexId| places[v.index()];
        let neighbours = mesh.corners_of(v);
        let mut neighbours = neighbours.flat_map(|h| [mesh.target(h), mesh.origin(h.prev())]);
        neighbours.find_map(|other| {
            let plane = Plane::new(at(v), at(other) - at(v)).ok()?;
            let is_as_done = |f: FaceId| {
                let is_behind = classify::face(mesh, f, &plane, places) == Side::Back;
                is_behind == self.moved.contains(&f)
            };
            mesh.faces_of(v).all(is_as_done).then_some(plane)
        })
    }
}
