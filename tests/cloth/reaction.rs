//! Forces in constraints and at hands, against weights and accelerations.

use tearmesh::{Edits, Positions, Vector, shapes, split};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{
    Bending, Fabric, Loads, Pbd, Provot, Solver, System, Threshold, Verlet, Wind, Xpbd, force,
};

use crate::parts::cloths::cloth;
use crate::parts::nets::chain;
use crate::parts::woven::weave;
use crate::parts::{G, gravity, implicit, near, run, v};
use crate::random::Random;
use crate::rk4::Rk4;

#[test]
fn a_hand_feels_the_weight_of_a_chain_with_every_method() {
    let methods: [(&str, &mut dyn Solver, f64); 7] = [
        ("Verlet", &mut Verlet::new(), 0.008),
        ("RK4", &mut Rk4::new(), 0.008),
        ("springs", &mut Provot::unlimited(), 0.008),
        // The top link would strain by 19.6 %: the limiter carries what is above 10.
        ("Provot", &mut Provot::default(), 0.008),
        ("PBD", &mut Pbd::new(400), 0.02),
        ("XPBD", &mut Xpbd::new(1, 400), 0.02),
        ("implicit", &mut implicit(Method::BackwardEuler), 0.1),
    ];
    for (_name, solver, dt) in methods {
        let mut chain = chain(4.0);
        run(&mut chain, solver, dt, (20.0 / dt) as usize);
        let hand = force::reaction_n(&chain, 0);
        // Ten masses hang, and the hand holds an eleventh.
        near(hand.z, 11.0 * 0.01 * G, 1e-6);
        near(hand.x.abs() + hand.y.abs(), 0.0, 1e-15);
        for i in 0..10 {
            let link = chain.stretches().between(i, i + 1).expect("a link");
            near(
                force::force_n(&chain, link),
                (10 - i) as f64 * 0.01 * G,
                1e-6,
            );
            near(force::reaction_n(&chain, i + 1).norm(), 0.0, 1e-6);
        }
    }
}

#[test]
fn a_free_particle_lacks_what_accelerates_it() {
    let (mesh, positions) = shapes::grid(4, 4);
    let springs = Fabric {
        bend: Some(Bending::Spring {
            stiffness_n_per_m: 2.0,
        }),
        ..Fabric::new(30.0)
    };
    let mut random = Random(7);
    for fabric in [springs, Fabric::woven(weave())] {
        let mut cloth = cloth(&mesh, &positions, fabric);
        let system = cloth.system_mut();
        let wind = Wind {
            velocity_m_per_s: Vector::new(1.0, 2.0, 5.0),
            coefficient: 0.4,
        };
        let loads = Loads {
            wind: Some(wind),
            ..gravity(0.0)
        };
        system.set_loads(loads).expect("loads");
        let (points, velocities) = system.state_mut();
        for (x, v) in points.iter_mut().zip(velocities) {
            let mut next = || random.next() - 0.5;
            *x += 0.1 * Vector::new(next(), next(), next());
            *v = Vector::new(next(), next(), next());
        }
        let mut accelerations = Vec::new();
        force::accelerations(system, &mut accelerations);
        for (i, a) in accelerations.iter().enumerate() {
            let miss = force::reaction_n(system, i) + a * system.masses()[i];
            near(miss.norm(), 0.0, 1e-13);
        }
    }
}

#[test]
fn copies_of_a_torn_link_share_its_multiplier() {
    // By faces, and by edges.
    for fabric in [Fabric::new(80.0), Fabric::of_edges(80.0)] {
        let (mut mesh, _) = shapes::grid(2, 2);
        let points = (0..9).map(|i| [f64::from(i % 3), 1.5 * f64::from(i / 3), 0.0]);
        let positions = Positions::new(points).expect("positions");
        let mut cloth = cloth(&mesh, &positions, fabric);
        let system: &mut System = cloth.system_mut();
        system.set_loads(gravity(0.0)).expect("loads");
        (0..3).chain(6..9).for_each(|v| system.hold(v));
        cloth.step(&mut Xpbd::new(4, 4), 0.05).expect("a step");
        let centre = v(4);
        let faces: Vec<_> = mesh.faces_of(centre).take(3).collect();
        let forces = mesh.half_edges();
        let forces = forces.map(|h| force::force_n(cloth.system(), cloth.stretch(h)));
        let forces: Vec<f64> = forces.collect();
        assert!(forces.iter().any(|f| f.abs() > 1e-4));
        // So each copy is as near to tearing as the link was.
        let threshold = Threshold::Force(2.0);
        let loads = mesh.half_edges();
        let loads = loads.map(|h| threshold.edge_load(&mesh, &cloth, h));
        let loads: Vec<Option<f64>> = loads.collect();
        let mut edits = Edits::new();
        split::vertex(&mut mesh, centre, &faces, &mut edits).expect("a split");
        edits.replay(&mut cloth);
        for h in mesh.half_edges() {
            let share = [1.0, 0.5][usize::from(mesh.ghost_pair(h).is_some())];
            let force = force::force_n(cloth.system(), cloth.stretch(h));
            assert_eq!(force, share * forces[h.index()], "{h}");
            let load = threshold.edge_load(&mesh, &cloth, h);
            assert_eq!(load, loads[h.index()], "{h}");
        }
    }
}
