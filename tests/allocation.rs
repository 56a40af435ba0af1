//! What promises not to allocate does not.

use allocation_counter::measure;
use tearmesh::{Edits, Masses, Mesh, Plane, Positions, Vector, shapes, split};

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
            splits += usize::from(split::faces(mesh, v, &[face], edits).is_ok());
            assert!(split::faces(mesh, v, &[face, face], edits).is_err());
            edits.replay(&mut (&mut *positions, &mut *masses));
        }
        splits
    }
}

#[test]
fn splits_and_replay_do_not_allocate_where_room_was_made() {
    // Without room a vector has to grow, and the counter sees it.
    let mut torn = Torn::new();
    assert!(allocations(|| assert!(torn.tear() > 0)) > 0);

    let mut torn = Torn::new();
    torn.reserve();
    let mut splits = 0;
    assert_eq!(allocations(|| splits = torn.tear()), 0);
    assert!(splits > 500, "only {splits} splits");
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

#[test]
fn steps_of_a_cloth_do_not_allocate() {
    use tearmesh::cloth::{
        Bending, Cloth, Fabric, Loads, Pbd, Provot, Rk4, Solver, Unstable, Verlet, Xpbd,
    };

    let (mesh, positions) = shapes::grid(10, 10);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let fabric = Fabric {
        bend: Some(Bending::Spring {
            stiffness_n_per_m: 1.0,
        }),
        ..Fabric::new(50.0)
    };
    let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
    let loads = Loads {
        gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -9.81)),
        drag_per_s: Some(1.0),
        ..Loads::default()
    };
    let system = cloth.system_mut();
    system.set_loads(loads).expect("loads");
    system.hold(0);
    system.when_unstable(Unstable::Substep);
    let (mut provot, mut rk4) = (Provot::default(), Rk4::new());
    let methods: [&mut dyn Solver; 5] = [
        &mut Verlet::new(),
        &mut provot,
        &mut Pbd::default(),
        &mut Xpbd::default(),
        &mut rk4,
    ];
    for method in methods {
        // The first step makes room.
        cloth.step(&mut *method, 0.005).expect("a step");
        let taken = allocations(|| {
            for _ in 0..5 {
                cloth.step(&mut *method, 0.005).expect("a step");
            }
        });
        assert_eq!(taken, 0);
    }
}

#[test]
fn steps_of_a_cloth_of_triangles_do_not_allocate() {
    use tearmesh::cloth::{Cloth, Fabric, ImplicitCloth, Rk4, Solver, Unstable, Verlet, Weave};

    let (mesh, positions) = shapes::grid(10, 10);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let fabric = Fabric::woven(Weave {
        warp_n_per_m: 50.0,
        weft_n_per_m: 40.0,
        shear_n_per_m: 5.0,
        warp: Vector::x(),
    });
    let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
    let system = cloth.system_mut();
    system.hold(0);
    system.state_mut().1[60] = Vector::new(0.1, 0.1, 0.3);
    system.when_unstable(Unstable::Substep);
    let (mut implicit, mut rk4) = (ImplicitCloth::default(), Rk4::new());
    let methods: [&mut dyn Solver; 3] = [&mut Verlet::new(), &mut rk4, &mut implicit];
    for method in methods {
        // The first step makes room.
        cloth.step(&mut *method, 0.005).expect("a step");
        let taken = allocations(|| {
            for _ in 0..5 {
                cloth.step(&mut *method, 0.005).expect("a step");
            }
        });
        assert_eq!(taken, 0);
    }
}

#[test]
fn looking_for_tears_allocates_nothing() {
    use tearmesh::cloth::{Cloth, Fabric, Tear, Tearing, Threshold};

    let (mut mesh, positions) = shapes::grid(10, 10);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(50.0)).expect("a cloth");
    for x in cloth.system_mut().state_mut().0 {
        x.x *= 1.2;
    }
    let mut edits = Edits::new();
    for threshold in [Threshold::Stretch(1.5), Threshold::PrincipalStretch(1.5)] {
        let mut tear = Tear::new(&cloth, Tearing::new(threshold)).expect("a tear");
        // The first look makes room.
        tear.apply(&mut mesh, &mut cloth, &mut edits, 0.01);
        let taken = allocations(|| {
            for _ in 0..5 {
                let report = tear.apply(&mut mesh, &mut cloth, &mut edits, 0.01);
                assert_eq!((report.splits, report.worst.is_some()), (0, true));
            }
        });
        assert_eq!(taken, 0);
    }
}
