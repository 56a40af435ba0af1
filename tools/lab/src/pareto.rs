//! Work against precision: the cost and the error of each method, over the same budget of steps.
//!
//! A [`Case`] is a scene on a mesh, with a stiffness and with a mass of its middle particle. It has four kinds of
//! runs: references by two methods that share no stepping code; a gate that tests whether trajectories can be
//! compared at all; the budget, in which every method runs at the same fractions of its base step; and one run
//! per method at its default settings.
//!
//! Errors are computed for several observables ([`Observable`]). Each has three parts: the total error, that
//! of the method's limit as Δt → 0 (the *model* error), and the distance from that limit (the
//! *discretisation* error). Costs are visits of edges, which are the same on every machine, and CPU time if it
//! is measured.
//!
//! The rules for reading the numbers:
//!
//! * The distance between the two references is the *error floor*. An error below ten times the floor is known no
//!   better than that, and dominates no other error there.
//! * A step meets a tolerance if all shorter steps of its series do too. So a lucky zero crossing of the error
//!   does not count. An error that is larger than that of a longer step is marked and is on no front.
//! * A point dominates another if it is a tenth better in cost or in error, and no worse in the other.

mod chart;
mod observable;
mod observe;
mod plan;
mod run;
mod scene;

pub use self::observable::Observable;
pub use self::observe::Records;
pub use self::plan::{Planned, Role, plan};
pub(crate) use self::run::status_of;
pub use self::run::{CHECKPOINTS, Cost, ENERGY_MAX, Outcome};
pub(crate) use self::scene::middle;
pub use self::scene::{
    Case, Held, REST_M_PER_S, SCENES, Scene, Start, TEAR_RATIO, TOUGHNESS_J_PER_M, Until,
};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::statistics::median;

use self::observe::{apart_m, distance, error};
use crate::experiment::{Bounds, Experiment, Status, list};
use crate::front::{FLOORS, Point, converged, front, rising};
use crate::method::{DEFAULT, Family, METHODS, STEP_FRACTIONS};
use crate::sheet::MeshKind;

/// The options of the experiment on work against precision.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes to run.
    pub scenes: Vec<Scene>,
    /// The kinds of meshes on which each scene runs.
    pub meshes: Vec<MeshKind>,
    /// The numbers of cells along each side of the meshes.
    pub cells: Vec<u32>,
    /// The stiffness values in N/m that replace that of each scene; empty to keep it.
    pub stiffness_n_per_m: Vec<f64>,
    /// The mass ratios of the middle particle that replace that of each scene; empty to keep it.
    pub mass_ratios: Vec<f64>,
    /// The number of runs that may go on at a time.
    pub threads: NonZero<usize>,
    /// The largest number of visits of edges per row. References have no limit.
    pub visits_max: u64,
    /// The number of times that each run is repeated to measure its CPU time, after one more run to warm up;
    /// `None` to measure no times.
    pub repeats: Option<u32>,
}

/// The default limit of [`Options::visits_max`], a few seconds of CPU time.
pub const VISITS_MAX: u64 = 200_000_000;

/// The CPU time of a visit of an edge in seconds, on the machine on which charts were first made.
pub(crate) const VISIT_S: f64 = 9e-9;

/// The tolerances for [`Observable::Displacement`], as relative errors.
pub const FINE: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The tolerances for all other observables, as relative errors.
pub const COARSE: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// The largest amplification of noise at which displacements are compared.
pub const AMPLIFICATION_MAX: f64 = 1e3;

/// The error of energy below ten times which it counts as none.
const ENERGY_FLOOR: f64 = 1e-4;

/// The experiment on work against precision.
#[derive(Clone, Debug)]
pub struct Pareto {
    options: Options,
    cases: Vec<Case>,
}

/// A run of a case: in round 0 it is compared with the others, and in later rounds it is only timed.
#[derive(Clone, Debug)]
pub struct Key {
    case: usize,
    planned: Planned,
    round: u32,
}

/// An observable of a run. A run that failed has one row without an observable, and so have references and the
/// runs of the gate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The name of the scene.
    pub scene: String,
    /// The kind of mesh.
    pub mesh: MeshKind,
    /// The number of cells along each side.
    pub cells: u32,
    /// The stiffness of the edges, in N/m.
    pub stiffness_n_per_m: f64,
    /// The factor on the mass of the middle particle.
    pub mass_ratio: f64,
    /// The name of the run, such as `verlet@0.5` or `xpbd@default`.
    pub run: String,
    /// The family of methods; `None` for references and the gate.
    pub family: Option<Family>,
    /// The name of the method with its settings; `reference` for references and the gate.
    pub method: String,
    /// The step as a fraction of the base step; `None` at default settings.
    pub step_fraction: Option<f64>,
    /// Whether the run is the default method at its default settings.
    pub is_default: bool,
    /// The way in which the run ended.
    pub status: Status,
    /// The step, in seconds.
    pub dt_s: Option<f64>,
    /// The simulated time, in seconds.
    pub simulated_s: Option<f64>,
    /// The number of steps that succeeded.
    pub steps: Option<u64>,
    /// The number of visits of edges to project or shorten them.
    pub visits_project: Option<u64>,
    /// The number of visits of edges for forces, products with the matrix and frequencies.
    pub visits_force: Option<u64>,
    /// The number of visits of edges for other purposes.
    pub visits_other: Option<u64>,
    /// The smallest CPU time of the repetitions, in seconds.
    pub cpu_min_s: Option<f64>,
    /// The median CPU time of the repetitions in seconds, or the time of the only run.
    pub cpu_median_s: Option<f64>,
    /// The distance of the two runs of the gate divided by the noise; `None` if there is no gate or it failed.
    pub noise_amplification: Option<f64>,
    /// The observable.
    pub observable: Option<Observable>,
    /// The relative distance between the two references, or the error that remains where rows end at rest,
    /// if that is larger. `None` if a reference has no value, or if noise grows too much.
    pub error_floor: Option<f64>,
    /// The distance of the run from the reference.
    pub error_total: Option<f64>,
    /// The distance of the reference from the method's limit as Δt → 0; `None` if no limit is known.
    pub error_model: Option<f64>,
    /// The distance of the run from that limit; `None` if no limit is known.
    pub error_discretisation: Option<f64>,
    /// The largest `error_total` of this and all shorter steps of the method, which is compared with tolerances.
    pub error_converged: Option<f64>,
    /// Whether `error_total` exceeds that of a longer step by more than a tenth, and is above ten times the
    /// floor.
    pub is_rising: bool,
    /// Whether `error_total` is below ten times the floor, and so known no better than that.
    pub is_at_floor: bool,
    /// Whether the run is on the front of error against visits of edges.
    pub is_on_front: bool,
    /// Whether the run is on the front of error against CPU time; false if no time was measured.
    pub is_on_front_by_time: bool,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    /// Returns the number of visits of edges.
    #[must_use]
    pub fn visits(&self) -> Option<u64> {
        Some(self.visits_project? + self.visits_force? + self.visits_other?)
    }

    /// Returns the cost of the run: its CPU time in seconds or its visits of edges.
    #[must_use]
    pub fn cost(&self, by_time: bool) -> Option<f64> {
        match by_time {
            true => self.cpu_median_s,
            false => self.visits().map(|visits| visits as f64),
        }
    }

    fn case(&self) -> (&str, MeshKind, u32, u64, u64) {
        let [stiffness, ratio] = [self.stiffness_n_per_m, self.mass_ratio].map(f64::to_bits);
        (&self.scene, self.mesh, self.cells, stiffness, ratio)
    }
}

impl Pareto {
    /// Creates the experiment, with the cases ordered by scene, then by kind of mesh, size, stiffness and mass
    /// ratio.
    ///
    /// # Panics
    ///
    /// If a number of cells is 0 or more than a mesh can have.
    #[must_use]
    pub fn new(options: Options) -> Pareto {
        let mut cases = Vec::new();
        for scene in &options.scenes {
            for &mesh in &options.meshes {
                for &cells in &options.cells {
                    for scene in variants(scene, &options) {
                        cases.push(Case::new(&scene, mesh, cells));
                    }
                }
            }
        }
        Pareto { options, cases }
    }
}

/// The scene with each stiffness and each mass ratio.
fn variants(scene: &Scene, options: &Options) -> Vec<Scene> {
    let or_own = |values: &[f64], own: f64| match values {
        [] => vec![own],
        values => values.to_vec(),
    };
    let mut scenes = Vec::new();
    for stiffness_n_per_m in or_own(&options.stiffness_n_per_m, scene.stiffness_n_per_m) {
        for middle_mass_ratio in or_own(&options.mass_ratios, scene.middle_mass_ratio) {
            scenes.push(Scene {
                stiffness_n_per_m,
                middle_mass_ratio,
                ..*scene
            });
        }
    }
    scenes
}

impl Experiment for Pareto {
    type Key = Key;
    type Outcome = Outcome;
    type Row = Row;

    fn command(&self) -> String {
        let options = &self.options;
        let scenes = options.scenes.iter().map(|scene| scene.name);
        let mut command = format!(
            "tearmesh chart pareto --scene {} --mesh {} --size {}",
            list(scenes),
            list(options.meshes.iter().map(|mesh| mesh.name())),
            list(&options.cells),
        );
        let values = [
            ("--stiffness", &options.stiffness_n_per_m),
            ("--mass-ratio", &options.mass_ratios),
        ];
        for (name, values) in values.iter().filter(|(_, values)| !values.is_empty()) {
            command += &format!(" {name} {}", list(*values));
        }
        if options.visits_max != VISITS_MAX {
            command += &format!(" --visits-max {}", options.visits_max);
        }
        match options.repeats {
            Some(repeats) => command + &format!(" --time --repeats {repeats}"),
            None => command,
        }
    }

    fn is_timed(&self) -> bool {
        self.options.repeats.is_some()
    }

    fn threads(&self) -> NonZero<usize> {
        self.options.threads
    }

    fn plan(&self) -> Vec<Vec<Key>> {
        let rounds = match self.options.repeats {
            None | Some(0) => 0,
            // One to warm up.
            Some(repeats) => 1 + repeats,
        };
        let cases = self.cases.iter().enumerate();
        let groups = cases.map(|(number, case)| {
            let planned = plan(case);
            let of_round = |round: u32| {
                let timed = planned.iter().filter(move |planned| {
                    let is_row = matches!(planned.role, Role::Budget { .. } | Role::Default(_));
                    let is_affordable = planned.visits <= self.options.visits_max as f64;
                    round == 0 || (is_row && is_affordable)
                });
                timed.map(move |planned| Key {
                    case: number,
                    planned: planned.clone(),
                    round,
                })
            };
            (0..=rounds).flat_map(of_round).collect()
        });
        groups.collect()
    }

    fn round(&self, key: &Key) -> u32 {
        key.round
    }

    fn name(&self, key: &Key) -> String {
        format!("{}/{}", self.cases[key.case].name(), key.planned.name)
    }

    fn guess_s(&self, key: &Key) -> f64 {
        let most = match key.planned.role {
            Role::Verlet | Role::Newton => f64::INFINITY,
            _ => self.options.visits_max as f64,
        };
        VISIT_S * key.planned.visits.min(most)
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Outcome> {
        let case = &self.cases[key.case];
        let mut outcome = key.planned.run(case, self.options.visits_max, bounds)?;
        if key.round > 0 {
            outcome.records = Records::default();
        }
        Some(outcome)
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Outcome>>) -> Vec<Row> {
        let first = keys.iter().filter(|key| key.round == 0).count();
        let Some(key) = keys.first() else {
            return Vec::new();
        };
        let planned: Vec<&Planned> = keys[..first].iter().map(|key| &key.planned).collect();
        let mut rows = assess(&self.cases[key.case], &planned, &outcomes[..first]);
        // A warm-up and the times of an interruption tell nothing.
        let timed = keys.iter().zip(&outcomes).filter(|(key, _)| key.round > 1);
        let timed = timed.filter_map(|(key, outcome)| {
            let outcome = outcome.as_ref()?;
            Some((&key.planned.name, outcome.cost.cpu_s?))
        });
        let timed: Vec<(&String, f64)> = timed.collect();
        for row in &mut rows {
            let of = timed.iter().filter(|(name, _)| **name == row.run);
            let times: Vec<f64> = of.map(|(_, seconds)| *seconds).collect();
            if let Some(least) = times.iter().copied().reduce(f64::min) {
                (row.cpu_min_s, row.cpu_median_s) = (Some(least), median(times));
            }
        }
        rank(&mut rows);
        rows
    }
}

/// Computes the rows of a case from its runs, without fronts. `outcomes` must be in the order of `plan`.
fn assess(case: &Case, plan: &[&Planned], outcomes: &[Option<Outcome>]) -> Vec<Row> {
    let both = || plan.iter().zip(outcomes);
    let of = |wanted: fn(&Role) -> bool| -> Vec<Option<&Outcome>> {
        let found = both().filter(|(planned, _)| wanted(&planned.role));
        found.map(|(_, outcome)| outcome.as_ref()).collect()
    };
    let verlet = extrapolated(&of(|role| matches!(role, Role::Verlet)));
    let newton = extrapolated(&of(|role| matches!(role, Role::Newton)));
    let rest = extrapolated(&of(|role| matches!(role, Role::Rest)));
    let gate = of(|role| matches!(role, Role::Gate { .. }));
    let noise_amplification = match gate[..] {
        [Some(calm), Some(noisy)] if [calm, noisy].iter().all(|run| run.status == Status::Ok) => {
            let amplification = apart_m(case, [&noisy.records, &calm.records]) / NOISE_M;
            Some(amplification).filter(|amplification| amplification.is_finite())
        }
        _ => None,
    };
    // Written so that an unknown amplification bars as well.
    let passes = noise_amplification.is_some_and(|a| a <= AMPLIFICATION_MAX);
    let is_barred = gate.len() == 2 && !passes;
    let floor = |observable: Observable| match (&verlet, &newton) {
        _ if observable.is_energy() => Some(ENERGY_FLOOR),
        _ if is_barred && observable == Observable::Displacement => None,
        (Some(verlet), Some(newton)) => {
            let apart = distance(case, observable, [verlet, newton], verlet)?;
            // Rows end at a larger speed than references.
            let rest = rest
                .as_ref()
                .map(|rest| error(case, observable, rest, verlet));
            Some(apart.max(rest.unwrap_or(Some(0.0))?))
        }
        _ => None,
    };
    let observables = case.scene.observables.iter();
    let floors: Vec<(Observable, Option<f64>)> = observables.map(|&o| (o, floor(o))).collect();
    let nothing = Records::default();
    let reference = verlet.as_ref().unwrap_or(&nothing);
    let mut rows = Vec::new();
    for (planned, outcome) in both() {
        let row = Row {
            noise_amplification,
            ..plain_row(case, planned, outcome.as_ref())
        };
        let Some(outcome) = outcome else {
            rows.push(row);
            continue;
        };
        if row.family.is_none() || row.status != Status::Ok {
            rows.push(row);
            continue;
        }
        let limit = limit(plan, outcomes, &planned.role);
        for &(observable, error_floor) in &floors {
            let known = |records: &Records| {
                error_floor?;
                error(case, observable, records, reference)
            };
            let error_total = known(&outcome.records);
            let of_limit = limit.as_ref().filter(|_| error_total.is_some());
            rows.push(Row {
                observable: Some(observable),
                error_floor,
                error_total,
                error_model: of_limit.and_then(known),
                error_discretisation: of_limit.and_then(|limit| {
                    error_floor?;
                    distance(case, observable, [&outcome.records, limit], reference)
                }),
                error_converged: error_total,
                is_at_floor: is_below(error_total, error_floor),
                ..row.clone()
            });
        }
    }
    rows
}

fn is_below(error: Option<f64>, floor: Option<f64>) -> bool {
    error
        .zip(floor)
        .is_some_and(|(error, floor)| error < FLOORS * floor)
}

/// The row of a run without its errors.
fn plain_row(case: &Case, planned: &Planned, outcome: Option<&Outcome>) -> Row {
    let (family, method, step_fraction) = match &planned.role {
        Role::Budget { method, fraction } => {
            let method = &METHODS[*method];
            let fraction = STEP_FRACTIONS[*fraction];
            (Some(method.family), method.name, Some(fraction))
        }
        Role::Default(method) => (Some(method.family), method.name, None),
        Role::Verlet | Role::Newton | Role::Rest | Role::Gate { .. } => (None, "reference", None),
    };
    let cost = outcome.map(|outcome| outcome.cost);
    Row {
        scene: case.scene.name.to_owned(),
        mesh: case.mesh,
        cells: case.cells,
        stiffness_n_per_m: case.scene.stiffness_n_per_m,
        mass_ratio: case.scene.middle_mass_ratio,
        run: planned.name.clone(),
        family,
        method: method.to_owned(),
        step_fraction,
        is_default: matches!(planned.role, Role::Default(_)) && method == DEFAULT,
        status: outcome.map_or(Status::Interrupted, |outcome| outcome.status),
        dt_s: outcome.map(|outcome| outcome.dt_s),
        simulated_s: outcome.map(|outcome| outcome.simulated_s),
        steps: cost.map(|cost| cost.steps),
        visits_project: cost.map(|cost| cost.project),
        visits_force: cost.map(|cost| cost.force),
        visits_other: cost.map(|cost| cost.other),
        cpu_min_s: cost.and_then(|cost| cost.cpu_s),
        cpu_median_s: cost.and_then(|cost| cost.cpu_s),
        noise_amplification: None,
        observable: None,
        error_floor: None,
        error_total: None,
        error_model: None,
        error_discretisation: None,
        error_converged: None,
        is_rising: false,
        is_at_floor: false,
        is_on_front: false,
        is_on_front_by_time: false,
        why: outcome.map_or(String::new(), |outcome| outcome.why.clone()),
    }
}

/// Richardson's extrapolation for order two from a run and one with half its step; a run to rest as it is.
/// `None` if a run failed.
fn extrapolated(runs: &[Option<&Outcome>]) -> Option<Records> {
    let usable = |run: &Option<&Outcome>| run.is_some_and(|run| run.status == Status::Ok);
    if !runs.iter().all(usable) {
        return None;
    }
    match runs {
        [Some(run)] => Some(run.records.clone()),
        [Some(coarse), Some(fine)] => {
            Some(Records::mixed(4.0 / 3.0, &fine.records, &coarse.records))
        }
        _ => None,
    }
}

/// The limit of a method as Δt → 0, extrapolated from the last two halvings of its step.
fn limit(plan: &[&Planned], outcomes: &[Option<Outcome>], role: &Role) -> Option<Records> {
    let Role::Budget { method, .. } = role else {
        return None;
    };
    let at = |back: usize| {
        let wanted = STEP_FRACTIONS.len() - back;
        let is_it = |planned: &&Planned| match planned.role {
            Role::Budget {
                method: m,
                fraction,
            } => m == *method && fraction == wanted,
            _ => false,
        };
        let run = outcomes[plan.iter().position(is_it)?].as_ref()?;
        (run.status == Status::Ok).then_some(&run.records)
    };
    Some(Records::limit([at(3)?, at(2)?, at(1)?]))
}

/// Marks rising errors and the rows on fronts of a case.
fn rank(rows: &mut [Row]) {
    let mut observables: Vec<Observable> = rows.iter().filter_map(|row| row.observable).collect();
    observables.sort_unstable();
    observables.dedup();
    for observable in observables {
        let of = rows
            .iter_mut()
            .filter(|row| row.observable == Some(observable) && row.error_total.is_some());
        let mut of: Vec<&mut Row> = of.collect();
        for method in METHODS {
            // In the order of the budget, from the longest step to the shortest.
            let is_of =
                |row: &&mut &mut Row| row.method == method.name && row.step_fraction.is_some();
            let mut series: Vec<&mut &mut Row> = of.iter_mut().filter(is_of).collect();
            let totals: Vec<f64> = series.iter().filter_map(|row| row.error_total).collect();
            let marks = converged(&totals).into_iter().zip(rising(&totals));
            for (row, (converged, is_rising)) in series.iter_mut().zip(marks) {
                row.error_converged = Some(converged);
                row.is_rising = is_rising && !is_below(row.error_total, row.error_floor);
            }
        }
        for by_time in [false, true] {
            let points: Vec<(usize, Point)> = of
                .iter()
                .enumerate()
                .filter_map(|(i, row)| {
                    let cost = row.cost(by_time).filter(|_| !row.is_rising)?;
                    // Below the floor no error is better than another.
                    let error = row.error_total?.max(FLOORS * row.error_floor?);
                    Some((i, Point { cost, error }))
                })
                .collect();
            let bare: Vec<Point> = points.iter().map(|(_, point)| *point).collect();
            for ((i, _), is_on) in points.iter().zip(front(&bare)) {
                match by_time {
                    true => of[*i].is_on_front_by_time = is_on,
                    false => of[*i].is_on_front = is_on,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
