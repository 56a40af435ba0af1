//! What a user is told: indefinite matrices (F12), numerical damping (F10), failures that
//! leave the state as it was, and work.

use super::{Scene, damping, spring, step};
use tearmesh_cloth::implicit::{Method, Settings, Stats, StepError};
use tearmesh_cloth::{BlowUpSite, Implicit, System};

/// F12: one free particle between two compressed springs, k = 1e3, m = .01, L₀ = .1, l = .095.
fn squeezed() -> Scene {
    let points = [[-0.095, 0.0, 0.0], [0.0; 3], [0.095, 0.0, 0.0]];
    let mut scene = Scene::particles(points, 0.01);
    scene.held[0] = true;
    scene.held[2] = true;
    scene.springs = vec![spring(0, 1, 0.1, 1e3), spring(1, 2, 0.1, 1e3)];
    scene
}

type Outcome = Result<Stats, StepError>;

/// One step from the start, and the system after it.
fn one(scene: &Scene, time_step: f64, settings: &Settings) -> (Outcome, System) {
    let mut system = scene.system();
    let mut solver = Implicit::new(*settings);
    (step(&mut system, &mut solver, time_step), system)
}

#[test]
fn f12_the_threshold_of_indefiniteness_is_the_closed_form() {
    for drag in [0.0, 3.0] {
        let scene = Scene { drag, ..squeezed() };
        let (mut low, mut high) = (1e-3, 1e-1);
        for _ in 0..70 {
            let middle = 0.5 * (low + high);
            let report = one(&scene, middle, &Settings::default()).0.expect("a step");
            // What is dropped are the two springs' negative parts.
            assert_eq!(report.clamped, 2 * report.indefinite);
            match report.indefinite {
                0 => low = middle,
                _ => high = middle,
            }
        }
        // With drag c: m (1 + c Δt) = Δt² q, q = 2k (L₀/l − 1).
        let (m, q) = (0.01, 2e3 * (0.1 / 0.095 - 1.0));
        let closed = (drag * m + (drag * m * drag * m + 4.0 * m * q).sqrt()) / (2.0 * q);
        println!("F12: indefinite from {high:.17e} s, closed form {closed:.17e}");
        assert!((high / closed - 1.0).abs() < 1e-13, "{high} {closed}");
        if drag == 0.0 {
            assert!(
                (high / 9.746_794_344_808_97e-3 - 1.0).abs() < 1e-13,
                "{high}"
            );
        }
    }
}

#[test]
fn steps_that_fail_leave_everything_as_it_was() {
    let scene = super::matrix::crumpled(3, 5);
    let mut twin = (scene.system(), Implicit::default());
    let mut system = scene.system();
    let bdf2 = Settings {
        method: Method::Bdf2,
        ..Settings::default()
    };
    let mut solver = Implicit::new(bdf2);
    step(&mut system, &mut solver, 0.01).expect("a step");
    twin.1.settings = bdf2;
    step(&mut twin.0, &mut twin.1, 0.01).expect("a step");
    let good = |system: &System| (system.positions().to_vec(), system.velocities().to_vec());
    let before = good(&system);
    solver.settings = Settings {
        solver_iterations_max: 1,
        ..bdf2
    };
    let refused = step(&mut system, &mut solver, 0.01);
    assert!(
        matches!(refused, Err(StepError::NotConverged { .. })),
        "{refused:?}"
    );
    assert_eq!(good(&system), before);
    solver.settings = bdf2;
    let broken = |system: &mut System, solver: &mut Implicit| match system.step(solver, 0.01) {
        Err(tearmesh_cloth::StepError::BlowUp { at, .. }) => at,
        other => panic!("{other:?}"),
    };
    system.state_mut().0[3].y = f64::NAN;
    assert_eq!(broken(&mut system, &mut solver), BlowUpSite::Particle(3));
    system.state_mut().0[3].y = before.0[3].y;
    system.state_mut().1[4].z = f64::INFINITY;
    assert_eq!(broken(&mut system, &mut solver), BlowUpSite::Particle(4));
    system.state_mut().1[4].z = before.1[4].z;
    assert_eq!(good(&system), before);
    // History too: the next step is what it would have been.
    step(&mut system, &mut solver, 0.01).expect("a step");
    step(&mut twin.0, &mut twin.1, 0.01).expect("a step");
    assert_eq!(good(&system), good(&twin.0));
    // A particle that would leave the world.
    let mut far = Scene::particles([[0.0; 3], [1e75, 0.0, 0.0]], 1.0);
    far.v[1].x = 1e75;
    let (refused, system) = one(&far, 10.0, &Settings::default());
    assert_eq!(refused.err(), Some(StepError::NotFinite { particle: 1 }));
    assert_eq!(good(&system), (far.x, far.v));
}

#[test]
fn f10_five_hertz_lose_all_in_a_second_of_backward_euler() {
    let z = 2.0 * std::f64::consts::PI * 5.0 / 60.0;
    let left = damping(Method::BackwardEuler, z).powi(60);
    println!("F10: {left:.2e} of the amplitude is left");
    assert!(left < 1e-3, "{left}");
    // BDF2 is far better, and of order four in z: 1 − ¼ z⁴ + ….
    let bdf2 = damping(Method::Bdf2, z).powi(60);
    assert!(bdf2 > 0.4, "{bdf2}");
    for z in [0.01, 0.02, 0.04] {
        let loss = 1.0 - damping(Method::Bdf2, z);
        assert!(
            (loss / (0.25 * z * z * z * z) - 1.0).abs() < 0.02,
            "{z}: {loss}"
        );
    }
}
