//! The accuracy to which a step is solved by default: never so loose that what acts is not felt.

use super::dense::jacobian;
use super::matrix::{crumpled, dense_step};
use super::{G, Scene, step};
use crate::parts::cloths::loaded;
use crate::parts::nets::chain;
use crate::parts::{gravity_along_y, implicit_to, near, run, take};
use tearmesh::Vector;
use tearmesh_cloth::Fabric;
use tearmesh_cloth::implicit::Method;

const METHODS: [Method; 2] = [Method::BackwardEuler, Method::Bdf2];

/// The default settings, and those of the command.
const TOLERANCES: [f64; 2] = [1.0, 1000.0];

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

/// All of it falls alike, and nothing is left to solve.
#[test]
fn what_falls_freely_is_not_strained_at_any_tolerance() {
    for (method, tolerance) in METHODS.into_iter().flat_map(|m| TOLERANCES.map(|t| (m, t))) {
        for (dt_s, _) in STEPS {
            let (_, mut cloth) = loaded(4, Fabric::new(300.0), gravity_along_y(0.0));
            let system = cloth.system_mut();
            take(system, &mut implicit_to(method, tolerance), dt_s, 10);
            let strains = system
                .stretches()
                .iter()
                .map(|id| system.stretch_ratio(id) - 1.0);
            let most = strains.fold(0.0, |most: f64, strain| most.max(strain.abs()));
            assert!(most < 1e-12, "{method:?} {tolerance} {dt_s}: {most}");
        }
    }
}

/// The square of a change of velocities in the energy norm of a step of h.
fn energy(scene: &Scene, hessian: &[Vec<f64>], h: f64, change: &[Vector]) -> f64 {
    let all: Vec<f64> = change.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    let row = |r: usize| -> f64 {
        let stiff = hessian[r].iter().zip(&all).map(|(k, v)| k * v);
        scene.masses[r / 3] * (1.0 + h * scene.drag) * all[r] + h * h * stiff.sum::<f64>()
    };
    (0..all.len()).map(|r| all[r] * row(r)).sum()
}

/// The velocities of a step against the dense solution: off by no more than T Δt² (rms), and by a tenth of the
/// change, by energy.
#[test]
fn a_step_errs_at_most_by_its_order_and_a_tenth_of_its_change() {
    let mut decided = [0; 2];
    for seed in 0..12 {
        let mut scene = crumpled(4, seed);
        scene.held[0] = true;
        scene.gravity = Vector::new(0.3, 0.0, -G);
        scene.drag = f64::from(seed as u32);
        let hessian = jacobian(&scene.system());
        for (tolerance, h) in [1.0, 10.0, 1000.0]
            .into_iter()
            .flat_map(|t| [(t, 0.003), (t, 0.02)])
        {
            let mut system = scene.system();
            let mut solver = implicit_to(Method::BackwardEuler, tolerance);
            let report = step(&mut system, &mut solver, h).expect("a step");
            if report.parts > 1 || report.indefinite > 0 {
                continue;
            }
            let right = dense_step(&scene, &hessian, h);
            let ends = system.velocities().iter().zip(&scene.v).zip(&right);
            let off: Vec<Vector> = ends.map(|((end, v), right)| end - v - right).collect();
            let squares = off
                .iter()
                .zip(&scene.masses)
                .map(|(e, m)| m * e.norm_squared());
            let rms = (squares.sum::<f64>() / scene.masses.iter().sum::<f64>()).sqrt();
            let of = |change: &[Vector]| energy(&scene, &hessian, h, change).sqrt();
            let (part, order) = (of(&off) / of(&right), rms / (tolerance * h * h));
            assert!(
                order < 1.0 && part < 0.1,
                "{tolerance}, {h} s: {order}, {part}"
            );
            decided[usize::from(part < 0.03)] += 1;
        }
    }
    assert!(decided.iter().all(|&times| times > 10), "{decided:?}");
}
