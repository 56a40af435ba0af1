//! When and where a cloth tears first, by every method and every kind of threshold.

use std::num::NonZero;

use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::scene::Scene;
use tearmesh_cloth::{Method, Tearing, Threshold, Xpbd};

use crate::parts::near;
use crate::parts::scenes::{methods, staged, torn_first};

/// `rip` on a sheet of 10 × 10 cells, with the number of the step, and the edge with the largest load. All
/// that would move them is a change of the fabric, of a step's length, or of what decides.
const EXPECTED: &str = include_str!("first_tears.txt");

const TWO: NonZero<u32> = NonZero::<u32>::MIN.saturating_add(1);

/// Methods that do not depend on the step tear at the same time at half of it.
#[test]
fn first_tears_of_all_methods_by_all_thresholds() {
    let mut found = String::new();
    let [explicit @ .., _] = methods();
    let others = [
        ("implicit", Method::Implicit(Settings::default())),
        ("xpbd by tens", Method::Xpbd(Xpbd::default())),
    ];
    for (name, solver) in explicit.into_iter().chain(others) {
        for (kind, threshold) in [
            ("stretch", Threshold::Stretch(1.5)),
            ("toughness", Threshold::Toughness(12.5)),
            ("force", Threshold::Force(50.0)),
        ] {
            let rip = || {
                staged(10, |frame| Scene {
                    solver: solver.clone(),
                    tearing: Some(Tearing::new(threshold)),
                    ..Scene::rip(frame)
                })
            };
            let (run, edge) = torn_first(rip());
            if ["verlet", "implicit"].contains(&name) {
                let (halved, _) = torn_first(rip().in_smaller_steps(TWO));
                near(halved.elapsed_s() / run.elapsed_s(), 1.0, 0.02);
            }
            let [a, b] = [run.mesh().origin(edge), run.mesh().target(edge)];
            let (step, per_s) = (run.tally().steps, 1.0 / run.step_s());
            found += &format!("{name} {kind}: step {step} of 1/{per_s:.0} s, {a}-{b}\n");
        }
    }
    assert_eq!(found, EXPECTED);
}
