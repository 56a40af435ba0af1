//! Choice: what choosing a method by scene could save, over the better of two that never change.
//!
//! A [`Task`] is a scene drawn at random with the error that is allowed in it. Every candidate that the
//! library ships carries it out at every step of its series, so the cheapest run that meets the tolerance is
//! known. A [`Policy`] always takes the same family of methods. Its *regret* is the geometric mean, over the
//! tasks whose answer is known, of its cost over that of the cheapest run.
//!
//! The experiment decides whether a planner, a program that chooses for the user, is worth having: its
//! regret would have to be at most [`PLANNER_SHARE`] of that of the better of always-Verlet and always-XPBD.
//! No planner has a regret below 1. So if the better of the two has less than 1.25, no planner passes,
//! whatever its rules.
//!
//! The rules for reading the numbers:
//!
//! * Both rivals have foresight of the step: in each task they take the cheapest step of their series that
//!   meets the tolerance. That favours them over a planner, but makes a verdict of methods and not of steps.
//!   Other policies take the default steps; they tell what foresight is worth.
//! * The error is the largest of three: of the motion, of the forces in edges and of the reactions at the
//!   holds. A planner does not know which of them its user looks at, and each is met by methods that are
//!   wrong in the others: sweeps have good reactions and wrong edge forces. Displacements do not count where
//!   noise grows too much. Other choices ([`Demand`]) are recorded beside it.
//! * An answer is known if the tolerance is at least ten times the floor of each observable that counts.
//! * A policy that misses a tolerance that another run meets costs ten times what always-Verlet does or,
//!   where that misses it as well, ten times the cheapest run.
//! * The cheapest run is one of a series, whose error all shorter steps vouch for. A run at default settings
//!   may meet a tolerance by luck, and cost less.
//! * Costs are visits of edges, which are the same on every machine.

mod csv;
mod policy;
mod svg;
mod task;
#[cfg(test)]
mod tests;
mod trial;
mod words;

pub use self::csv::csv;
pub use self::policy::{
    Demand, FAILURE, PLANNER_SHARE, POLICIES, Policy, Ranking, Regret, Standing, Unknown, Why, rank,
};
pub use self::svg::svg;
pub use self::task::{
    CELLS, DRAG_PER_S, MASS_RATIO, Motion, OBSERVABLES, PRETENSION, STIFFNESS_N_PER_M, TOLERANCE,
    Task, tasks,
};
pub use self::trial::{CANDIDATES, COST_MAX, DEFAULTS, Run, Trial};
pub use self::words::summary;

use std::num::NonZero;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::parts::{Divided, Missing};
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The default seed of the tasks.
pub const SEED: u64 = 20_261_122;

/// The default number of tasks.
pub const TASKS: u32 = 60;

/// The default time of a scene, in seconds: about the time in which a sheet falls by its own half.
pub const SECONDS: f64 = 0.3;

/// The options of the experiment on choice.
#[derive(Clone, Debug)]
pub struct Options {
    /// The seed of the tasks.
    pub seed: u64,
    /// The numbers of the tasks to carry out, from 1.
    pub scenes: RangeInclusive<u32>,
    /// The time that each scene takes, in seconds. Reactions are means over 1/60 s, and unknown in less.
    pub seconds: f64,
    /// The number of tasks to carry out at a time.
    pub threads: NonZero<usize>,
}

/// The results of the experiment on choice.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: String,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The seed of the tasks.
    pub seed: u64,
    /// The time that each scene takes, in seconds.
    pub seconds: f64,
    /// The results of each task, in ascending order of their numbers.
    pub trials: Vec<Trial>,
    /// The comparison of the policies, one per [`Demand`], computed from `trials`.
    pub rankings: Vec<Ranking>,
    /// The parts whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

/// A part is a range of tasks.
impl Divided for Study {
    const SCHEMA: &'static str = "tearmesh.chart.choice/1";

    fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn merged(parts: Vec<Study>, provenance: Provenance, missing: Vec<Missing>) -> Option<Study> {
        let mut parts = parts.into_iter();
        let mut whole = parts.next()?;
        whole.trials.extend(parts.flat_map(|part| part.trials));
        whole.conclude();
        Some(Study {
            provenance,
            missing,
            ..whole
        })
    }
}

impl Study {
    /// Sorts the results of the tasks by number, and compares the policies over all of them. A change of
    /// `trials` needs a new call.
    pub fn conclude(&mut self) {
        self.trials.sort_by_key(|trial| trial.task.number);
        let rankings = Demand::ALL.map(|demand| rank(&self.trials, demand));
        self.rankings = rankings.to_vec();
    }
}

/// Returns an estimate of the visits of edges of all runs.
#[must_use]
pub fn guessed_visits(options: &Options) -> f64 {
    let tasks = tasks(options.seed, options.scenes.clone(), options.seconds);
    tasks.iter().map(Task::guess).sum()
}

/// Runs the experiment. The same options give the same study.
///
/// `watch` is called after each task with its number and the estimated fraction of all work that is done.
/// When `stop` returns true, all tasks end as soon as possible, and those that were not finished are missing.
/// Returns `None` if that leaves no task.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(u32, f64),
) -> Option<Study> {
    let tasks = tasks(options.seed, options.scenes.clone(), options.seconds);
    let whole = guessed_visits(options);
    let mut done = 0.0;
    let outcomes = side_by_side(
        &tasks,
        options.threads,
        Task::guess,
        |task| task.carry_out(stop),
        |i| {
            done += tasks[i].guess();
            watch(tasks[i].number, done / whole);
        },
    );
    let (mut trials, mut missing) = (Vec::new(), Vec::new());
    for (task, outcome) in tasks.iter().zip(outcomes) {
        match outcome {
            Some(trial) => trials.push(trial),
            None => missing.push(Missing::interrupted(format!("scene {}", task.number))),
        }
    }
    if trials.is_empty() && !missing.is_empty() {
        return None;
    }
    let mut study = Study {
        schema: Study::SCHEMA.to_owned(),
        provenance,
        seed: options.seed,
        seconds: options.seconds,
        trials,
        rankings: Vec::new(),
        missing,
    };
    study.conclude();
    Some(study)
}
