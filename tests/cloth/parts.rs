//! What the tests of cloth are made of: systems, cloths and scenes, loads, and comparisons. There is
//! no test here, and no test takes its parts from another one's file.

pub(crate) mod cloths;
pub(crate) mod nets;
pub(crate) mod scenes;
pub(crate) mod vibration;
pub(crate) mod woven;

use tearmesh::Vector;
use tearmesh_cloth::implicit::{Method, Settings};
use tearmesh_cloth::{Implicit, Loads, Solver, System, Unstable, energy};

use crate::random::Random;

/// The acceleration of gravity, in m/s².
pub(crate) const G: f64 = 9.81;

/// A value is an answer to within an absolute tolerance, all in one unit.
///
/// # Panics
///
/// If it is not, or is no number; in the place of the caller.
#[track_caller]
pub(crate) fn near(value: f64, answer: f64, tolerance: f64) {
    assert!(
        (value - answer).abs() <= tolerance,
        "{value} is not {answer}, off by {:e}",
        value - answer
    );
}

/// Gravity down the z axis, and drag in 1/s; none at all if that is 0.
pub(crate) fn gravity(drag_per_s: f64) -> Loads {
    falling(Vector::new(0.0, 0.0, -G), drag_per_s)
}

/// Gravity down the y axis, as for a sheet that hangs in its own plane, and drag in 1/s; none at all
/// if that is 0.
pub(crate) fn gravity_along_y(drag_per_s: f64) -> Loads {
    falling(Vector::new(0.0, -G, 0.0), drag_per_s)
}

fn falling(gravity_m_per_s2: Vector, drag_per_s: f64) -> Loads {
    Loads {
        gravity_m_per_s2: Some(gravity_m_per_s2),
        drag_per_s: (drag_per_s > 0.0).then_some(drag_per_s),
        ..Loads::default()
    }
}

/// Takes `steps` steps, also beyond the bound that the guard of explicit methods goes by.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn run(system: &mut System, mut solver: impl Solver, dt_s: f64, steps: usize) {
    system.when_unstable(Unstable::Allow);
    for _ in 0..steps {
        system.step(&mut solver, dt_s).expect("a stable step");
    }
}

/// The elastic and the kinetic energy, in joules.
pub(crate) fn mechanical_j(system: &System) -> f64 {
    energy::elastic_j(system) + energy::kinetic_j(system)
}

/// The implicit solver, with each linear equation solved to about rounding.
pub(crate) fn implicit(method: Method) -> Implicit {
    Implicit::new(Settings {
        method,
        tolerance: 1e-9,
        ..Settings::default()
    })
}

/// Puts a list into random order (Fisher and Yates).
pub(crate) fn shuffle<T>(list: &mut [T], random: &mut Random) {
    for i in (1..list.len()).rev() {
        list.swap(i, (random.next() * (i + 1) as f64) as usize);
    }
}
