//! What a user is told: indefinite matrices (F12), and failures that leave the state as it was.

use std::error::Error as _;

use super::{Scene, step};
use crate::parts::{implicit_by_default, state};
use tearmesh_cloth::Implicit;
use tearmesh_cloth::implicit::{Method, StepError};

/// F12: one free particle between two compressed springs, k = 1e3, m = .01, L₀ = .1, l = .095. With drag c
/// the matrix is indefinite if m (1 + c Δt) < Δt² q, q = 2k (L₀/l − 1).
#[test]
fn f12_the_threshold_of_indefiniteness_is_the_closed_form() {
    let points = [[-0.095, 0.0, 0.0], [0.0; 3], [0.095, 0.0, 0.0]];
    let mut scene = Scene::particles(points, 0.01);
    (scene.held[0], scene.held[2]) = (true, true);
    scene.springs = vec![([0, 1], 0.1, 1e3), ([1, 2], 0.1, 1e3)];
    for drag in [0.0, 3.0] {
        scene.drag = drag;
        let (mut low, mut high) = (1e-3, 1e-1);
        for _ in 0..70 {
            let middle = 0.5 * (low + high);
            let taken = step(&mut scene.system(), &mut Implicit::default(), middle);
            let report = taken.expect("a step");
            // What is dropped are the two springs' negative parts.
            assert_eq!(report.clamped, 2 * report.indefinite);
            match report.indefinite {
                0 => low = middle,
                _ => high = middle,
            }
        }
        let (m, q) = (0.01, 2e3 * (0.1 / 0.095 - 1.0));
        let closed = (drag * m + (drag * m * drag * m + 4.0 * m * q).sqrt()) / (2.0 * q);
        assert!((high / closed - 1.0).abs() < 1e-13, "{high} {closed}");
        assert!(drag > 0.0 || (closed / 9.746_794_344_808_97e-3 - 1.0).abs() < 1e-13);
    }
}

/// A tolerance that is missed is told with the residual and is no blow-up, and what is nowhere is one. The
/// next step is what it would have been.
#[test]
fn steps_that_fail_leave_everything_as_it_was_history_too() {
    let mut system = super::matrix::crumpled(3, 5).system();
    let mut solver = implicit_by_default(Method::Bdf2);
    step(&mut system, &mut solver, 0.01).expect("a step");
    let (mut twin, mut twin_solver) = (system.clone(), solver.clone());
    let settings = solver.settings;
    solver.settings.solver_iterations_max = 1;
    let error = system.step(&mut solver, 0.01).expect_err("one iteration");
    let why = error.source().expect("the reason").to_string();
    assert!(error.to_string().contains(&why), "{error}");
    let named = match error {
        tearmesh_cloth::StepError::Implicit { elapsed_s, error } => (elapsed_s, error),
        error => panic!("{error}"),
    };
    assert!(matches!(
        named,
        (elapsed_s, StepError::NotConverged { residual, limit, solver_iterations: 1 })
            if elapsed_s == system.elapsed_s() && residual > limit
    ));
    assert_eq!(state(&system), state(&twin));
    solver.settings = settings;
    for (particle, x, v) in [(3, f64::NAN, 0.0), (4, 0.0, f64::INFINITY)] {
        system.state_mut().0[particle].y += x;
        system.state_mut().1[particle].z += v;
        let broken = system.step(&mut solver, 0.01).expect_err("no number");
        let text = format!("particle {particle} is not finite");
        assert!(broken.to_string().contains(&text), "{broken}");
        system.state_mut().0[particle] = twin.positions()[particle];
        system.state_mut().1[particle] = twin.velocities()[particle];
    }
    step(&mut system, &mut solver, 0.01).expect("a step");
    step(&mut twin, &mut twin_solver, 0.01).expect("a step");
    assert_eq!(state(&system), state(&twin));
    // A particle that would leave the world.
    let mut far = Scene::particles([[0.0; 3], [1e75, 0.0, 0.0]], 1.0);
    far.v[1].x = 1e75;
    let mut system = far.system();
    let refused = step(&mut system, &mut Implicit::default(), 10.0);
    assert_eq!(refused.err(), Some(StepError::NotFinite { particle: 1 }));
    assert_eq!(state(&system), (far.x, far.v));
}
