//! A task carried out by every candidate at every step: what each costs, and how far it is off.

use serde::{Deserialize, Serialize};

use super::task::{OBSERVABLES, Task};
use crate::pareto::{
    AMPLIFICATION_MAX, Bounds, CaseStudy, Cost, METHODS, Outcome, Planned, Role, Status, assess,
    plan,
};

/// The series of methods that a planner could choose from: all with a time step of their own that the
/// library ships.
pub const CANDIDATES: [&str; 12] = [
    "verlet",
    "verlet-plain",
    "xpbd-1",
    "xpbd-2",
    "xpbd-4",
    "xpbd-10",
    "euler-back-10",
    "euler-back-100",
    "euler-back-1000",
    "bdf2-10",
    "bdf2-100",
    "euler",
];

/// The methods that also run at the settings that users get if they choose none.
pub const DEFAULTS: [&str; 3] = ["verlet", "xpbd", "implicit"];

/// The largest cost of a run of a candidate, as a multiple of Verlet's at its base step. Verlet's shortest
/// step costs sixteen; a policy that costs ten times the cheapest has failed anyway.
pub const COST_MAX: f64 = 20.0;

/// The results of a task.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Trial {
    /// The task.
    pub task: Task,
    /// The number of edges of the mesh.
    pub edges: usize,
    /// The time in which a pull travels an edge of mean length, in seconds.
    pub edge_s: f64,
    /// The growth of noise over the scene; `None` if the runs that measure it failed.
    pub amplification: Option<f64>,
    /// The floors of [`OBSERVABLES`], which tell how well the true values are known: the relative distances
    /// between two references. `None` if a reference failed, or if noise bars the comparison.
    pub floors: [Option<f64>; 3],
    /// The failures of the references, each with its name, its status and its reason. With any of them the
    /// true values are unknown.
    pub unsolved: Vec<String>,
    /// The visits of edges of the references and of the runs that measure the growth of noise.
    pub reference_visits: u64,
    /// The runs of the candidates, and then those at default settings.
    pub runs: Vec<Run>,
}

/// A run of a task by a candidate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Run {
    /// The name of the method with its settings.
    pub series: String,
    /// The fraction of the base step; `None` for a run at default settings.
    pub part: Option<f64>,
    /// The step, in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The way in which the run ended.
    pub status: Status,
    /// The visits of edges.
    pub visits: u64,
    /// The relative errors of [`OBSERVABLES`], each the largest of this step and all shorter ones of the
    /// series that succeeded; `None` if the run failed or the error is unknown.
    pub errors: [Option<f64>; 3],
}

impl Trial {
    /// Returns whether displacements are not compared because noise grows too much, or by nobody knows how
    /// much.
    #[must_use]
    pub fn is_barred(&self) -> bool {
        self.amplification.is_none_or(|a| a > AMPLIFICATION_MAX)
    }
}

impl Task {
    /// Carries out the task by all candidates. Returns `None` soon after `stop` returns true.
    ///
    /// # Panics
    ///
    /// If a number of the task is outside the range from which it is drawn.
    #[must_use]
    pub fn carry_out(&self, stop: &(dyn Fn() -> bool + Sync)) -> Option<Trial> {
        let case = self.case();
        let plan: Vec<Planned> = plan(&case).into_iter().filter(is_wanted).collect();
        let base = plan.iter().find(|planned| planned.name == "verlet@1");
        let visits_max = COST_MAX * base.expect("Verlet is a candidate").guess;
        let bounds = Bounds {
            visits_max: visits_max as u64,
            clock: None,
            stop,
        };
        let mut outcomes = Vec::new();
        for planned in &plan {
            if stop() {
                return None;
            }
            let is_too_dear = matches!(planned.role, Role::Budget { .. })
                && !is_implicit(planned)
                && planned.guess > visits_max;
            outcomes.push(match is_too_dear {
                true => too_dear(),
                false => planned.carry_out(&case, &bounds),
            });
        }
        let study = assess(&case, &plan, &outcomes);
        (!stop()).then(|| self.of(&study, case.edge_s()))
    }

    fn of(&self, study: &CaseStudy, edge_s: f64) -> Trial {
        let floor = |observable| {
            let mut floors = study.floors.iter();
            floors.find(|floor| floor.observable == observable)?.floor
        };
        let references = study.references.iter();
        let unsolved = references
            .clone()
            .filter(|run| run.status != Status::Ok && run.name.starts_with("reference"))
            .map(|run| format!("{}: {}, {}", run.name, run.status.name(), run.why));
        Trial {
            task: self.clone(),
            edges: study.edges,
            edge_s,
            amplification: study.amplification,
            floors: OBSERVABLES.map(floor),
            unsolved: unsolved.collect(),
            reference_visits: references.map(|run| run.cost.visits()).sum(),
            runs: study.rows.iter().map(Run::of).collect(),
        }
    }
}

impl Run {
    fn of(row: &crate::pareto::Row) -> Run {
        let error = |observable| row.error(observable).map(|error| error.vouched);
        Run {
            series: row.series.to_owned(),
            part: row.part,
            dt_s: row.dt_s,
            status: row.status,
            visits: row.cost.visits(),
            errors: OBSERVABLES.map(error),
        }
    }
}

fn is_wanted(planned: &Planned) -> bool {
    match &planned.role {
        Role::Budget { method, .. } => CANDIDATES.contains(&METHODS[*method].name),
        Role::Named(named) => DEFAULTS.contains(&named.name),
        Role::Verlet | Role::Newton | Role::Rest | Role::Gate { .. } => true,
    }
}

/// Whether nobody knows what it costs before it is done.
fn is_implicit(planned: &Planned) -> bool {
    planned.name.starts_with("euler-back") || planned.name.starts_with("bdf2")
}

/// What is not begun, as its visits are known and too many.
fn too_dear() -> Outcome {
    Outcome {
        status: Status::TooDear,
        cost: Cost::default(),
        ..Outcome::interrupted()
    }
}
