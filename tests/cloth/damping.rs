//! Material damping, against answers on paper.

use tearmesh::{Point, Vector};
use tearmesh_cloth::scene::{Warning, Wording};
use tearmesh_cloth::{
    Balance, Fabric, Solver, System, Unstable, Verlet, force, recommended_step_s,
};

use crate::parts::cloths::{cloth, sheet};
use crate::parts::scenes::played;
use crate::parts::{
    METHODS, mechanical_j, method, near, on_a_line, shake, take, take_observed, woven,
};
use crate::random::Random;

/// A kilogram on a spring of 100 N/m that is held at its other end, 5 cm from rest.
fn oscillator(damping_s: f64) -> System {
    let mut system = on_a_line([0.0, 1.05], 1.0);
    system.stretch([0, 1], 1.0, 100.0).expect("a spring");
    system.hold(0);
    system.set_damping(damping_s).expect("a time");
    system
}

/// A kilogram at a corner of a triangle that is held at the others, moved by this vector from rest: as stiff
/// along x and along y, by its weft and in shear.
fn corner(damping_s: f64, moved: Vector) -> System {
    let points = [[0.0, 0.0], [0.0, 0.25], [1.0, 0.25]].map(|[x, y]| Point::new(x, y, 0.0));
    let mut system = System::new(points, vec![1.0; 3]).expect("particles");
    let material = [[0.0, 0.0], [0.25, 0.0], [0.25, 1.0]];
    let triangle = system.triangle([0, 1, 2], material, [400.0, 800.0, 800.0]);
    triangle.expect("an area");
    (0..2).for_each(|v| system.hold(v));
    system.state_mut().0[2] += moved;
    system.set_damping(damping_s).expect("a time");
    system
}

/// Where the last particle is after two seconds, in steps of this length, and the balance.
fn swung(mut system: System, dt_s: f64) -> (Point, Balance, System) {
    let mut kept = Balance::new(&system);
    let (observed, steps) = ((&mut system, &mut kept), (2.0 / dt_s).round() as usize);
    take_observed(observed, &mut Verlet, dt_s, steps);
    (*system.positions().last().expect("particles"), kept, system)
}

/// x = x₀ exp(−ζωt) (cos ω′t + ζω/ω′ sin ω′t), with ω′ = ω √(1 − ζ²).
#[test]
fn a_damped_oscillator_swings_by_the_closed_answer() {
    let (omega, t) = (10.0, 2.0);
    let [x, y] = [Vector::new(0.05, 0.0, 0.0), Vector::new(0.0, 1e-5, 0.0)];
    // τ k = c = 2 ζ √(k m); a ratio above a tenth is a tenth.
    for (damping_s, ratio) in [(0.01, 0.05), (0.019, 0.095), (7.0, 0.1)] {
        let slower = omega * f64::sqrt(1.0 - ratio * ratio);
        let shape = (slower * t).cos() + ratio * omega / slower * (slower * t).sin();
        let answer = (-ratio * omega * t).exp() * shape;
        let triangles = [x, y].map(|moved| (corner(damping_s, moved), moved));
        for (system, moved) in [(oscillator(damping_s), x)].into_iter().chain(triangles) {
            let rest = system.positions().last().expect("particles") - moved;
            let error = |dt_s| {
                let (at, ..) = swung(system.clone(), dt_s);
                (at - rest).dot(&moved) / moved.norm_squared() - answer
            };
            let [whole, half] = [0.0025, 0.00125].map(error);
            // By velocities of half a step before, so of first order.
            near(whole / half, 2.0, 0.1);
            near(2.0 * half - whole, 0.0, 2e-4);

            let (_, kept, swung) = swung(system, 0.00125);
            let balance = kept.now(&swung);
            let lost_j = balance.began_j - mechanical_j(&swung);
            near(-balance.damping_j / lost_j, 1.0, 5e-3);
        }
    }
}

/// What a spring of 2 c/(Δt (1 + 2θ)) would take of the step that suits.
#[test]
fn damping_shortens_the_step_as_a_spring_would() {
    for (damping_s, ratio) in [(0.01, 0.05), (7.0, 0.1)] {
        let (mut system, c) = (oscillator(damping_s), 2.0 * ratio * 10.0);
        let suits_s = recommended_step_s(&mut system);
        let taken = 100.0 * suits_s * suits_s + 2.0 * c / 1.5 * suits_s;
        near(taken, 1.3, 1e-12);
    }
    let refused = oscillator(0.0).set_damping(-1.0).expect_err("no time");
    assert_eq!((refused.setting, refused.given), ("damping_s", -1.0));
}

#[test]
fn a_hand_feels_damping_and_a_threshold_does_not() {
    let mut system = oscillator(0.01);
    system.state_mut().1[1] = Vector::new(3.0, 1.0, 0.0);
    let spring = system.stretches().iter().next().expect("a spring");
    system.step(&mut Verlet, 1e-3).expect("a step");
    let d = system.positions()[1] - system.positions()[0];
    let pull = 100.0 * (d.norm() - 1.0);
    near(force::force_n(&system, spring), pull, 1e-12);
    let rate = d.dot(&system.velocities()[1]) / d.norm();
    let hand = -d / d.norm() * (pull + 1.0 * rate);
    near((force::reaction_n(&system, 0) - hand).norm(), 0.0, 1e-12);

    let mut system = corner(0.01, Vector::new(0.05, 0.0, 0.0));
    system.state_mut().1[2] = Vector::new(3.0, 0.0, 0.0);
    system.step(&mut Verlet, 1e-3).expect("a step");
    let pull = 100.0 * (system.positions()[2].x - 1.0) + system.velocities()[2].x;
    let hands = force::reaction_n(&system, 0) + force::reaction_n(&system, 1);
    near(hands.x, -pull, 1e-12);
}

#[test]
fn other_methods_leave_damping_out() {
    let swing = |damping_s, solver: &mut dyn Solver| {
        let mut system = oscillator(damping_s);
        assert!(!solver.abilities().damps);
        take(&mut system, solver, 5e-3, 50);
        (system.positions()[1], force::reaction_n(&system, 0))
    };
    for name in METHODS.into_iter().filter(|name| *name != "guarded") {
        let [damped, free] = [0.01, 0.0].map(|damping_s| swing(damping_s, &mut *method(name, 10)));
        assert_eq!(damped, free, "{name}");
    }
}

/// Uneven sheets that are crushed and shaken, at the longest steps that are taken whole, damped far beyond
/// what a scene needs: the guard against crushed springs acts as well.
#[test]
fn damped_cloth_gains_no_energy_at_the_longest_step() {
    for seed in 0..12 {
        let (mesh, positions) = sheet(9, 9, seed);
        let fabric = match seed % 2 {
            0 => Fabric::new(500.0),
            _ => Fabric::orthotropic(woven::weave()),
        };
        let fabric = Fabric {
            damping_s: [1e-3, 1e-2, 1.0][seed as usize % 3],
            ..fabric
        };
        let mut cloth = cloth(&mesh, &positions, fabric);
        let system = cloth.system_mut();
        system.when_unstable(Unstable::Substep);
        system.state_mut().0.iter_mut().for_each(|p| *p *= 0.6);
        shake(system, 0.02, 1.0, &mut Random(seed));
        let dt_s = 1.999 * recommended_step_s(system);
        let before = mechanical_j(system);
        let mut most = 0.0_f64;
        for _ in 0..2000 {
            let substeps = system.step(&mut Verlet, dt_s).expect("a step");
            assert_eq!(substeps, 1, "{seed}");
            most = most.max(mechanical_j(system));
        }
        let left = mechanical_j(system);
        assert!(most < 1.02 * before && left < 0.5 * before, "{seed}");
    }
}

/// At the defaults that a user gets, what a tear sets free goes into the cloth and the air; who loses it by
/// other ways says so.
#[test]
fn the_default_method_hardly_dissipates_others_say_so() {
    let is_dissipation = |warning: &Warning| warning.code() == "W-SIM-DAMPED";
    for scene in ["hang", "flag", "rip", "trouser"] {
        for method in ["verlet", "xpbd", "implicit"] {
            let run = &played(16, scene, method).run;
            let balance = run.energy_balance();
            let moving_j = balance.put_in_j() - balance.elastic_j;
            let part = -balance.made_j() / moving_j;
            let warns = Warning::after(run, &Wording::default())
                .iter()
                .any(is_dissipation);
            assert_eq!(warns, part > 0.1, "{scene}, {method}: {balance:?}");
            assert_eq!(warns, method != "verlet", "{scene}, {method}: {balance:?}");
            assert!(warns || part.abs() < 0.05, "{scene}: {part}");
            assert_eq!(balance.damping_j < 0.0, method == "verlet");
        }
    }
}
