//! Work against precision: the cost and the error of each method, over the same budget of steps.
//!
//! A [`Case`] is a scene on a mesh. It has four kinds of runs: references by two methods that share no
//! stepping code; a gate that tests whether trajectories can be compared at all; the budget, in which every
//! method runs at the same fractions of its base step; and one run per method at its default settings. A run
//! that fails is a row with a status.
//!
//! Errors are computed for several observables ([`Observable`]). Each has three parts: the total error, that
//! of the method's limit as Δt → 0 (the *model* error), and the distance from that limit (the
//! *discretisation* error). Fronts and the cheapest run for a tolerance are found by visits of edges, which
//! are the same on every machine, and by CPU time if there is a clock.
//!
//! The rules for reading the numbers:
//!
//! * The distance between the two references is the *floor*. An error below ten times the floor is known no
//!   better than that, and dominates no other error there.
//! * A step meets a tolerance if all shorter steps of its series do too. So no error meets it by passing
//!   through zero. An error that is larger than that of a longer step is marked and is on no front.
//! * A point dominates another if it is a tenth better in cost or in error, and no worse in the other.

mod assess;
mod csv;
mod front;
mod mark;
mod mesh;
mod method;
mod observable;
mod observe;
mod plan;
mod run;
mod scene;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::assess::{
    AMPLIFICATION_MAX, COARSE, CaseStudy, Cheapest, Error, FINE, FLOORS, Floor, ReferenceRun, Row,
    Winner, assess,
};
pub use self::csv::csv;
pub(crate) use self::front::{MARGIN, vouched};
pub use self::front::{Point, front};
pub(crate) use self::mark::{Look, colour, draw as draw_mark};
pub(crate) use self::mesh::delaunay;
pub use self::mesh::{MeshKind, SEED, Sheet};
pub use self::method::{Claim, Family, METHODS, Method, Named, PARTS};
pub use self::observable::Observable;
pub(crate) use self::observe::Records;
pub(crate) use self::plan::finest;
pub use self::plan::{Planned, Role, plan};
pub use self::run::{Bounds, CHECKPOINTS, Cost, ENERGY_MAX, Outcome, Status};
pub use self::scene::{
    Case, Held, REST_M_PER_S, SCENES, Scene, Start, TEAR_RATIO, TOUGHNESS_J_PER_M, Until,
};
pub use self::svg::{By, svg};
pub use self::words::summary;

use std::num::NonZero;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::parts::{Divided, Missing};
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The options of the experiment on work against precision.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes to run.
    pub scenes: Vec<Scene>,
    /// The kinds of meshes on which each scene runs.
    pub meshes: Vec<MeshKind>,
    /// The numbers of cells along each side of the meshes.
    pub cells: Vec<u32>,
    /// The number of runs to execute at a time.
    pub threads: NonZero<usize>,
    /// The largest number of visits of edges per row. References have no limit.
    pub visits_max: u64,
    /// The number of times that each successful row is repeated to measure its CPU time, after one more run
    /// to warm up; 0 for none. Repetitions run one after the other, alternating between cases.
    pub repeats: u32,
}

/// The default limit of [`Options::visits_max`], a few seconds of CPU time.
pub const VISITS_MAX: u64 = 200_000_000;

/// The results of the experiment on work against precision.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: String,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The seed of all random numbers.
    pub seed: u64,
    /// The largest number of visits of edges that a row was allowed.
    pub visits_max: u64,
    /// The number of times that successful rows were repeated to measure their CPU time.
    pub repeats: u32,
    /// Whether the experiment was interrupted. Runs that were not finished have [`Status::Interrupted`].
    pub is_interrupted: bool,
    /// The results of each case, ordered by scene, then by kind of mesh, then by size.
    pub cases: Vec<CaseStudy>,
    /// The parts whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

impl Divided for Study {
    const SCHEMA: &'static str = "tearmesh.chart.pareto/2";

    fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn merged(parts: Vec<Study>, provenance: Provenance, missing: Vec<Missing>) -> Option<Study> {
        let is_interrupted = parts.iter().any(|part| part.is_interrupted);
        let mut parts = parts.into_iter();
        let mut whole = parts.next()?;
        whole.cases.extend(parts.flat_map(|part| part.cases));
        Some(Study {
            provenance,
            is_interrupted,
            missing,
            ..whole
        })
    }
}

/// Returns the cases of the experiment, ordered by scene, then by kind of mesh, then by size.
///
/// # Panics
///
/// If a number of cells is 0 or more than a mesh can have.
#[must_use]
pub fn cases(options: &Options) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in &options.scenes {
        for &mesh in &options.meshes {
            for &cells in &options.cells {
                cases.push(Case::new(scene, mesh, cells));
            }
        }
    }
    cases
}

/// Returns an estimate of the visits of edges of all runs, repetitions included.
#[must_use]
pub fn guessed_visits(options: &Options) -> f64 {
    let once: f64 = cases(options)
        .iter()
        .flat_map(plan)
        .map(|planned| guess(&planned, options))
        .sum();
    let again = if options.repeats > 0 {
        f64::from(1 + options.repeats)
    } else {
        0.0
    };
    once * (1.0 + again)
}

/// No row costs more than it may.
fn guess(planned: &Planned, options: &Options) -> f64 {
    match planned.role {
        Role::Verlet | Role::Newton => planned.guess,
        _ => planned.guess.min(options.visits_max as f64),
    }
}

/// Runs the experiment.
///
/// `clock` returns the CPU time of the calling thread. Without it there are no times, and the same options
/// give the same study. When `stop` returns true, all runs end as soon as possible and are marked as
/// interrupted. `watch` is called after each run with its name and the estimated fraction of all work that
/// is done.
///
/// # Panics
///
/// If a number of `options.cells` is 0 or more than a mesh can have.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    clock: Option<&(dyn Fn() -> Duration + Sync)>,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str, f64),
) -> Study {
    let bounds = Bounds {
        visits_max: options.visits_max,
        clock,
        stop,
    };
    let whole = guessed_visits(options);
    let mut done = 0.0;
    let cases = cases(options);
    let (mut studies, mut missing) = (Vec::new(), Vec::new());
    for case in &cases {
        let plan = plan(case);
        let outcomes = side_by_side(
            &plan,
            options.threads,
            |planned| guess(planned, options),
            |planned| match stop() {
                true => Outcome::interrupted(),
                false => planned.carry_out(case, &bounds),
            },
            |i| {
                done += guess(&plan[i], options);
                watch(&format!("{}/{}", case.name(), plan[i].name), done / whole);
            },
        );
        missing.extend(undone(case.part_name(), &outcomes));
        studies.push(assess(case, &plan, &outcomes));
    }
    if options.repeats > 0 && clock.is_some() {
        let are_done = repeat(options, &cases, &mut studies, &bounds, |name, guess| {
            done += guess;
            watch(name, done / whole);
        });
        if !are_done {
            missing.push(Missing::interrupted("repeated times".to_owned()));
        }
    }
    Study {
        schema: Study::SCHEMA.to_owned(),
        provenance,
        seed: SEED,
        visits_max: options.visits_max,
        repeats: options.repeats,
        is_interrupted: !missing.is_empty(),
        cases: studies,
        missing,
    }
}

/// What is missing of a part, if any of its runs was interrupted.
pub(crate) fn undone(part: String, outcomes: &[Outcome]) -> Option<Missing> {
    let is_done = |one: &&Outcome| one.status != Status::Interrupted;
    let (done, runs) = (outcomes.iter().filter(is_done).count(), outcomes.len());
    let why = format!("interrupted after {done} of {runs} runs");
    (done < runs).then_some(Missing { part, why })
}

/// Runs all rows that succeeded again and again, one after the other, scenes by turns: the first time to
/// warm up. Returns false if it was interrupted; then there are no times.
fn repeat(
    options: &Options,
    cases: &[Case],
    studies: &mut [CaseStudy],
    bounds: &Bounds<'_>,
    mut watch: impl FnMut(&str, f64),
) -> bool {
    let plans: Vec<Vec<Planned>> = cases.iter().map(plan).collect();
    let mut times: Vec<Vec<Vec<f64>>> = plans.iter().map(|p| vec![Vec::new(); p.len()]).collect();
    // The first of each case, the second of each, and so on.
    let mut turns: Vec<(usize, usize)> = Vec::new();
    for (number, plan) in plans.iter().enumerate() {
        turns.extend((0..plan.len()).map(|i| (i, number)));
    }
    turns.sort_unstable();
    for round in 0..=options.repeats {
        for &(i, number) in &turns {
            let (case, planned) = (&cases[number], &plans[number][i]);
            let name = format!("{}/{}", case.name(), planned.name);
            let row = studies[number].rows.iter().find(|row| row.run == name);
            if row.is_some_and(|row| row.status == Status::Ok) {
                let outcome = planned.carry_out(case, bounds);
                if outcome.status == Status::Interrupted {
                    return false;
                }
                if round > 0 {
                    times[number][i].extend(outcome.cost.cpu_s);
                }
            }
            watch(&name, guess(planned, options));
        }
    }
    for (number, study) in studies.iter_mut().enumerate() {
        for (i, planned) in plans[number].iter().enumerate() {
            let name = format!("{}/{}", cases[number].name(), planned.name);
            let times = &mut times[number][i];
            times.sort_by(f64::total_cmp);
            let row = study.rows.iter_mut().find(|row| row.run == name);
            if let (Some(row), Some(&least)) = (row, times.first()) {
                row.repeated_s = Some([least, times[times.len() / 2]]);
            }
        }
        study.rank();
    }
    true
}
