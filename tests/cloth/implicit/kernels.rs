//! Forces are gradients.

use super::{Scene, forces, norm};
use crate::parts::{near, order};
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
        let compression = law.compression_n_per_m(1.0, l);
        scene.law = Some(law);
        scene.bends.push(([0, 1], l, compression));
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
pub(super) fn moved(system: &System, coordinate: usize, by: f64) -> System {
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
fn forces_are_gradients_to_order_two_and_sum_to_zero() {
    let mut measured = 0;
    for (name, scene) in specimens() {
        let errors = [1e-3, 5e-4].map(|h| error(&scene, h));
        // Where nothing acts, and of a parabola, differences are exact.
        if errors[1] > 1e-12 {
            assert!(errors[1] < 1e-3, "{name}");
            near(order(errors), 2.0, 0.05);
            measured += 1;
        }
        let forces = forces(&mut scene.system());
        let size = norm(&forces);
        let torques = forces.iter().zip(&scene.x).map(|(f, x)| x.coords.cross(f));
        let torque: Vector = torques.sum();
        let sum: Vector = forces.iter().sum();
        assert!(sum.norm() <= 4e-16 * size, "{name}: {sum} of {size}");
        assert!(torque.norm() <= 4e-15 * size, "{name}: torque {torque}");
    }
    assert!(measured >= 8, "only {measured} orders were measured");
}
