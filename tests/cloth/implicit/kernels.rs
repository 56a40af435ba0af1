//! Forces are gradients.

use super::{Scene, forces};
use crate::random::Random;
use tearmesh::Vector;
use tearmesh_cloth::{Buckling, System, energy};

/// Scenes of one constraint each, in a general position: name and scene.
fn specimens() -> Vec<(&'static str, Scene)> {
    let mut random = Random(5);
    let mut particles = |n: usize, size: f64| {
        let point = |_| [0, 1, 2].map(|_| size * (2.0 * random.next() - 1.0));
        Scene::particles((0..n).map(point), 1.0)
    };
    let mut specimens = Vec::new();
    for (name, part) in [("stretched spring", 0.7), ("compressed spring", 1.4)] {
        let mut scene = particles(2, 1.0);
        let length = (scene.x[1] - scene.x[0]).norm();
        scene.springs.push(([0, 1], part * length, 3.0));
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
        let mut scene = particles(2, 1.0);
        let l = (scene.x[1] - scene.x[0]).norm() / part;
        let law = Buckling::new(0.992).expect("a law");
        scene.law = Some(law);
        scene
            .bends
            .push(([0, 1], l, law.compression_n_per_m(1.0, l)));
        specimens.push((name, scene));
    }
    for (name, size) in [("stretched triangle", 2.0), ("compressed triangle", 0.3)] {
        let mut scene = particles(3, size);
        let material = [[0.1, 0.0], [1.2, 0.3], [0.4, 0.9]];
        scene.triangles.push(([0, 1, 2], material, [3.0, 2.0, 0.7]));
        specimens.push((name, scene));
    }
    specimens
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
        let order = (coarse / fine).log2();
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
