//! What promises not to allocate does not.

use allocation_counter::measure;
use tearmesh::engine::DrawBuffers;
use tearmesh::{Edits, HalfEdgeId, Masses, Mesh, Plane, Positions, Vector, shapes, split};

/// The number of allocations that something takes.
fn allocations(of: impl FnOnce()) -> u64 {
    measure(of).count_total
}

/// Everything that follows a sheet while it is torn.
struct Torn {
    mesh: Mesh,
    positions: Positions,
    masses: Masses,
    edits: Edits,
}

impl Torn {
    fn new() -> Torn {
        let (mesh, positions) = shapes::grid(20, 20);
        let masses = Masses::area(&mesh, &positions, 1.0).expect("a unit square has mass");
        Torn {
            mesh,
            positions,
            masses,
            edits: Edits::new(),
        }
    }

    fn reserve(&mut self) {
        let (splits, corners) = (
            2 * self.mesh.vertex_count(),
            2 * self.mesh.half_edge_count(),
        );
        self.mesh.reserve(splits);
        self.edits.reserve(splits, corners, corners);
        self.positions.reserve(splits);
        self.masses.reserve(splits);
    }

    /// Splits every vertex by a plane, and one face off it; tries what is refused, too.
    /// Returns the number of splits.
    fn tear(&mut self) -> usize {
        let Torn {
            mesh,
            positions,
            masses,
            edits,
        } = self;
        let mut splits = 0;
        for v in mesh.vertices() {
            let plane = Plane::new(positions.at(v), Vector::new(1.0, 0.2, 0.0)).expect("a normal");
            splits += usize::from(split::by_plane(mesh, v, &plane, &*positions, edits).is_some());
            edits.replay(&mut (&mut *positions, &mut *masses));
            let face = mesh.faces_of(v).next().expect("every vertex keeps a face");
            splits += usize::from(split::vertex(mesh, v, &[face], edits).is_ok());
            assert!(split::vertex(mesh, v, &[face, face], edits).is_err());
            edits.replay(&mut (&mut *positions, &mut *masses));
        }
        splits
    }
}

#[test]
fn splits_and_replay_do_not_allocate_in_reserved_room() {
    // Without room a vector has to grow, and the counter sees it.
    let mut torn = Torn::new();
    assert!(allocations(|| assert!(torn.tear() > 0)) > 0);

    let mut torn = Torn::new();
    torn.reserve();
    let mut splits = 0;
    assert_eq!(allocations(|| splits = torn.tear()), 0);
    assert!(splits > 500, "only {splits} splits");
}

/// Whatever the values are: one for the whole mesh, or one for each face, so that there are as many slots as corners.
#[test]
fn buffers_that_follow_splits_do_not_allocate_in_reserved_room() {
    for corners_with_a_value in [usize::MAX, 3] {
        let (mut mesh, _) = shapes::grid(8, 8);
        let value = |h: HalfEdgeId| (h.index() / corners_with_a_value) as f64;
        let values = mesh.half_edges().map(value);
        let made = DrawBuffers::new(&mesh, values.collect());
        let mut buffers = made.clone(); // That has no room to spare.
        assert_eq!(
            buffers.len() == mesh.half_edge_count(),
            corners_with_a_value == 3
        );
        let mut edits = Edits::new();
        // The second time changes wait, of which there may be more than slots.
        for _ in 0..2 {
            buffers.reserve(mesh.vertex_count());
            for v in mesh.vertices() {
                let moving: Vec<_> = mesh.faces_of(v).skip(1).collect();
                let _refused_for_the_last_face = split::vertex(&mut mesh, v, &moving, &mut edits);
            }
            assert_eq!(allocations(|| edits.replay(&mut buffers)), 0);
            edits.clear();
        }
    }
}

#[test]
fn walks_do_not_allocate() {
    let (mesh, _) = shapes::torus(20, 20);
    let taken = allocations(|| {
        let corners: usize = mesh.vertices().map(|v| mesh.corners_of(v).count()).sum();
        let faces: usize = mesh.vertices().map(|v| mesh.faces_of(v).count()).sum();
        let fans: usize = mesh.vertices().map(|v| mesh.fans(v).count()).sum();
        let joined: usize = mesh.half_edges().map(|h| mesh.fan(h).count()).sum();
        let edges = mesh.edges().count();
        let boundary: usize = mesh
            .half_edges()
            .map(|h| mesh.boundary_loop(h).count())
            .sum();
        assert_eq!((corners, faces, fans, joined), (2400, 2400, 400, 14_400));
        assert_eq!((edges, boundary), (1200, 0));
        assert!(mesh.vertices().all(|v| mesh.root(v) == v));
    });
    assert_eq!(taken, 0);
}
