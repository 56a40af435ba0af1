//! The blow-up map: every cell of step × stiffness × scene × method has the class it should.

use tearmesh::Vector;
use tearmesh_cloth::{Solver, StepError, System, Unstable, energy};

use super::{Links, METHODS};
use crate::parts::nets::{push, pushed};
use crate::parts::vibration::largest_frequency;
use crate::parts::{mechanical_j, method};

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    /// It ran 600 steps, and the energy that a push brought did not grow.
    Stable,
    /// It ran on with more energy than it should have.
    Grown,
    /// Blow-up was noticed, and the last good state kept.
    BlownUp,
    /// The watch over stability did not let it begin.
    Unstable,
    /// The method knows no triangles.
    Refused,
}

const SCENES: [&str; 4] = ["chain", "string", "frame", "strip"];
const STIFFNESSES: [f64; 4] = [1e2, 1e3, 1e4, 1e5];
const PARTS: [f64; 4] = [0.9, 0.99, 1.01, 1.1];

/// A scene, at rest but for a push at one particle.
fn scene(name: &str, stiffness: f64) -> System {
    if name != "strip" {
        return pushed(name, stiffness);
    }
    let strip = Links::Triangles.row(16, 0.01, stiffness, 0.1, Vector::x() * 0.1);
    push(strip, 5)
}

/// A run at this part of the limit of the method, or of Verlet's where it has none, for a system of this
/// largest frequency.
fn class(
    (mut system, omega): (System, f64),
    solver: &mut dyn Solver,
    part: f64,
    unstable: Unstable,
) -> Class {
    let limit = solver.abilities().frequency_limit;
    let dt = part * limit.unwrap_or(2.0) / omega;
    system.when_unstable(unstable);
    let (rest, push) = (energy::elastic_j(&system), energy::kinetic_j(&system));
    // What projects shakes a pretensioned net by what it stores; what has forces does not.
    let shaken = limit.map_or(rest, |_| 0.0);
    let mut most = 0.0_f64;
    for _ in 0..600 {
        match system.step(&mut *solver, dt) {
            Ok(_) => most = most.max(mechanical_j(&system) - rest),
            Err(StepError::BlowUp { .. }) => {
                assert!(system.positions().iter().all(|p| p.coords.norm() < 1e3));
                return Class::BlownUp;
            }
            Err(StepError::Unstable { .. }) => return Class::Unstable,
            Err(StepError::NotSprings { .. }) => return Class::Refused,
            Err(other) => panic!("{other}"),
        }
    }
    if most > 400.0 * push + shaken {
        Class::Grown
    } else {
        Class::Stable
    }
}

/// The classes at .9, .99, 1.01 and 1.1 of the limit.
///
/// Beyond it a chain grows until its links turn aside, which softens them, and RK4 damps what lies
/// above its limit by ever less; so both may go on with more energy than they should have. PBD
/// shakes nets that cannot reach their rest lengths, the more the shorter the step (F7).
fn expected(name: &str, scene: &str) -> [Class; 4] {
    use Class::{BlownUp, Grown, Refused, Stable};
    match (name, scene) {
        ("XPBD" | "PBD", "strip") => [Refused; 4],
        ("PBD", "string" | "frame") => [Grown; 4],
        ("RK4" | "Provot" | "Verlet", _) => [Stable, Stable, BlownUp, BlownUp],
        _ => [Stable; 4],
    }
}

#[test]
fn table_of_blow_up() {
    let mut wrong = Vec::new();
    for (at, stiffness) in SCENES
        .into_iter()
        .flat_map(|at| STIFFNESSES.map(|k| (at, k)))
    {
        let system = scene(at, stiffness);
        let omega = largest_frequency(&system);
        // Verlet's guards act, or not, by more than the step.
        for name in METHODS.iter().filter(|name| **name != "guarded") {
            let cell = |part, unstable| {
                class(
                    (system.clone(), omega),
                    &mut *method(name, 10),
                    part,
                    unstable,
                )
            };
            // Whether growth was noticed within the run is a matter of its length.
            let has_limit = method(name, 10).abilities().frequency_limit.is_some();
            let classes = PARTS.map(|part| match cell(part, Unstable::Allow) {
                Class::Grown if has_limit => Class::BlownUp,
                other => other,
            });
            let mut found = vec![classes == expected(name, at)];
            if has_limit {
                let watched = [0.6, 1.01, 1.1].map(|part| cell(part, Unstable::Refuse));
                let divided = [1.01, 1.1].map(|part| cell(part, Unstable::Substep));
                found.push(watched == [Class::Stable, Class::Unstable, Class::Unstable]);
                found.push(divided == [Class::Stable; 2]);
            }
            if found.contains(&false) {
                wrong.push(format!("{name} {at} {stiffness:e}: {classes:?} {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
