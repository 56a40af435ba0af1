//! Forces in constraints and at hands, against weights and accelerations.

use tearmesh::{Masses, Point, Positions, Vector, shapes};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{
    Bending, Cloth, Fabric, Loads, Path, Pbd, Provot, Solver, System, Threshold, Verlet, Weave,
    Wind, Xpbd, force,
};

use crate::parts::nets::{chain, row};
use crate::parts::{G, gravity, implicit, near, run};
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
    let woven = Fabric::woven(Weave {
        warp_n_per_m: 40.0,
        weft_n_per_m: 30.0,
        shear_n_per_m: 10.0,
        warp: Vector::x(),
    });
    let mut random = Random(7);
    for fabric in [springs, woven] {
        let masses = Masses::area(&mesh, &positions, 0.3).expect("masses");
        let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
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
fn a_leading_hand_pulls_against_drag() {
    // A pair at its rest length, led at one metre a second through a thick medium.
    let mut pair = row(1, 0.5, 100.0, 1.0, Vector::new(1.0, 0.0, 0.0));
    pair.set_loads(Loads {
        drag_per_s: Some(3.0),
        ..Loads::default()
    })
    .expect("loads");
    let away = [
        (0.0, Point::origin()),
        (100.0, Point::new(-100.0, 0.0, 0.0)),
    ];
    pair.grab(0, Path::new(away).expect("a path"));
    run(&mut pair, Verlet::new(), 0.01, 3000);
    near(force::reaction_n(&pair, 0).x, -2.0 * 0.5 * 3.0, 1e-9);
}

#[test]
fn copies_of_a_torn_link_share_its_multiplier() {
    let (mut mesh, _) = shapes::grid(2, 2);
    let points = (0..9).map(|i| [f64::from(i % 3), 1.5 * f64::from(i / 3), 0.0]);
    let positions = Positions::new(points).expect("positions");
    let masses = Masses::area(&mesh, &positions, 1.0).expect("masses");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(80.0)).expect("a cloth");
    let system: &mut System = cloth.system_mut();
    system.set_loads(gravity(0.0)).expect("loads");
    (0..3).chain(6..9).for_each(|v| system.hold(v));
    cloth.step(&mut Xpbd::new(4, 4), 0.05).expect("a step");
    let centre = tearmesh::VertexId::new(4).expect("a vertex");
    let faces: Vec<_> = mesh.faces_of(centre).take(3).collect();
    let forces: Vec<f64> = mesh
        .half_edges()
        .map(|h| force::force_n(cloth.system(), cloth.stretch(h)))
        .collect();
    assert!(forces.iter().any(|f| f.abs() > 1e-4));
    // So each copy is as near to tearing as the link was.
    let threshold = Threshold::Force(2.0);
    let loads: Vec<Option<f64>> = mesh
        .half_edges()
        .map(|h| threshold.edge_load(&mesh, &cloth, h))
        .collect();
    let mut edits = tearmesh::Edits::new();
    tearmesh::split::vertex(&mut mesh, centre, &faces, &mut edits).expect("a split");
    edits.replay(&mut cloth);
    for h in mesh.half_edges() {
        let share = if mesh.ghost_pair(h).is_some() {
            0.5
        } else {
            1.0
        };
        let force = force::force_n(cloth.system(), cloth.stretch(h));
        assert_eq!(force, share * forces[h.index()], "{h}");
        let load = threshold.edge_load(&mesh, &cloth, h);
        assert_eq!(load, loads[h.index()], "{h}");
    }
}
