//! Forces in constraints and at hands, against weights and accelerations.

use tearmesh::{Mesh, Positions, Vector, shapes};
use tearmesh_cloth::{Cloth, Fabric, System, Threshold, Xpbd, force};

use crate::parts::cloths::{bent, cloth, loaded, split_off};
use crate::parts::nets::{chain, link};
use crate::parts::woven::weave;
use crate::parts::{G, METHODS, blown, gravity, method, near, run_with, shake, v};
use crate::random::Random;

#[test]
fn a_hand_feels_the_weight_of_a_chain_with_every_method() {
    // The top link would strain by 19.6 %: the limiter carries what is above 10.
    for name in METHODS {
        let dt = match name {
            "PBD" | "XPBD" => 0.02,
            "Euler" | "BDF2" => 0.1,
            _ => 0.008,
        };
        let mut chain = chain(4.0);
        let mut solver = method(name, 400);
        run_with(&mut chain, &mut *solver, dt, (20.0 / dt) as usize);
        let hand = force::reaction_n(&chain, 0);
        // Ten masses hang, and the hand holds an eleventh.
        near(hand.z, 11.0 * 0.01 * G, 1e-6);
        near(hand.x.abs() + hand.y.abs(), 0.0, 1e-15);
        for i in 0..10 {
            let link = link(&chain, i, i + 1).expect("a link");
            let weight = (10 - i) as f64 * 0.01 * G;
            near(force::force_n(&chain, link), weight, 1e-6);
            near(force::reaction_n(&chain, i + 1).norm(), 0.0, 1e-6);
        }
    }
}

#[test]
fn a_free_particle_lacks_what_accelerates_it() {
    let springs = bent(Fabric::new(30.0), 2.0);
    let mut random = Random(7);
    for fabric in [springs, Fabric::orthotropic(weave())] {
        let loads = blown(Vector::new(1.0, 2.0, 5.0), 0.4, gravity(0.0));
        let (_, mut cloth) = loaded(4, fabric, loads);
        let system = cloth.system_mut();
        shake(system, 0.1, 1.0, &mut random);
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
        let threshold = Threshold::Force(2.0);
        let felt = |mesh: &Mesh, cloth: &Cloth| -> Vec<(f64, Option<f64>)> {
            let force = |h| force::force_n(cloth.system(), cloth.stretch(h));
            let load = |h| threshold.edge_load(mesh, cloth, h);
            mesh.half_edges().map(|h| (force(h), load(h))).collect()
        };
        let before = felt(&mesh, &cloth);
        assert!(before.iter().any(|(force, _)| force.abs() > 1e-4));
        split_off(&mut mesh, &mut cloth, v(4), 3);
        let now = felt(&mesh, &cloth);
        for (h, ((force, load), before)) in mesh.half_edges().zip(now.into_iter().zip(before)) {
            let share = [1.0, 0.5][usize::from(mesh.ghost_pair(h).is_some())];
            assert_eq!(force, share * before.0, "{h}");
            // So each copy is as near to tearing as the link was.
            assert_eq!(load, before.1, "{h}");
        }
    }
}
