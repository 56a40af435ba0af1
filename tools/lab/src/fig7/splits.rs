//! The splits of a simulation, found from its log.
//!
//! The log of a mesh has the faces that went to a new vertex, and not the plane that divided them. By the
//! paper's rule the plane goes through the vertex, and its normal leads to the other end of the overstretched
//! edge. So it is found among the planes that lead to a neighbour: one that divides the faces as they were
//! divided.

use tearmesh::geometry::{Plane, Side};
use tearmesh::{Edit, Edits, FaceId, Mesh, Point, VertexId, classify, split};

/// A split of a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) vertex: VertexId,
    /// The plane. Faces whose centres are behind it go to a new vertex.
    pub(super) plane: Plane,
}

/// A copy of the mesh of a simulation that follows it, split by split.
#[derive(Debug)]
pub(super) struct Replica {
    mesh: Mesh,
}

impl Replica {
    /// Creates the copy before the first tear.
    pub(super) fn new(mesh: &Mesh) -> Replica {
        Replica { mesh: mesh.clone() }
    }

    /// Repeats the log of a step, given the places of the vertices after it, and returns its splits.
    ///
    /// # Panics
    ///
    /// If the log has other edits, or splits that are not by the paper's rule.
    pub(super) fn follow(&mut self, edits: &Edits, places: &[Point]) -> Vec<Split> {
        let splits = edits.iter().map(|edit| {
            let Edit::Split(done) = edit else {
                panic!("a rip does nothing but split");
            };
            let moved = done.corners.iter().map(|corner| corner.face());
            let moved: Vec<FaceId> = moved.collect();
            let (vertex, plane) = (done.old, self.plane(done.old, &moved, places));
            let plane = plane.expect("a rip splits by a plane that leads to a neighbour");
            let mut edits = Edits::new();
            let again = split::by_plane(&mut self.mesh, vertex, &plane, places, &mut edits);
            assert!(again.is_some(), "a split can be repeated on a copy");
            Split { vertex, plane }
        });
        splits.collect()
    }

    /// The plane through a vertex toward its first neighbour that has the moved faces behind it, and no other.
    fn plane(&self, v: VertexId, moved: &[FaceId], places: &[Point]) -> Option<Plane> {
        let mesh = &self.mesh;
        let at = |v: VertexId| places[v.index()];
        let neighbours = mesh.corners_of(v);
        let mut neighbours = neighbours.flat_map(|h| [mesh.target(h), mesh.origin(h.prev())]);
        neighbours.find_map(|other| {
            let plane = Plane::new(at(v), at(other) - at(v)).ok()?;
            let is_on_its_side = |f: FaceId| {
                let is_behind = classify::face(mesh, f, &plane, places) == Side::Back;
                is_behind == moved.contains(&f)
            };
            mesh.faces_of(v).all(is_on_its_side).then_some(plane)
        })
    }
}
