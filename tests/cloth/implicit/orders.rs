//! Orders of convergence against a fine solution by Runge and Kutta's method: with a tolerance that
//! falls with Δt no error of the solver shows (F13).

use super::{Scene, norm, step};
use crate::parts::{G, implicit_by_default, run};
use crate::rk4::Rk4;
use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method;

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
        scene.v[i] = Vector::zeros();
    }
    scene.springs.push(([6, 12], 0.3, 5.0));
    scene.gravity = Vector::new(0.0, 0.0, -G);
    scene.drag = 1.0;
    scene
}

/// Steps of one length, and of two lengths by turns.
#[test]
fn backward_euler_is_of_order_one_and_bdf2_of_order_two_also_in_uneven_steps() {
    let scene = frame();
    let [truth, check] = [2000, 1000].map(|steps| {
        let mut system = scene.system();
        run(&mut system, Rk4::new(), 0.2 / steps as f64, steps);
        system.positions().to_vec()
    });
    let apart = |x: &[Point]| -> f64 {
        let pairs = x.iter().zip(&truth);
        norm(&pairs.map(|(x, t)| x - t).collect::<Vec<_>>())
    };
    assert!(
        apart(&check) < 1e-9,
        "the reference has an error of its own"
    );
    for (method, lengths, expected) in [
        (Method::BackwardEuler, [1.0, 1.0], 1.0),
        (Method::Bdf2, [1.0, 1.0], 2.0),
        (Method::Bdf2, [1.4, 0.6], 2.0),
    ] {
        let errors = [80, 160, 320].map(|steps| {
            let (mut system, mut solver) = (scene.system(), implicit_by_default(method));
            for turn in 0..steps {
                let dt_s = 0.2 / f64::from(steps) * lengths[turn as usize % 2];
                let report = step(&mut system, &mut solver, dt_s).expect("a step");
                let is_euler = turn == 0 || method == Method::BackwardEuler;
                assert_eq!(report.first_order_parts > 0, is_euler, "step {turn}");
            }
            apart(system.positions())
        });
        let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
        assert!((orders[1] - expected).abs() < 0.2, "{orders:?}");
    }
}
