//! Forces are gradients.

use super::{Scene, Triangle, forces, order, spring};
use crate::random::Random;
use tearmesh::Vector;
use tearmesh_cloth::{Buckling, System, energy};

/// Scenes of one constraint each, in a general position: name and scene.
fn specimens() -> Vec<(&'static str, Scene)> {
    let mut random = Random(5);
    let mut specimens = Vec::new();
    let points = |n: usize, size: f64, random: &mut Random| {
        let point = |_| [0, 1, 2].map(|_| size * (2.0 * random.next() - 1.0));
        (0..n).map(point).collect::<Vec<[f64; 3]>>()
    };
    for (name, part) in [("stretched spring", 0.7), ("compressed spring", 1.4)] {
        let ends = points(2, 1.0, &mut random);
        let mut scene = Scene::particles(ends, 1.0);
        let length = (scene.x[1] - scene.x[0]).norm();
        scene.springs.push(spring(0, 1, part * length, 3.0));
        specimens.push((name, scene));
    }
    // d/L well inside the arc, near its ends, in the spring's range, beyond L.
    for (name, part) in [
        ("arc, folded", 0.05),
        ("arc", 0.5),
        ("arc, nearly flat", 0.97),
        ("bend before buckling", 0.995),
        ("bend beyond L", 1.2),
    ] {
        let ends = points(2, 1.0, &mut random);
        let mut scene = Scene::particles(ends, 1.0);
        let l = (scene.x[1] - scene.x[0]).norm() / part;
        bend(&mut scene, 0.992, 1.0, l);
        specimens.push((name, scene));
    }
    for (name, size) in [("stretched triangle", 2.0), ("compressed triangle", 0.3)] {
        let mut scene = Scene::particles(points(3, size, &mut random), 1.0);
        scene.triangles.push(oblique());
        specimens.push((name, scene));
    }
    specimens
}

/// A triangle that no axis runs along.
fn oblique() -> Triangle {
    Triangle {
        corners: [0, 1, 2],
        material: [[0.1, 0.0], [1.2, 0.3], [0.4, 0.9]],
        stiffness: [3.0, 2.0, 0.7],
    }
}

/// Adds a bend between the first two particles that buckles below this part of its length l, with
/// the flexural stiffness k.
fn bend(scene: &mut Scene, buckles_below: f64, k: f64, l: f64) {
    let law = Buckling::new(buckles_below).expect("a law");
    scene.law = Some(law);
    let stiffness = law.compression_n_per_m(k, l);
    scene.bends.push(spring(0, 1, l, stiffness));
}

/// A bend whose ends are d apart along x: its pull, and its energy.
fn bend_at(buckles_below: f64, k: f64, l: f64, d: f64) -> [f64; 2] {
    let mut scene = Scene::particles([[0.0; 3], [d, 0.0, 0.0]], 1.0);
    bend(&mut scene, buckles_below, k, l);
    let mut system = scene.system();
    [forces(&mut system)[0].x, energy::elastic_j(&system)]
}

/// The system with one coordinate moved.
fn moved(system: &System, coordinate: usize, by: f64) -> System {
    let mut system = system.clone();
    system.state_mut().0[coordinate / 3][coordinate % 3] += by;
    system
}

/// The error of central differences of width h of the energy, relative to the largest force.
fn error(scene: &Scene, h: f64) -> f64 {
    let system = scene.system();
    let exact = forces(&mut scene.system());
    let largest = exact.iter().fold(1e-300f64, |m, f| m.max(f.amax()));
    let off = (0..3 * exact.len()).map(|c| {
        let [plus, minus] = [h, -h].map(|by| energy::elastic_j(&moved(&system, c, by)));
        ((plus - minus) / (2.0 * h) + exact[c / 3][c % 3]).abs() / largest
    });
    off.fold(0.0, f64::max)
}

#[test]
fn forces_are_gradients_to_order_two() {
    let mut measured = 0;
    for (name, scene) in specimens() {
        let (coarse, fine) = (error(&scene, 1e-3), error(&scene, 5e-4));
        if fine < 1e-12 {
            // Nothing acts, or a parabola: differences are exact.
            continue;
        }
        let order = order(coarse, fine);
        println!("{name}: {fine:.1e}, order {order:.3}");
        assert!(fine < 1e-3, "{name}: {fine}");
        assert!((order - 2.0).abs() < 0.05, "{name}: order {order}");
        measured += 1;
    }
    assert!(measured >= 8, "only {measured} orders were measured");
}

#[test]
fn internal_forces_sum_to_zero() {
    for (name, scene) in specimens() {
        let forces = forces(&mut scene.system());
        let sum: Vector = forces.iter().sum();
        let size = super::norm(&forces);
        assert!(sum.norm() <= 4e-16 * size, "{name}: {sum} of {size}");
        let torque: Vector = forces
            .iter()
            .zip(&scene.x)
            .map(|(f, x)| x.coords.cross(f))
            .sum();
        assert!(torque.norm() <= 4e-15 * size, "{name}: torque {torque}");
    }
}

#[test]
fn bending_is_an_arc() {
    // Half a circle of length L has its ends 2L/π apart and κ = π/L.
    let (l, k) = (0.3f64, 0.02f64);
    let pi = std::f64::consts::PI;
    let curvature = pi / l;
    // f = k κ² / (cos ½π − sinc ½π), negative: it pushes apart.
    let truth = k * curvature * curvature / (0.0 - 2.0 / pi);
    let [force, energy] = bend_at(0.99, k, l, 2.0 * l / pi);
    assert!((force / truth - 1.0).abs() < 1e-14, "{force} {truth}");
    // Energy between two distances of the arc: the difference of ½ k κ² L.
    let [_, folded] = bend_at(0.99, k, l, 1e-30);
    let more = folded - energy;
    let truth = 0.5 * k * l * (4.0 - 1.0) * curvature * curvature;
    assert!((more / truth - 1.0).abs() < 1e-14, "{more} {truth}");
    // It starts to buckle at Euler's load for this arc, 12 k / L², as c → ∞.
    let below = 0.99;
    let [load, _] = bend_at(below, k, l, below * l);
    let euler = 12.0 * k / (l * l);
    assert!((-load / euler - 1.0).abs() < 0.02, "{load} {euler}");
}

#[test]
fn bending_energy_is_the_work_of_its_force_across_the_change_over() {
    let (l, k, below) = (0.3, 0.02, 0.8);
    let change = below * l;
    let at = |d: f64| {
        let [force, energy] = bend_at(below, k, l, d);
        (energy, force)
    };
    // Simpson's rule on both sides of the change-over, where the force has a kink.
    let work = |from: f64, to: f64| {
        let n = 200;
        let h = (to - from) / f64::from(n);
        let weight = |i: i32| match i {
            0 => 1.0,
            i if i == n => 1.0,
            i => f64::from(2 + 2 * (i % 2)),
        };
        let sum: f64 = (0..=n)
            .map(|i| weight(i) * at(from + h * f64::from(i)).1)
            .sum();
        -sum * h / 3.0
    };
    let half = 0.5 * l;
    let total = work(half, change) + work(change, l);
    let energy = at(half).0;
    assert!((total / energy - 1.0).abs() < 1e-8, "{total} {energy}");
    assert!((at(change * (1.0 - 1e-12)).1 / at(change).1 - 1.0).abs() < 1e-9);
    assert_eq!(at(l), (0.0, 0.0));
}

#[test]
fn the_common_polynomial_is_a_fit_of_the_arc_when_multiplied() {
    let (l, k) = (0.25, 0.6);
    let mut worst = 0.0f64;
    for i in 1..1000 {
        let x = f64::from(i) / 1000.0;
        let [force, _] = bend_at(0.9995, k, l, x * l);
        let fit = (((-11.541 * x + 34.193) * x - 39.083) * x + 23.116) * x - 9.713;
        worst = worst.max((force / (4.0 * k / (l * l) * fit) - 1.0).abs());
    }
    println!("polynomial against arc: {worst:.2e}");
    assert!(worst < 0.02, "{worst}");
}
