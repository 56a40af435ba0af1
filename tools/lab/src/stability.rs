//! Stability: where each method fails, by theory and as measured, and what a user is told of it.
//!
//! [`Limit`] is about small motions of nets: from which step on they grow without bound, found by
//! bisection with the watch over stability off, against the limit of theory, whose frequency comes from a
//! dense matrix that shares no code with the methods; and which steps the watch stops. [`Verdict`] is
//! about scenes as a user plays them, each made so that some method fails: whether that one does, and the
//! others do not.
//!
//! What is said comes from who says it, as a [`Teller`]: the words and codes of the command are none of
//! this crate's. A cell that failed with nothing said is *silent*; one that did something else than it
//! should, *differs*. There should be none of either.

mod csv;
mod limit;
mod net;
mod svg;
#[cfg(test)]
mod tests;
mod told;
mod trial;
mod words;

pub use self::csv::csv;
pub use self::limit::{AGREEMENT, ASKED, Cell, Limit, STIFFNESS_N_PER_M, Theory};
pub use self::net::NetKind;
pub use self::svg::svg;
pub use self::told::{Class, Teller, Told};
pub use self::trial::{MADE_MAX, METHODS, OFF_MAX, TRIALS, Trial, Verdict};
pub use self::words::summary;

use std::num::NonZero;

use serde::Serialize;

use self::limit::Asked;
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// What to chart, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The stiffness of the springs whose limits are looked for, in N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// How many pieces are worked on at a time.
    pub threads: NonZero<usize>,
}

/// The experiment, made.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// How to read the file.
    pub schema: &'static str,
    /// Where it comes from.
    pub provenance: Provenance,
    /// By method, net and stiffness.
    pub limits: Vec<Limit>,
    /// By scene and method.
    pub verdicts: Vec<Verdict>,
    /// How many limits and scenes came out otherwise than expected.
    pub differing: usize,
    /// How many cells failed with nothing said.
    pub silent: usize,
}

/// A piece of the experiment.
enum Job {
    Limit(Asked),
    Trial(&'static Trial),
}

enum Done {
    Limit(Limit),
    Trial(Vec<Verdict>),
}

fn jobs(options: &Options) -> Vec<Job> {
    let limits = limit::asked(&options.stiffness_n_per_m).into_iter();
    let limits = limits.map(Job::Limit);
    limits.chain(TRIALS.iter().map(Job::Trial)).collect()
}

/// How many pieces the experiment has.
#[must_use]
pub fn pieces(options: &Options) -> usize {
    jobs(options).len()
}

/// Makes the experiment. The same options and words give the same study. All ends at once, without one,
/// where `stop` says so; `watch` hears of each piece that is done.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    teller: &dyn Teller,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str),
) -> Option<Study> {
    let jobs = jobs(options);
    let done = side_by_side(
        &jobs,
        options.threads,
        |job| match job {
            Job::Limit(asked) => asked.guess(),
            Job::Trial(_) => 100.0,
        },
        |job| match job {
            Job::Limit(asked) => asked.find(teller, &stop).map(Done::Limit),
            Job::Trial(trial) => trial.judge(teller, &stop).map(Done::Trial),
        },
        |i| {
            watch(&name(&jobs[i]));
            !stop()
        },
    )?;
    let (mut limits, mut verdicts) = (Vec::new(), Vec::new());
    for done in done {
        match done? {
            Done::Limit(limit) => limits.push(limit),
            Done::Trial(of_trial) => verdicts.extend(of_trial),
        }
    }
    let off = limits.iter().filter(|limit| !limit.agrees).count();
    let other = verdicts.iter().filter(|one| one.expected != one.measured);
    let cells = limits.iter().flat_map(|limit| &limit.cells);
    let unsaid = cells.filter(|cell| cell.is_silent()).count();
    Some(Study {
        schema: "tearmesh.chart.stability/1",
        provenance,
        differing: off + other.count(),
        silent: unsaid + verdicts.iter().filter(|one| one.is_silent()).count(),
        limits,
        verdicts,
    })
}

fn name(job: &Job) -> String {
    match job {
        Job::Limit(asked) => asked.name(),
        Job::Trial(trial) => trial.name.to_owned(),
    }
}
