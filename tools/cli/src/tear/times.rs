//! Times that steps do not make up.

use tearmesh::cloth::Run;

use crate::say::{Fault, count, short};

/// The part of the seconds that were asked for by which those simulated may differ unsaid: a step
/// that is chosen for its stability hardly ever divides them, and the summary says them.
const DIFFERENCE_MAX: f64 = 0.01;

/// What is to be said before the first step.
pub(super) fn warnings(run: &Run) -> Vec<Fault> {
    Vec::from_iter(seconds(run))
}

/// Says that another time is simulated than was asked for.
fn seconds(run: &Run) -> Option<Fault> {
    let (asked_s, step_s) = (run.scene().duration_s, run.step_s());
    let steps = run.steps_planned();
    let made_s = steps as f64 * step_s;
    if (made_s - asked_s).abs() <= DIFFERENCE_MAX * asked_s {
        return None;
    }
    let message = format!(
        "{} s are no whole number of steps of {} s: {} s are simulated, in {}",
        short(asked_s),
        short(step_s),
        short(made_s),
        count(steps as usize, "step", "steps"),
    );
    let whole_part_s = asked_s / (asked_s / step_s).ceil();
    let help = format!("--dt {}", short(whole_part_s));
    Some(Fault::warning("W-SIM-SECONDS", message).help(help))
}
