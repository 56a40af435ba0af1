//! What a cut costs that makes the longest stable step shorter, and which method would be cheaper.

use tearmesh_cloth::Counters;
use tearmesh_cloth::scene::{Method, Run, StableSteps, suggested_step_s};

use super::words::two_digits;
use crate::say::{Fault, short};

/// What had been computed when a cut made the longest stable step much shorter.
pub(super) struct Shortened {
    /// By how many times.
    times: f64,
    at_s: f64,
    before: Counters,
}

impl Shortened {
    /// Looks at a cut; `before` is what had been computed before the step that it was made in.
    pub(super) fn by(stability: &StableSteps, at_s: f64, before: Counters) -> Option<Shortened> {
        let times = stability.before_s / stability.after_s;
        (times >= TIMES_NOTABLE).then_some(Shortened {
            times,
            at_s,
            before,
        })
    }

    /// Says what a second took before the cut and after it, counted, and what it would take by the
    /// default method. Nothing where there was no time before the cut or after it.
    pub(super) fn note(&self, run: &Run) -> Option<Fault> {
        let after_s = run.elapsed_s() - self.at_s;
        if self.at_s <= 0.0 || after_s <= 0.0 {
            return None;
        }
        let all = constraint_visits(&run.cloth().system().counters());
        let before = constraint_visits(&self.before);
        let each = [before as f64 / self.at_s, (all - before) as f64 / after_s];
        let verlet = by_verlet(run);
        if verlet >= each[1] {
            return None;
        }
        let [before, after, verlet] = [each[0], each[1], verlet].map(|x| two_digits(x / 1e6));
        let message = format!(
            "the cut at {} s made the longest stable step {} times shorter: a second took {before} \
             million visits of constraints before it and {after} million after it",
            short(self.at_s),
            two_digits(self.times),
        );
        let help = format!("--solver verlet, by which a second takes some {verlet} million");
        Some(Fault::note("W-SIM-SHORTENED", message).help(help))
    }
}

/// Steps that get shorter by less are not worth a word.
const TIMES_NOTABLE: f64 = 2.0;

fn constraint_visits(counters: &Counters) -> u64 {
    counters.visits.project + counters.visits.force
}

/// How many constraints [`Method::Verlet`] would visit in a second, each once a step: it lets vertices
/// that are too light for its step swing more slowly, so that a cut does not shorten it.
fn by_verlet(run: &Run) -> f64 {
    let mut system = run.cloth().system().clone();
    let constraints = system.stretches().len() + system.bends().len() + system.triangles().len();
    // The speed of a pull says how long the steps of methods that sweep may be, and nothing of this one.
    let step_s = suggested_step_s(&Method::Verlet, &mut system, 0.0);
    constraints as f64 / step_s
}
