//! What cloth costs, by counters. By a clock: `tools/bench`, subcommand `cloth`.

use tearmesh::{Mesh, Plane, Point, Vector, shapes};
use tearmesh_cloth::{Cloth, Collider, Fabric, Pbd, Solver, Xpbd};

use crate::parts::cloths::cloth;
use crate::parts::gravity_along_y;

/// A sheet of n × n cells that hangs by its upper edge.
fn hanging(n: u32, stiffness: f64) -> (Mesh, Cloth) {
    let (mesh, positions) = shapes::grid(n, n);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(stiffness));
    let system = cloth.system_mut();
    system.set_loads(gravity_along_y(1.0)).expect("loads");
    let row = n as usize + 1;
    (row * (row - 1)..row * row).for_each(|top| system.hold(top));
    (mesh, cloth)
}

fn run(cloth: &mut Cloth, mut solver: impl Solver, steps: usize) -> f64 {
    for _ in 0..steps {
        cloth.step(&mut solver, 1.0 / 60.0).expect("a step");
    }
    let system = cloth.system();
    let ratios = system.stretches().iter().map(|id| system.stretch_ratio(id));
    let squares = ratios.map(|ratio| (ratio - 1.0).powi(2)).sum::<f64>();
    (squares / system.stretches().len() as f64).sqrt()
}

/// Macklin et al. 2019: the same projections, and far less strain.
#[test]
fn ten_substeps_of_one_sweep_strain_less_than_one_step_of_ten_sweeps() {
    let strain = |solver: &mut dyn Solver| {
        let (_, mut cloth) = hanging(64, 1e5);
        let strain = run(&mut cloth, solver, 90);
        (strain, cloth.system().counters().visits.project)
    };
    let (small, of_small) = strain(&mut Xpbd::new(10, 1));
    let (large, of_large) = strain(&mut Xpbd::new(1, 10));
    let (pbd, of_pbd) = strain(&mut Pbd::new(10));
    assert_eq!([of_small, of_small], [of_large, of_pbd]);
    assert!(large > 5.0 * small && pbd > 5.0 * small);
    assert!(small < 0.2, "{small}");
}

/// Without colliders, the end of a substep and the begin of the next are one pass.
#[test]
fn a_collider_that_nothing_meets_changes_no_bit_of_a_step() {
    let (_, mut free) = hanging(12, 1e4);
    let mut loads = free.system().loads().clone();
    let floor = Plane::new(Point::new(0.0, -1e3, 0.0), Vector::y()).expect("a plane");
    loads.colliders.push(Collider::Plane(floor));
    let mut above = free.clone();
    above.system_mut().set_loads(loads).expect("loads");
    for _ in 0..20 {
        for cloth in [&mut free, &mut above] {
            cloth
                .step(&mut Xpbd::new(5, 2), 1.0 / 60.0)
                .expect("a step");
        }
        assert_eq!(free.positions(), above.positions());
        assert_eq!(free.system().velocities(), above.system().velocities());
    }
    assert_eq!(above.system().counters().collider_passes, 20 * 5);
}
