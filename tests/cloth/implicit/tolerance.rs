//! How exactly a step has to be solved by default: never so loosely that what acts is not felt.

use super::matrix::crumpled;
use super::{G, Scene, forces, norm, step};
use crate::parts::nets::chain;
use crate::parts::{implicit_to, near, run};
use tearmesh::Vector;
use tearmesh_cloth::System;
use tearmesh_cloth::implicit::{Method, StepError};

const METHODS: [Method; 2] = [Method::BackwardEuler, Method::Bdf2];

/// The default settings, and those of the command.
const TOLERANCES: [f64; 2] = [1.0, 10.0];

/// Steps in seconds, and how many take what is dragged at 20 /s to rest.
const STEPS: [(f64, usize); 5] = [
    (1.0, 60),
    (0.1, 300),
    (0.01, 1000),
    (1e-3, 3000),
    (1e-4, 30_000),
];

#[test]
fn what_hangs_rests_where_forces_balance_at_every_step() {
    for (method, tolerance) in METHODS.into_iter().flat_map(|m| TOLERANCES.map(|t| (m, t))) {
        for (dt_s, steps) in STEPS {
            let mut system = chain(20.0);
            run(&mut system, implicit_to(method, tolerance), dt_s, steps);
            near(-system.positions()[10].z, 1.107_91, 1e-9);
        }
    }
}

/// The rms of the accelerations by all forces, weighed by masses; drag included.
fn acceleration_rms(scene: &Scene, system: &mut System) -> f64 {
    let forces = forces(system);
    let free = (0..forces.len()).filter(|&i| !scene.held[i]);
    let of = |i: usize| {
        (forces[i] - system.velocities()[i] * (scene.drag * scene.masses[i]))
            / scene.masses[i].sqrt()
    };
    let all: Vec<Vector> = free.map(of).collect();
    norm(&all) / scene.masses.iter().sum::<f64>().sqrt()
}

/// The least of T Δt^(p+1) and a tenth of what the forces at the beginning of a step would make of
/// the velocities, with drag.
#[test]
fn a_step_errs_at_most_by_its_order_or_a_tenth_of_forces() {
    let mut decided = [0; 2];
    for seed in 0..6 {
        let mut scene = crumpled(3, seed);
        scene.held[0] = true;
        scene.gravity = Vector::new(0.3, 0.0, -G);
        scene.drag = f64::from(seed as u32);
        for (method, p) in [(Method::BackwardEuler, 1), (Method::Bdf2, 2)] {
            for dt_s in [1e-3, 0.01, 0.1, 1.0] {
                let mut system = scene.system();
                let mut solver = implicit_to(method, 100.0);
                for turn in 0..3 {
                    let is_bdf2 = p == 2 && turn > 0;
                    let h = dt_s * if is_bdf2 { 2.0 / 3.0 } else { 1.0 };
                    let tenth = acceleration_rms(&scene, &mut system) / 10.0;
                    let tenth = tenth * h / (1.0 + h * scene.drag);
                    let order = 100.0 * dt_s.powi(p + 1);
                    // One that is not solved says what it might have left.
                    let mut unsolved = solver.clone();
                    unsolved.settings.solver_iterations_max = 0;
                    let refused = step(&mut system.clone(), &mut unsolved, dt_s);
                    let report = step(&mut system, &mut solver, dt_s).expect("a step");
                    if report.parts > 1 {
                        break;
                    }
                    let Err(StepError::NotConverged { limit, .. }) = refused else {
                        continue;
                    };
                    decided[usize::from(tenth < order)] += 1;
                    near(limit / tenth.min(order), 1.0, 1e-9);
                }
            }
        }
    }
    assert!(decided.iter().all(|&times| times > 10), "{decided:?}");
}
