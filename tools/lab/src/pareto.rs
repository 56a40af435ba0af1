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
//!   does not count. An error that is larger than that of a longer step is on no front.
//! * A point dominates another if it is a tenth better in cost or in error, and no worse in the other.

mod chart;
mod front;
mod observe;
mod plan;
mod run;
mod scene;

pub use self::run::Outcome;
pub(crate) use self::run::status_of;
pub use self::scene::{
    Held, Observable, REST_M_PER_S, SCENES, Scene, Start, TEAR_RATIO, TOUGHNESS_J_PER_M, Until,
};
pub(crate) use self::scene::{fastest_m_per_s, middle};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::statistics::median;

use self::observe::{Records, apart_m, error, extrapolated};
use self::plan::{Planned, Role, plan};
use self::run::run;
use self::scene::Case;
use crate::experiment::{Bounds, Experiment, Status, list};
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

/// The multiple of the floor below which errors are not distinguished.
pub(crate) const FLOORS: f64 = 10.0;

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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
            let stiffness = or_own(&options.stiffness_n_per_m, scene.stiffness_n_per_m);
            let ratios = or_own(&options.mass_ratios, scene.middle_mass_ratio);
            for (&mesh, &cells) in pairs(&options.meshes, &options.cells) {
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
        // The first round also warms up. Repetitions of a run are not next to each other.
        let rounds = self.options.repeats.unwrap_or(0);
        let group = |(case, of): (usize, &Case)| {
            let (planned, mut keys) = (plan(of), Vec::new());
            for round in 0..=rounds {
                let is_in = |one: &&Planned| {
                    round == 0 || one.method().is_some() && one.visits <= visits_max
                };
                keys.extend(planned.iter().filter(is_in).map(|planned| Key {
                    case,
                    planned: planned.clone(),
                    round,
                }));
            }
            keys
        };
        self.cases.iter().enumerate().map(group).collect()
    }

    fn guess_s(&self, key: &Key) -> f64 {
        let most = match key.planned.is_reference() {
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
        rows
    }
}

/// Computes the rows of a case from its runs.
fn assess(case: &Case, keys: &[Key], outcomes: &[Option<Outcome>]) -> Vec<Row> {
    let runs = || keys.iter().map(|key| &key.planned).zip(outcomes);
    // The records of the runs with a role, extrapolated if there are two; `None` if one failed.
    let records = |role: Role| {
        let of = runs().filter(|(planned, _)| planned.role == role);
        let usable = of.map(|(_, outcome)| outcome.as_ref().filter(|run| run.status == Status::Ok));
        match usable.collect::<Option<Vec<&Outcome>>>()?[..] {
            [run] => Some(run.records.clone()),
            [coarse, fine] => Some(extrapolated(&coarse.records, &fine.records)),
            _ => None,
        }
    };
    let (verlet, newton, rest) = (
        records(Role::Verlet),
        records(Role::Newton),
        records(Role::Rest),
    );
    let gate = records(Role::Calm).zip(records(Role::Noisy));
    let noise_amplification = gate.map(|(calm, noisy)| apart_m(case, &noisy, &calm) / NOISE_M);
    let noise_amplification = noise_amplification.filter(|grown| grown.is_finite());
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
        let (method, step_fraction) = match planned.role {
            Role::Method(method, fraction) => (Some(method), fraction),
            _ => (None, None),
        };
        let run = outcome.as_ref();
        let row = Row {
            scene: case.scene.name.to_owned(),
            mesh: case.mesh,
            cells: case.cells,
            stiffness_n_per_m: case.scene.stiffness_n_per_m,
            mass_ratio: case.scene.middle_mass_ratio,
            run: planned.name.clone(),
            family: method.map(|method| method.family),
            method: method.map_or("reference", |method| method.name).to_owned(),
            step_fraction,
            status: run.map_or(Status::Interrupted, |run| run.status),
            dt_s: planned.dt_s,
            visits: run.map(|run| run.visits),
            cpu_median_s: run.and_then(|run| run.cpu_s),
            noise_amplification,
            why: run.map_or(String::new(), |run| run.why.clone()),
            ..Row::default()
        };
        let Some(run) = run.filter(|run| run.status == Status::Ok && method.is_some()) else {
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

#[cfg(test)]
mod tests;
