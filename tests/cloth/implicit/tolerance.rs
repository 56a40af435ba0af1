//! How exactly a step has to be solved by default: never so loosely that what acts is not felt.

use super::dense::solve;
use super::matrix::crumpled;
use super::{G, Scene, forces, norm, step};
use crate::parts::nets::chain;
use crate::parts::{implicit_to, run};
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

/// Backward Euler's steps of the chain, which is linear as long as it hangs straight: the depths of
/// its ten free particles after each, by elimination.
fn euler(dt_s: f64, steps: u32) -> Vec<Vec<f64>> {
    let (mass, stiffness, drag) = (0.01, 50.0, 20.0);
    let mut depth: Vec<f64> = (1..=10).map(|i| 0.1 * f64::from(i)).collect();
    let mut speed = vec![0.0; 10];
    let mut passed = Vec::new();
    for _ in 0..steps {
        let pull = |i: usize| {
            let above = if i == 0 { 0.0 } else { depth[i - 1] };
            stiffness * (depth[i] - above - 0.1)
        };
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for i in 0..10 {
            let mut row = vec![0.0; 10];
            row[i] = mass * (1.0 + dt_s * drag) + dt_s * dt_s * stiffness;
            let mut force = mass * G - pull(i);
            if i > 0 {
                row[i - 1] = -dt_s * dt_s * stiffness;
            }
            if i < 9 {
                row[i] += dt_s * dt_s * stiffness;
                row[i + 1] = -dt_s * dt_s * stiffness;
                force += pull(i + 1);
            }
            rows.push(row);
            right.push(mass * speed[i] + dt_s * force);
        }
        speed = solve(&rows, right);
        depth
            .iter_mut()
            .zip(&speed)
            .for_each(|(x, v)| *x += dt_s * v);
        passed.push(depth.clone());
    }
    passed
}

#[test]
fn what_hangs_falls_as_backward_euler_says_at_every_step() {
    for tolerance in TOLERANCES {
        for (dt_s, _) in STEPS {
            let mut system = chain(20.0);
            let mut solver = implicit_to(Method::BackwardEuler, tolerance);
            let mut worst = 0.0_f64;
            for depth in euler(dt_s, 20) {
                step(&mut system, &mut solver, dt_s).expect("a step");
                let particles = system.positions()[1..].iter().zip(&depth).enumerate();
                let [mut apart, mut fallen] = [0.0; 2];
                for (i, (x, depth)) in particles {
                    apart += (x.z + depth) * (x.z + depth);
                    let way = depth - 0.1 * (i + 1) as f64;
                    fallen += way * way;
                }
                worst = worst.max((apart / fallen).sqrt());
            }
            assert!(worst < 0.1, "{tolerance:?} {dt_s}: {worst}");
        }
    }
}

#[test]
fn what_hangs_comes_to_rest_where_forces_balance_at_every_step() {
    for method in METHODS {
        for tolerance in TOLERANCES {
            for (dt_s, steps) in STEPS {
                let mut system = chain(20.0);
                run(&mut system, implicit_to(method, tolerance), dt_s, steps);
                let off = (-system.positions()[10].z - 1.107_91).abs();
                assert!(off < 1e-9, "{method:?} {tolerance:?} {dt_s}: off by {off}");
            }
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
fn a_step_may_err_by_its_order_or_by_a_tenth_of_what_acts_whichever_is_less() {
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
                    let expected = tenth.min(order);
                    assert!(
                        (limit / expected - 1.0).abs() < 1e-9,
                        "{method:?} {dt_s}: {limit} {expected}"
                    );
                }
            }
        }
    }
    assert!(decided.iter().all(|&times| times > 10), "{decided:?}");
}
