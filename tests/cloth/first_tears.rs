//! When and where a cloth tears first, by every method and every kind of threshold.

use tearmesh_cloth::Method;
use tearmesh_cloth::scene::Scene;
use tearmesh_cloth::{Tearing, Threshold, Xpbd};

use crate::parts::scenes::{methods, staged};

/// Sampled before the pass that finds overstretched edges replaced a search within each method: `rip` on
/// a sheet of 10 × 10 cells, with the number of the step, and the edge with the largest load.
const EXPECTED: &str = "\
xpbd stretch: step 695 of 1/780 s, v60-v70
xpbd toughness: step 641 of 1/780 s, v60-v70
xpbd force: step 616 of 1/780 s, v60-v70
xpbd by tens stretch: step 96 of 1/120 s, v71-v82
xpbd by tens toughness: step 93 of 1/120 s, v60-v70
xpbd by tens force: step 90 of 1/120 s, v60-v70
pbd stretch: step 146 of 1/240 s, v71-v82
pbd toughness: step 146 of 1/240 s, v71-v82
pbd force: step 156 of 1/240 s, v72-v60
verlet stretch: step 1529 of 1/2160 s, v71-v82
verlet toughness: step 1529 of 1/2160 s, v71-v82
verlet force: step 1504 of 1/2160 s, v72-v60
provot stretch: step 1290 of 1/1920 s, v71-v82
provot toughness: step 1290 of 1/1920 s, v71-v82
provot force: step 1090 of 1/1920 s, v71-v82
implicit stretch: step 171 of 1/240 s, v71-v82
implicit toughness: step 171 of 1/240 s, v71-v82
implicit force: step 167 of 1/240 s, v60-v70
";

#[test]
fn first_tears_of_all_methods_by_all_thresholds() {
    let mut found = String::new();
    let [xpbd, others @ ..] = methods();
    let by_tens = ("xpbd by tens", Method::Xpbd(Xpbd::default()));
    for (name, solver) in [xpbd, by_tens].into_iter().chain(others) {
        for (kind, threshold) in [
            ("stretch", Threshold::Stretch(1.5)),
            ("toughness", Threshold::Toughness(12.5)),
            ("force", Threshold::Force(50.0)),
        ] {
            let mut run = staged(10, |frame| Scene {
                solver: solver.clone(),
                tearing: Some(Tearing::new(threshold)),
                ..Scene::rip(frame)
            });
            let (edge, _) = loop {
                assert!(!run.is_over(), "{name} {kind}: nothing tore");
                let tear = run.step().expect("a step");
                if let Some(worst) = tear.worst.filter(|_| tear.splits > 0) {
                    break worst;
                }
            };
            let [a, b] = [run.mesh().origin(edge), run.mesh().target(edge)];
            let (step, per_s) = (run.tally().steps, 1.0 / run.step_s());
            found += &format!("{name} {kind}: step {step} of 1/{per_s:.0} s, {a}-{b}\n");
        }
    }
    assert_eq!(found, EXPECTED);
}
