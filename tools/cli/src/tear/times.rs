//! Times that steps do not make up: the whole, and that between frames.

use tearmesh_cloth::scene::Run;

use super::frames::RATE_PER_S;
use super::words::two_digits;
use crate::args::TearArgs;
use crate::say::{Fault, count, short};

/// The part of the seconds that were asked for by which those simulated may differ unsaid: a step
/// that is chosen for its stability hardly ever divides them, and the summary says them.
const DIFFERENCE_MAX: f64 = 0.01;

/// What is to be said before the first step.
pub(super) fn warnings(run: &Run, args: &TearArgs) -> Vec<Fault> {
    let mut warnings = Vec::from_iter(seconds(run));
    let are_wanted = args.frames.is_some() || args.cache.is_some();
    if are_wanted && !args.files.dry_run {
        warnings.extend(frames(run));
    }
    warnings
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
        "{} s is not a whole number of steps of {} s: {} s are simulated, in {}",
        short(asked_s),
        short(step_s),
        short(made_s),
        count(steps as usize, "step", "steps"),
    );
    let whole_part_s = asked_s / (asked_s / step_s).ceil();
    let help = format!("--dt {}", short(whole_part_s));
    Some(Fault::warning("W-SIM-SECONDS", message).help(help))
}

/// Says that there are fewer frames than there should be: each shows the end of a step.
fn frames(run: &Run) -> Option<Fault> {
    let step_s = run.step_s();
    if step_s * RATE_PER_S <= 1.0 {
        return None;
    }
    let message = format!(
        "steps of {} s make {} frames a second, not {RATE_PER_S}: a film of them runs too fast",
        short(step_s),
        short(1.0 / step_s),
    );
    let help = format!("--dt {}", two_digits(1.0 / RATE_PER_S));
    Some(Fault::warning("W-FRAMES-FEW", message).help(help))
}
