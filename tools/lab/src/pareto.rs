//! Work against precision: the cost and the error of each method, over the same budget of steps.
//!
//! A case is a scene on a mesh, with a stiffness and with a mass of its middle particle. It has four kinds of
//! runs: references by two methods that share no stepping code; a gate that tests whether trajectories can be
//! compared at all; the budget, in which every method runs at the same fractions of its base step; and one run
//! per method at its default settings.
//!
//! Errors are computed for several observables ([`Observable`]). Costs are visits of edges, which are the same
//! on every machine, and CPU time if it is measured.
//!
//! The rules for reading the numbers:
//!
//! * The distance between the two references is the *error floor*. An error below ten times the floor is known no
//!   better than that, and dominates no other error there.
//! * A step meets a tolerance if all shorter steps of its series do too. So a lucky zero crossing of the error
//!   does not count. An error that is larger than that of a longer step is marked and is on no front.
//! * A point dominates another if it is a tenth better in cost or in error, and no worse in the other.

mod chart;
mod observe;
mod plan;
mod run;
mod scene;

pub use self::run::Outcome;
pub(crate) use self::run::status_of;
pub(crate) use self::scene::middle;
pub use self::scene::{
    Held, Observable, REST_M_PER_S, SCENES, Scene, Start, TEAR_RATIO, TOUGHNESS_J_PER_M, Until,
};

use std::mem::discriminant;
use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::statistics::median;

use self::observe::{Records, apart_m, error, extrapolated};
use self::plan::{Planned, Role, plan};
use self::run::run;
use self::scene::Case;
use crate::experiment::{Bounds, Experiment, Status, list};
use crate::front::{FLOORS, Point, converged, front, rising};
use crate::method::{DEFAULT, Family};
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
    /// The number of times that each run is repeated to measure its CPU time; `None` to measure no times.
    pub repeats: Option<u32>,
}

/// The default limit of [`Options::visits_max`], a few seconds of CPU time.
pub const VISITS_MAX: u64 = 200_000_000;

/// The CPU time of a visit of an edge in seconds, on the machine on which charts were first made.
pub(crate) const VISIT_S: f64 = 9e-9;

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
    /// The way in which the run ended.
    pub status: Status,
    /// The step, in seconds.
    pub dt_s: f64,
    /// The number of visits of edges, for all purposes.
    pub visits: Option<u64>,
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
    /// The largest `error_total` of this and all shorter steps of the method, which is compared with tolerances.
    pub error_converged: Option<f64>,
    /// Whether `error_total` exceeds that of a longer step by more than a tenth, and is above ten times the
    /// floor.
    pub is_rising: bool,
    /// Whether the run is on the front of error against visits of edges.
    pub is_on_front: bool,
    /// Whether the run is on the front of error against CPU time; false if no time was measured.
    pub is_on_front_by_time: bool,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    /// Returns the cost of the run: its CPU time in seconds or its visits of edges.
    #[must_use]
    pub fn cost(&self, by_time: bool) -> Option<f64> {
        match by_time {
            true => self.cpu_median_s,
            false => self.visits.map(|visits| visits as f64),
        }
    }

    /// Returns whether the run is the default method at its default settings.
    #[must_use]
    pub fn is_default(&self) -> bool {
        self.method == DEFAULT && self.step_fraction.is_none()
    }

    /// Returns whether `error_total` is below ten times the floor, and so known no better than that.
    #[must_use]
    pub fn is_at_floor(&self) -> bool {
        let both = self.error_total.zip(self.error_floor);
        both.is_some_and(|(error, floor)| error < FLOORS * floor)
    }

    fn case(&self) -> (&str, MeshKind, u32, [f64; 2]) {
        let numbers = [self.stiffness_n_per_m, self.mass_ratio];
        (&self.scene, self.mesh, self.cells, numbers)
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
        let or_own = |values: &[f64], own: f64| match values {
            [] => vec![own],
            values => values.to_vec(),
        };
        let mut cases = Vec::new();
        for scene in &options.scenes {
            for (&mesh, &cells) in pairs(&options.meshes, &options.cells) {
                let stiffness = or_own(&options.stiffness_n_per_m, scene.stiffness_n_per_m);
                let ratios = or_own(&options.mass_ratios, scene.middle_mass_ratio);
                cases.extend(pairs(&stiffness, &ratios).map(|(&stiffness, &ratio)| {
                    let scene = Scene {
                        stiffness_n_per_m: stiffness,
                        middle_mass_ratio: ratio,
                        ..*scene
                    };
                    Case::new(&scene, mesh, cells)
                }));
            }
        }
        Pareto { options, cases }
    }
}

/// Each of `a` with each of `b`.
fn pairs<'a, A, B>(a: &'a [A], b: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    a.iter().flat_map(move |a| b.iter().map(move |b| (a, b)))
}

impl Experiment for Pareto {
    type Key = Key;
    type Outcome = Outcome;
    type Row = Row;

    fn command(&self) -> String {
        let options = &self.options;
        let mut command = format!(
            "tearmesh chart pareto --scene {} --mesh {} --size {}",
            list(options.scenes.iter().map(|scene| scene.name)),
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
        let visits_max = self.options.visits_max as f64;
        // The first round also warms up.
        let rounds = 0..=self.options.repeats.unwrap_or(0);
        let group = |(case, of): (usize, &Case)| {
            let planned = plan(of);
            let key = |round, planned: &Planned| Key {
                case,
                planned: planned.clone(),
                round,
            };
            let keys = rounds
                .clone()
                .flat_map(|round| planned.iter().map(move |one| key(round, one)));
            let is_timed = |one: &Planned| one.role.family().is_some() && one.visits <= visits_max;
            keys.filter(|key| key.round == 0 || is_timed(&key.planned))
                .collect()
        };
        self.cases.iter().enumerate().map(group).collect()
    }

    fn round(&self, key: &Key) -> u32 {
        key.round
    }

    fn name(&self, key: &Key) -> String {
        let case = &self.cases[key.case];
        let (scene, mesh) = (case.scene.name, case.mesh.name());
        format!("{scene}/{mesh}-{}/{}", case.cells, key.planned.name)
    }

    fn guess_s(&self, key: &Key) -> f64 {
        let most = match key.planned.role.is_reference() {
            true => f64::INFINITY,
            false => self.options.visits_max as f64,
        };
        VISIT_S * key.planned.visits.min(most)
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Outcome> {
        let case = &self.cases[key.case];
        let mut outcome = run(case, &key.planned, self.options.visits_max, bounds)?;
        if key.round > 0 {
            outcome.records = Records::new();
        }
        Some(outcome)
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Outcome>>) -> Vec<Row> {
        let case = &self.cases[keys[0].case];
        let first = keys.iter().filter(|key| key.round == 0).count();
        let mut rows = assess(case, &keys[..first], &outcomes[..first]);
        for row in &mut rows {
            let later = keys.iter().zip(&outcomes).skip(first);
            let own = later.filter(|(key, _)| key.planned.name == row.run);
            let times = own.filter_map(|(_, outcome)| outcome.as_ref()?.cpu_s);
            row.cpu_median_s = median(times.collect()).or(row.cpu_median_s);
        }
        for observable in case.scene.observables {
            rank(&mut rows, *observable);
        }
        rows
    }
}

/// Computes the rows of a case from its runs, without fronts.
fn assess(case: &Case, keys: &[Key], outcomes: &[Option<Outcome>]) -> Vec<Row> {
    let runs = || keys.iter().map(|key| &key.planned).zip(outcomes);
    // The records of all runs with a role; `None` if one failed.
    let records = |role: &Role| -> Option<Vec<&Records>> {
        let of = runs().filter(|(planned, _)| discriminant(&planned.role) == discriminant(role));
        let usable = of.map(|(_, outcome)| outcome.as_ref().filter(|run| run.status == Status::Ok));
        usable.map(|run| Some(&run?.records)).collect()
    };
    let reference = |role: Role| match records(&role)?[..] {
        [run] => Some(run.clone()),
        [coarse, fine] => Some(extrapolated(coarse, fine)),
        _ => None,
    };
    let (verlet, newton) = (reference(Role::Verlet), reference(Role::Newton));
    let rest = reference(Role::Rest);
    let noise_amplification = match records(&Role::Gate(false)).as_deref() {
        Some([calm, noisy]) => {
            let amplification = apart_m(case, noisy, calm) / NOISE_M;
            Some(amplification).filter(|amplification| amplification.is_finite())
        }
        _ => None,
    };
    // Written so that an unknown amplification bars as well.
    let passes = noise_amplification.is_some_and(|grown| grown <= AMPLIFICATION_MAX);
    let is_barred = case.is_gated() && !passes;
    let floor = |observable: Observable| match (&verlet, &newton) {
        _ if observable.is_energy() => Some(ENERGY_FLOOR),
        _ if is_barred && observable == Observable::Displacement => None,
        (Some(verlet), Some(newton)) => {
            let of = |run: &Records| error(case, observable, run, verlet);
            // Rows end at a larger speed than references.
            Some(of(newton)?.max(rest.as_ref().map_or(Some(0.0), of)?))
        }
        _ => None,
    };
    let observables = case.scene.observables.iter();
    let floors: Vec<(Observable, Option<f64>)> = observables.map(|&o| (o, floor(o))).collect();
    let reference = verlet.as_ref().unwrap_or(const { &Records::new() });
    let mut rows = Vec::new();
    for (planned, outcome) in runs() {
        let row = plain_row(case, planned, outcome.as_ref(), noise_amplification);
        let usable = outcome.as_ref().filter(|run| run.status == Status::Ok);
        let Some(run) = usable.filter(|_| row.family.is_some()) else {
            rows.push(row);
            continue;
        };
        rows.extend(floors.iter().map(|&(observable, error_floor)| Row {
            observable: Some(observable),
            error_floor,
            error_total: error_floor.and(error(case, observable, &run.records, reference)),
            ..row.clone()
        }));
    }
    rows
}

/// The row of a run without its errors.
fn plain_row(
    case: &Case,
    planned: &Planned,
    outcome: Option<&Outcome>,
    noise_amplification: Option<f64>,
) -> Row {
    let (method, step_fraction) = match &planned.role {
        Role::Budget(method, fraction) => (method.name, Some(*fraction)),
        Role::Default(method) => (method.name, None),
        Role::Verlet | Role::Newton | Role::Rest | Role::Gate(_) => ("reference", None),
    };
    Row {
        scene: case.scene.name.to_owned(),
        mesh: case.mesh,
        cells: case.cells,
        stiffness_n_per_m: case.scene.stiffness_n_per_m,
        mass_ratio: case.scene.middle_mass_ratio,
        run: planned.name.clone(),
        family: planned.role.family(),
        method: method.to_owned(),
        step_fraction,
        status: outcome.map_or(Status::Interrupted, |outcome| outcome.status),
        dt_s: planned.dt_s,
        visits: outcome.map(|outcome| outcome.visits),
        cpu_median_s: outcome.and_then(|outcome| outcome.cpu_s),
        noise_amplification,
        observable: None,
        error_floor: None,
        error_total: None,
        error_converged: None,
        is_rising: false,
        is_on_front: false,
        is_on_front_by_time: false,
        why: outcome.map_or(String::new(), |outcome| outcome.why.clone()),
    }
}

/// Marks rising errors and the rows on fronts of a case, by an observable.
fn rank(rows: &mut [Row], observable: Observable) {
    let known = |row: &&mut Row| row.observable == Some(observable) && row.error_total.is_some();
    let mut rows: Vec<&mut Row> = rows.iter_mut().filter(known).collect();
    // The steps of a method, from the longest to the shortest.
    for series in rows.chunk_by_mut(|a, b| a.method == b.method) {
        let totals: Vec<f64> = series.iter().filter_map(|row| row.error_total).collect();
        let marks = converged(&totals).into_iter().zip(rising(&totals));
        for (row, (converged, is_rising)) in series.iter_mut().zip(marks) {
            row.error_converged = Some(converged);
            row.is_rising = is_rising && !row.is_at_floor();
        }
    }
    for by_time in [false, true] {
        let point = |row: &Row| {
            let cost = row.cost(by_time).filter(|_| !row.is_rising)?;
            // Below the floor no error is better than another.
            let error = row.error_total?.max(FLOORS * row.error_floor?);
            Some(Point { cost, error })
        };
        let points: Vec<Point> = rows.iter().filter_map(|row| point(row)).collect();
        let ranked = rows.iter_mut().filter(|row| point(row).is_some());
        for (row, is_on) in ranked.zip(front(&points)) {
            match by_time {
                true => row.is_on_front_by_time = is_on,
                false => row.is_on_front = is_on,
            }
        }
    }
}

#[cfg(test)]
mod tests;
