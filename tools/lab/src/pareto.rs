//! Work against precision: what each method costs, and how far it is off, over the same budget.
//!
//! A [`Case`] is a scene on a mesh. Its runs are references by two methods that share no code of steps, a
//! gate that says whether trajectories may be compared at all, and the budget: every method at the same
//! parts of its base step, and what a user gets who names a method and nothing else. A run that fails
//! is a row with a status. Of what the runs leave behind errors are made by several observables
//! ([`Observable`]), each in three parts: total, that of the method's limit as Δt → 0 (its *model*), and
//! what is left (*discretisation*). Fronts and the cheapest for a tolerance are by visits of edges,
//! which are the same on every machine; and by CPU time, where a clock is given.
//!
//! What a number can be relied on for:
//!
//! * The distance of the two references is the *floor*. An error below ten times that is known no
//!   better, and dominates no other one there.
//! * A step meets a tolerance if all shorter steps of its series do as well: no error meets it by
//!   passing zero. One that is larger than that of a longer step is marked, and on no front.
//! * A point dominates another if it is a tenth better in cost and a tenth better in error.

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
pub use self::front::{Point, front};
pub(crate) use self::mark::colour;
pub(crate) use self::mesh::delaunay;
pub use self::mesh::{MeshKind, SEED, Sheet};
pub use self::method::{Claim, Family, METHODS, Method, Named, PARTS};
pub use self::observable::Observable;
pub use self::plan::{Planned, Role, plan};
pub use self::run::{Bounds, CHECKPOINTS, Cost, ENERGY_MAX, Outcome, Status};
pub use self::scene::{
    Case, Held, REST_M_PER_S, SCENES, Scene, Start, TEAR_RATIO, TOUGHNESS_J_PER_M, Until,
};
pub use self::svg::{By, svg};
pub use self::words::summary;

use std::num::NonZero;
use std::time::Duration;

use serde::Serialize;

use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// What to chart, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes.
    pub scenes: Vec<Scene>,
    /// The meshes of each.
    pub meshes: Vec<MeshKind>,
    /// The cells a side of each mesh.
    pub cells: Vec<u32>,
    /// How many runs go on at a time.
    pub threads: NonZero<usize>,
    /// The most visits of edges that a row may cost.
    pub visits_max: u64,
    /// How often each row that succeeded is run again for its time, after once to warm up; one after the
    /// other, scenes by turns.
    pub repeats: u32,
}

/// Visits that a row may cost unless one says otherwise: some seconds.
pub const VISITS_MAX: u64 = 200_000_000;

/// The experiment, made.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// How to read the file.
    pub schema: &'static str,
    /// Where it comes from.
    pub provenance: Provenance,
    /// What random numbers begin with.
    pub seed: u64,
    /// The most visits that a row might cost.
    pub visits_max: u64,
    /// How often rows were run again for their times.
    pub repeats: u32,
    /// Whether it was interrupted: what was not begun then stands as such.
    pub is_interrupted: bool,
    /// By scene, mesh and size.
    pub cases: Vec<CaseStudy>,
}

/// The cases of some options.
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

/// A guess at the visits of edges of all runs, before any is begun.
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

/// Makes the experiment. `clock` tells the CPU time of the thread that asks; without it there are no
/// times, and the same options give the same study. Everything ends at once where `stop` says so,
/// and what was not done stands as interrupted. `watch` hears of each run that is done, with the
/// guessed part of all work that has been done.
///
/// # Panics
///
/// Never: the scenes are data of our own.
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
    let mut studies = Vec::new();
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
                true
            },
        );
        let outcomes = outcomes.expect("nobody stops the list itself");
        studies.push(assess(case, &plan, &outcomes));
    }
    if options.repeats > 0 && clock.is_some() && !stop() {
        repeat(options, &cases, &mut studies, &bounds, |name, guess| {
            done += guess;
            watch(name, done / whole);
        });
    }
    Study {
        schema: "tearmesh.chart.pareto/1",
        provenance,
        seed: SEED,
        visits_max: options.visits_max,
        repeats: options.repeats,
        is_interrupted: stop(),
        cases: studies,
    }
}

/// Runs all rows that succeeded again and again, one after the other, scenes by turns: the first time to
/// warm up.
fn repeat(
    options: &Options,
    cases: &[Case],
    studies: &mut [CaseStudy],
    bounds: &Bounds<'_>,
    mut watch: impl FnMut(&str, f64),
) {
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
                    return;
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
}
