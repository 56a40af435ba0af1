//! The second reference of the experiments, which has springs, loads and a solver of its own, against the product.

use tearmesh::Vector;
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Fabric, Solver, Unstable, Verlet};

use crate::parts::cloths::{bent, loaded};
use crate::parts::{blown, implicit_by_default, pulled, shake};
use crate::random::Random;
use crate::reference::Reference;

/// How far the reference and a method are apart after so many steps of a crumpled sheet in wind, with springs across
/// its edges; a vertex may be held.
fn distance(damping_s: f64, hold: Option<usize>, mut method: impl Solver, steps: u32) -> f64 {
    let gravity = pulled(Vector::new(0.5, 0.0, -9.81), 2.0);
    let loads = blown(Vector::new(1.0, 3.0, 2.0), 1.5, gravity);
    let (_, mut own) = loaded(5, bent(Fabric::new(70.0), 3.0), loads);
    let system = own.system_mut();
    system.set_damping(damping_s).expect("a time");
    system.when_unstable(Unstable::Allow);
    shake(system, 0.1, 2.0, &mut Random(12));
    if let Some(v) = hold {
        system.hold(v);
        system.state_mut().1[v].fill(0.0);
    }
    let mut product = own.clone();
    let mut reference = Reference::new(own.indices());
    for _ in 0..steps {
        let dt_s = 0.05 / f64::from(steps);
        own.step(&mut reference, dt_s).expect("a step");
        product.step(&mut method, dt_s).expect("a step");
    }
    let pairs = own.positions().iter().zip(product.positions());
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// Verlet takes damping in by the velocities of half a step before, so half of their distance is left at half
/// the step. Undamped, the reference and BDF2 are of second order, so a quarter is left.
#[test]
fn motions_of_the_second_reference_are_those_of_the_product() {
    let damped = |steps| distance(0.01, None, Verlet, steps);
    let undamped = |steps| distance(0.0, Some(0), implicit_by_default(Method::Bdf2), steps);
    for ([coarse, fine], ratio) in [
        ([400, 800].map(damped), 1.8..2.2),
        ([200, 400].map(undamped), 3.0..5.0),
    ] {
        let is_right = fine < 1e-3 && ratio.contains(&(coarse / fine));
        assert!(is_right, "{coarse} {fine}");
    }
}
