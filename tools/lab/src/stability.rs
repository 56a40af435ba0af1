//! Stability: where each method fails, in theory and as measured, and what users are told.
//!
//! A [`Limit`] concerns small motions of a net of springs: the step from which they grow without bound. It
//! is found by bisection with the watch over stability off. It is compared with the theoretical limit, whose
//! frequency comes from a dense matrix that shares no code with the methods. It also records which steps the
//! watch stops. A [`Verdict`] concerns a scene as a user plays it, built so that some methods fail: whether
//! exactly those fail.
//!
//! Messages come from a [`Teller`], since the wording and the codes belong to the command. A cell that
//! failed without a message is *silent*. One whose outcome is not the expected one *differs*. There should
//! be neither.

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
use crate::parts::Missing;
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The options of the experiment on stability.
#[derive(Clone, Debug)]
pub struct Options {
    /// The stiffness values of the springs, in N/m. Each method is tried on each net at each of them.
    pub stiffness_n_per_m: Vec<f64>,
    /// The number of pieces to work on at a time.
    pub threads: NonZero<usize>,
}

/// The results of the experiment on stability.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: &'static str,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The limits, ordered by method, then by net, then by stiffness.
    pub limits: Vec<Limit>,
    /// The verdicts, ordered by scene and then by method.
    pub verdicts: Vec<Verdict>,
    /// The number of limits and verdicts that differ from the expected outcome.
    pub differing: usize,
    /// The number of cells and verdicts that failed without a message.
    pub silent: usize,
    /// The limits and scenes whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
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

/// Returns the number of pieces of the experiment: one per limit and one per scene.
#[must_use]
pub fn pieces(options: &Options) -> usize {
    jobs(options).len()
}

/// Runs the experiment. The same options and messages give the same study.
///
/// `watch` is called with the name of each piece that is done. When `stop` returns true, all pieces end as soon
/// as possible, and those that were not finished are missing. Returns `None` if that leaves no piece.
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
        },
    );
    let (mut limits, mut verdicts, mut missing) = (Vec::new(), Vec::new(), Vec::new());
    for (job, done) in jobs.iter().zip(done) {
        match done {
            Some(Done::Limit(limit)) => limits.push(limit),
            Some(Done::Trial(of_trial)) => verdicts.extend(of_trial),
            None => missing.push(Missing::interrupted(name(job))),
        }
    }
    if limits.is_empty() && verdicts.is_empty() && !missing.is_empty() {
        return None;
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
        missing,
    })
}

fn name(job: &Job) -> String {
    match job {
        Job::Limit(asked) => asked.name(),
        Job::Trial(trial) => trial.name.to_owned(),
    }
}
