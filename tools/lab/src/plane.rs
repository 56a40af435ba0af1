//! The plane of stiffness and mass ratio: the cost of each method at a fixed error, and the line along which
//! XPBD and Verlet's method cost the same.
//!
//! Each [`Place`] of the plane is the swing with springs of one stiffness, whose middle particle has a
//! fraction of its mass, as next to a cut. There, a few methods of [`pareto`](crate::pareto) run with the
//! same budget, references and gate. An [`Answer`] is the cheapest run of each family of methods that meets a
//! tolerance. Costs are visits of edges, which are the same on every machine.
//!
//! Two rules of the experiment on work against precision hold here as well: a tolerance below ten times the
//! floor is not answered, and a step meets a tolerance only if all shorter steps of its series that were run
//! do too.
//!
//! Verlet's method as shipped has light particles carried by their neighbours, so its step hardly depends on
//! the mass ratio; visits do not count the passes over carried particles. Plain Verlet takes a step that the
//! lightest particle allows.
//!
//! The steps of the budget end at twice the base step. A method whose cheapest run has that step may cost less
//! than is known ([`FamilyCost::is_at_most`]), so for stiff springs the costs of XPBD are upper bounds.
//!
//! A run ends when it has cost [`Options::cost_max`] times as much as Verlet's method with its base step at
//! the same place. A run whose steps and sweeps alone cost more is not begun.

mod csv;
mod job;
mod line;
mod place;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::csv::csv;
pub use self::line::{Crossing, Line};
pub use self::place::{Answer, Asked, FamilyCost, Place, QUESTIONS, Reference, Run, RunError};
pub use self::svg::svg;
pub use self::words::summary;

use std::num::NonZero;

use serde::{Deserialize, Serialize};

use self::job::Job;
use crate::pareto::{Bounds, METHODS, Status, assess};
use crate::parts::{Divided, Missing};
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The default stiffness values of the springs, in N/m.
pub const STIFFNESS_N_PER_M: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];

/// The default factors by which the mass of the middle particle is multiplied.
pub const MASS_RATIOS: [f64; 5] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4];

/// The names of the default methods, as in [`METHODS`].
pub const SERIES: [&str; 7] = [
    "verlet",
    "verlet-plain",
    "xpbd-1",
    "xpbd-4",
    "xpbd-10",
    "euler-back-100",
    "bdf2-100",
];

/// The default of [`Options::cost_max`].
pub const COST_MAX: f64 = 8.0;

/// The default number of cells along each side of the mesh.
pub const CELLS: u32 = 16;

/// The options of the experiment on the plane of stiffness and mass ratio.
#[derive(Clone, Debug)]
pub struct Options {
    /// The stiffness values of the springs, in N/m.
    pub stiffness_n_per_m: Vec<f64>,
    /// The factors by which the mass of the middle particle is multiplied; 1 for an even sheet.
    pub mass_ratios: Vec<f64>,
    /// The number of cells along each side of the mesh.
    pub cells: u32,
    /// The names of the methods, as in [`METHODS`]. Other names are ignored.
    pub methods: Vec<String>,
    /// The largest cost of a run, as a multiple of the estimated visits of edges of Verlet's method with its
    /// base step at the same place. References and the gate have no limit.
    pub cost_max: f64,
    /// The number of runs to execute at a time.
    pub threads: NonZero<usize>,
}

/// The results of the experiment on the plane of stiffness and mass ratio.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: String,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The number of cells along each side of the mesh, a grid with random diagonals.
    pub cells: u32,
    /// The names of the methods, as in [`METHODS`].
    pub methods: Vec<String>,
    /// The largest cost of a run, as a multiple of the estimated cost of Verlet's method with its base step
    /// at the same place.
    pub cost_max: f64,
    /// The results of each stiffness and mass ratio, ordered by stiffness, then by mass ratio from 1 down.
    pub places: Vec<Place>,
    /// The lines between XPBD and Verlet's method, by tolerance, opponent and mass ratio.
    pub lines: Vec<Line>,
    /// The parts whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

/// A part is a place, or several.
impl Divided for Study {
    const SCHEMA: &'static str = "tearmesh.chart.plane/1";

    fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn merged(parts: Vec<Study>, provenance: Provenance, missing: Vec<Missing>) -> Option<Study> {
        let mut parts = parts.into_iter();
        let mut whole = parts.next()?;
        whole.places.extend(parts.flat_map(|part| part.places));
        whole.conclude();
        Some(Study {
            provenance,
            missing,
            ..whole
        })
    }
}

impl Study {
    /// Orders the places and finds the lines between them. A change of `places` needs a new call.
    pub fn conclude(&mut self) {
        self.places.sort_by(|a, b| {
            let by_stiffness = a.stiffness_n_per_m.total_cmp(&b.stiffness_n_per_m);
            by_stiffness.then(b.mass_ratio.total_cmp(&a.mass_ratio))
        });
        self.lines = line::lines(&self.places);
    }
}

fn jobs(options: &Options) -> Vec<Job> {
    let known = METHODS.iter().map(|method| method.name);
    let methods: Vec<&str> = known
        .filter(|name| options.methods.iter().any(|wanted| wanted == name))
        .collect();
    let each = options.stiffness_n_per_m.iter().flat_map(|&stiffness| {
        let ratios = options.mass_ratios.iter();
        ratios.map(move |&ratio| (stiffness, ratio))
    });
    each.map(|place| Job::new(place, options.cells, &methods, options.cost_max))
        .collect()
}

/// Returns the number of runs, references included, and an estimate of their visits of edges.
///
/// # Panics
///
/// If `options.cells` is 0 or more than a mesh can have, or a stiffness or mass ratio is not a positive
/// number.
#[must_use]
pub fn expected(options: &Options) -> (usize, f64) {
    let jobs = jobs(options);
    let runs = jobs.iter().map(|job| job.plan.len()).sum();
    (runs, jobs.iter().map(Job::guess).sum())
}

/// Returns the name of a place in lists of missing parts and in the names of files, such as `1e3-1e-2`.
#[must_use]
pub fn place_name(stiffness_n_per_m: f64, mass_ratio: f64) -> String {
    format!("{stiffness_n_per_m:e}-{mass_ratio:e}")
}

/// Runs the experiment. The same options give the same study.
///
/// `watch` is called after each run with its name and the estimated fraction of all work that is done. When
/// `stop` returns true, all runs end as soon as possible, and places that were not finished are missing.
/// Returns `None` if that leaves no place.
///
/// # Panics
///
/// If `options.cells` is 0 or more than a mesh can have, or a stiffness or mass ratio is not a positive
/// number.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str, f64),
) -> Option<Study> {
    let jobs = jobs(options);
    let whole: f64 = jobs.iter().map(Job::guess).sum();
    let mut done = 0.0;
    let (mut places, mut missing) = (Vec::new(), Vec::new());
    for job in &jobs {
        let bounds = Bounds {
            visits_max: job.visits_max,
            clock: None,
            stop,
        };
        let outcomes = side_by_side(
            &job.plan,
            options.threads,
            |planned| job.guess_of(planned),
            |planned| job.carry_out(planned, &bounds),
            |i| {
                done += job.guess_of(&job.plan[i]);
                watch(&job.name_of(&job.plan[i]), done / whole);
            },
        );
        if outcomes.iter().any(|one| one.status == Status::Interrupted) {
            let (stiffness, ratio) = job.place;
            missing.push(Missing::interrupted(place_name(stiffness, ratio)));
            continue;
        }
        let case = assess(&job.case, &job.plan, &outcomes);
        places.push(Place::new(job.place, job.visits_max, &case));
    }
    if places.is_empty() && !missing.is_empty() {
        return None;
    }
    let mut study = Study {
        schema: Study::SCHEMA.to_owned(),
        provenance,
        cells: options.cells,
        methods: options.methods.clone(),
        cost_max: options.cost_max,
        places,
        lines: Vec::new(),
        missing,
    };
    study.conclude();
    Some(study)
}
