//! Steps and cuts that promise not to allocate.

use allocation_counter::measure;
use tearmesh::{Point, Scissor, Vector, shapes};
use tearmesh_cloth::{
    BendRemoval, Bending, Buckling, Fabric, HandId, Method, Simulation, SimulationDef, Tearing,
    Threshold, Unstable, Wounds,
};

use crate::parts::cloths::{bent, loaded};
use crate::parts::scenes::methods;
use crate::parts::woven::weave;
use crate::parts::{gravity, method, plane, v};

/// The number of allocations that something takes.
fn allocations(of: impl FnOnce()) -> u64 {
    measure(of).count_total
}

#[test]
fn steps_of_a_cloth_do_not_allocate() {
    let buckling = Some(Bending::Buckling {
        rigidity_n_m: 1e-3,
        law: Buckling::new(0.9).expect("a law"),
    });
    let springs = bent(Fabric::new(50.0), 1.0);
    let woven = Fabric {
        bend: buckling,
        ..Fabric::orthotropic(weave())
    };
    for (fabric, names) in [
        (springs, ["guarded", "limited", "PBD", "XPBD", "RK4"]),
        (woven, ["guarded", "Verlet", "Euler", "BDF2", "RK4"]),
    ] {
        for name in names {
            let ((_, mut cloth), mut solver) = (loaded(10, fabric, gravity(1.0)), method(name, 10));
            let system = cloth.system_mut();
            system.hold(0);
            system.state_mut().1[60] = Vector::new(0.1, 0.1, 0.3);
            system.when_unstable(Unstable::Substep);
            let mut take = || assert!(system.step(&mut *solver, 0.005).is_ok(), "{name}");
            // The first step makes room.
            take();
            assert_eq!(allocations(|| (0..5).for_each(|_| take())), 0, "{name}");
        }
    }
}

/// A sheet that hangs by its upper edge, with a hand at its middle.
fn in_hand(method: Method, fabric: Fabric, threshold: Threshold) -> (Simulation, HandId) {
    let (mesh, positions) = shapes::grid(12, 12);
    let def = SimulationDef {
        method,
        fabric,
        tearing: Some(Tearing::new(threshold)),
        ..SimulationDef::default()
    };
    let mut sim = Simulation::new(mesh, &positions, def).expect("a simulation");
    sim.hold((156..169).map(v)).expect("held");
    let hand = sim.grab(v(84), Simulation::GRIP_RADIUS_M).expect("a hand");
    sim.advance(0.02, 1000).expect("stable");
    (sim, hand)
}

/// Nor does looking for tears, by edges or by faces.
#[test]
fn steps_of_a_simulation_do_not_allocate() {
    let thresholds = [Threshold::Stretch, Threshold::PrincipalStretch].into_iter();
    for ((_, method), threshold) in methods().into_iter().zip(thresholds.cycle()) {
        let (mut sim, hand) = in_hand(method, Fabric::new(1000.0), threshold(1.5));
        sim.lead(hand, Point::new(0.5, 0.45, 0.02)).expect("led");
        let taken = allocations(|| {
            assert!(sim.advance(0.05, 1000).expect("stable").steps > 10);
        });
        assert_eq!((taken, sim.events().count()), (0, 0));

        // Nor while wounds are drawn together, until something is sewn.
        let level = plane([0.0, 0.7, 0.0], Vector::y());
        sim.cut(&Scissor::by_plane(level)).expect("cut");
        sim.lead(hand, Point::new(0.5, -0.5, 0.0)).expect("led");
        sim.advance(0.3, 10_000).expect("stable");
        assert!(sim.heal(Wounds::All).expect("wounds") > 10);
        let vertices = sim.mesh().vertex_count();
        sim.advance(0.01, 1000).expect("stable");
        let taken = allocations(|| assert!(sim.advance(0.02, 1000).is_ok()));
        assert_eq!((taken, sim.mesh().vertex_count()), (0, vertices));
    }
}

/// Nor does what tears, but for the matrix of the implicit method.
#[test]
fn tears_of_a_simulation_do_not_allocate() {
    let bending = Fabric {
        bend_removal: BendRemoval::Vertex,
        ..bent(Fabric::new(1000.0), 2.0)
    };
    let explicit = Method::NAMES.into_iter().filter(|name| *name != "implicit");
    for (name, fabric) in explicit.flat_map(|n| [(n, bending), (n, Fabric::new(1000.0))]) {
        let method = Method::named(name).expect("a method");
        let (mut sim, hand) = in_hand(method, fabric, Threshold::Stretch(1.5));
        let mut frames = 0;
        for frame in 0..240 {
            let s = f64::from(frame) / 60.0;
            let before = sim.mesh().vertex_count();
            let to = Point::new(0.5 - s, 0.5 - s, s);
            sim.lead(hand, to).expect("led");
            let taken = allocations(|| assert!(sim.advance(1.0 / 60.0, 1000).is_ok()));
            assert_eq!(taken, 0, "{name} {frame}");
            frames += u32::from(sim.mesh().vertex_count() > before);
        }
        assert!(frames >= 5);
    }
}
