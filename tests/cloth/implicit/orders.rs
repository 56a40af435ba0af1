//! Orders of convergence against a fine solution by Runge and Kutta's method: with a tolerance that
//! falls with Δt no error of the solver shows (F13).

use super::{Scene, forces, order, spring, step};
use crate::parts::{G, implicit_by_default};
use tearmesh::{Point, Vector};
use tearmesh_cloth::Implicit;
use tearmesh_cloth::implicit::{Method, Settings};

/// A frame with 2 % pretension and drag, pushed in the middle: smooth and well conditioned.
fn frame() -> Scene {
    let mut scene = Scene::sheet(4, 0.05, [20.0, 16.0, 4.0]);
    for (i, x) in scene.x.iter_mut().enumerate() {
        let bump = (x.x * (1.0 - x.x)) * (x.y * (1.0 - x.y));
        scene.v[i] = Vector::new(0.3 * bump, -0.2 * bump, 8.0 * bump);
        *x = Point::new(1.02 * x.x, 1.02 * x.y, 0.0);
    }
    for i in Scene::rim(4) {
        scene.held[i] = true;
    }
    scene.springs.push(spring(6, 12, 0.3, 5.0));
    scene.gravity = Vector::new(0.0, 0.0, -G);
    scene.drag = 1.0;
    scene
}

/// Runge and Kutta's method of order four.
fn reference(scene: &Scene, end: f64, steps: u32) -> Vec<Point> {
    let h = end / f64::from(steps);
    let mut system = scene.system();
    let mut rate = |x: &[Point], v: &[Vector]| -> Vec<Vector> {
        system.state_mut().0.copy_from_slice(x);
        let forces = forces(&mut system);
        let free = |i: usize| !scene.held[i];
        let one = |i: usize| forces[i] / scene.masses[i] - v[i] * scene.drag;
        (0..x.len())
            .map(|i| if free(i) { one(i) } else { Vector::zeros() })
            .collect()
    };
    let along = |x: &[Point], d: &[Vector], h: f64| -> Vec<Point> {
        x.iter().zip(d).map(|(x, d)| x + d * h).collect()
    };
    let also = |x: &[Vector], d: &[Vector], h: f64| -> Vec<Vector> {
        x.iter().zip(d).map(|(x, d)| x + d * h).collect()
    };
    let (mut x, mut v) = (scene.x.clone(), scene.v.clone());
    for _ in 0..steps {
        let a1 = rate(&x, &v);
        let v2 = also(&v, &a1, h / 2.0);
        let a2 = rate(&along(&x, &v, h / 2.0), &v2);
        let v3 = also(&v, &a2, h / 2.0);
        let a3 = rate(&along(&x, &v2, h / 2.0), &v3);
        let v4 = also(&v, &a3, h);
        let a4 = rate(&along(&x, &v3, h), &v4);
        for i in 0..x.len() {
            x[i] += (v[i] + v2[i] * 2.0 + v3[i] * 2.0 + v4[i]) * (h / 6.0);
            v[i] += (a1[i] + a2[i] * 2.0 + a3[i] * 2.0 + a4[i]) * (h / 6.0);
        }
    }
    x
}

/// The error of displacements at the end, relative.
fn error(scene: &Scene, truth: &[Point], end: f64, steps: u32, settings: &Settings) -> f64 {
    let (mut system, mut solver) = (scene.system(), Implicit::new(*settings));
    for _ in 0..steps {
        let time_step = end / f64::from(steps);
        step(&mut system, &mut solver, time_step).expect("a step");
    }
    let apart: Vec<Vector> = system
        .positions()
        .iter()
        .zip(truth)
        .map(|(x, t)| x - t)
        .collect();
    let way: Vec<Vector> = scene.x.iter().zip(truth).map(|(x, t)| x - t).collect();
    super::norm(&apart) / super::norm(&way)
}

#[test]
fn backward_euler_is_of_order_one_and_bdf2_of_order_two() {
    let (scene, end) = (frame(), 0.2);
    let truth = reference(&scene, end, 2000);
    let check = reference(&scene, end, 1000);
    let apart: Vec<Vector> = check.iter().zip(&truth).map(|(x, t)| x - t).collect();
    assert!(
        super::norm(&apart) < 1e-9,
        "the reference has an error of its own"
    );
    for (method, p) in [(Method::BackwardEuler, 1.0), (Method::Bdf2, 2.0)] {
        let settings = Settings {
            method,
            ..Settings::default()
        };
        let steps = [40, 80, 160, 320];
        let errors = steps.map(|n| error(&scene, &truth, end, n, &settings));
        let orders: Vec<f64> = errors.windows(2).map(|e| order(e[0], e[1])).collect();
        println!("{method:?}: errors {errors:?} orders {orders:.3?}");
        for order in &orders[1..] {
            assert!((order - p).abs() < 0.2, "{method:?}: order {order}");
        }
    }
}

#[test]
fn bdf2_keeps_its_order_when_the_step_changes() {
    let scene = frame();
    let truth = reference(&scene, 0.2, 2000);
    let run = |steps: u32| {
        let mut system = scene.system();
        let mut solver = implicit_by_default(Method::Bdf2);
        // Two lengths of step by turns, 1.4 and 0.6.
        let length = |step: u32| 0.2 / f64::from(steps) * [1.4, 0.6][step as usize % 2];
        for turn in 0..steps {
            let report = step(&mut system, &mut solver, length(turn)).expect("a step");
            let euler = turn == 0;
            assert_eq!(report.first_order_parts > 0, euler, "step {turn}");
        }
        let x = system.positions();
        let apart: Vec<Vector> = x.iter().zip(&truth).map(|(x, t)| x - t).collect();
        super::norm(&apart)
    };
    let errors = [80, 160, 320].map(run);
    let orders = [order(errors[0], errors[1]), order(errors[1], errors[2])];
    println!("uneven steps: {errors:?} orders {orders:.3?}");
    assert!((orders[1] - 2.0).abs() < 0.2);
}
