//! Work against precision: the cost and the error of each method, over the same budget of steps.
//!
//! A case is a scene on a mesh, with a stiffness and with a mass of its middle particle. It has four kinds of
//! runs: references by two methods that share no stepping code; a gate that tests whether trajectories can be
//! compared at all; the budget, in which every method runs at the same fractions of its base step; and one run
//! per method at its default settings.
//!
//! Errors are computed for several observables (`Observable`). Costs are visits of edges, which are the same
//! on every machine; what a visit takes depends on the method, and [`guide`](crate::guide) measures CPU time.
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
mod row;
mod run;
mod scene;

pub(crate) use self::row::FLOORS;
pub(crate) use self::row::Row;
pub(crate) use self::run::status_of;
pub(crate) use self::scene::{Observable, SCENES, Scene, fastest_m_per_s, middle};

use self::observe::{Records, apart_m, error, extrapolated};
use self::row::{Planned, Role};
use self::run::{plan, run};
use self::scene::Case;
use crate::ensemble::NOISE_M;
use crate::experiment::{Bounds, Experiment, Status};
use crate::sheet::MeshKind;

/// The options of the experiment on work against precision.
#[derive(Clone, Debug)]
pub struct Options {
    /// The names of the scenes to run, of [`scene_names`].
    pub scenes: Vec<String>,
    /// The kinds of meshes on which each scene runs.
    pub meshes: Vec<MeshKind>,
    /// The numbers of cells along each side of the meshes.
    pub cells: Vec<u32>,
    /// The stiffness values in N/m that replace that of each scene; empty to keep it.
    pub stiffness_n_per_m: Vec<f64>,
    /// The mass ratios of the middle particle that replace that of each scene; empty to keep it.
    pub mass_ratios: Vec<f64>,
    /// The largest number of visits of edges per row. References have no limit.
    pub visits_max: u64,
}

/// The default limit of [`Options::visits_max`], a few seconds of CPU time.
pub const VISITS_MAX: u64 = 200_000_000;

/// Returns the names of all scenes.
#[must_use]
pub fn scene_names() -> [&'static str; SCENES.len()] {
    SCENES.map(|scene| scene.name)
}

/// The CPU time of a visit of an edge in seconds, on the machine on which charts were first made.
pub(crate) const VISIT_S: f64 = 9e-9;

/// The largest amplification of noise at which displacements are compared.
pub(crate) const AMPLIFICATION_MAX: f64 = 1e3;

/// The error of energy below ten times which it counts as none.
const ENERGY_FLOOR: f64 = 1e-4;

/// The experiment on work against precision.
#[derive(Clone, Debug)]
pub struct Pareto {
    options: Options,
    cases: Vec<Case>,
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
        let is_wanted = |scene: &&Scene| options.scenes.iter().any(|name| name == scene.name);
        for scene in SCENES.iter().filter(is_wanted) {
            let stiffness = or_own(&options.stiffness_n_per_m, scene.stiffness_n_per_m);
            let ratios = or_own(&options.mass_ratios, scene.middle_mass_ratio);
            for (&mesh, &cells) in pairs(&options.meshes, &options.cells) {
                for (&stiffness, &ratio) in pairs(&stiffness, &ratios) {
                    let mut scene = *scene;
                    scene.stiffness_n_per_m = stiffness;
                    scene.middle_mass_ratio = ratio;
                    cases.push(Case::new(&scene, mesh, cells));
                }
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
    type Row = Row;

    fn plan(&self) -> Vec<Vec<Row>> {
        let cases = self.cases.iter().enumerate();
        cases.map(|(number, case)| plan(case, number)).collect()
    }

    fn guess_s(&self, key: &Row) -> f64 {
        let Planned { role, visits, .. } = key.planned;
        let limit = (!role.is_reference()).then_some(self.options.visits_max as f64);
        VISIT_S * visits.min(limit.unwrap_or(f64::INFINITY))
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let case = &self.cases[key.planned.case];
        Some(vec![run(case, key, self.options.visits_max, bounds)?])
    }

    fn assessed(&self, rows: Vec<Row>) -> Vec<Row> {
        compared(&self.cases[rows[0].planned.case], rows)
    }
}

/// Compares the runs of a case, and returns a row for each by each observable.
fn compared(case: &Case, runs: Vec<Row>) -> Vec<Row> {
    // The records of the runs with a role, extrapolated if there are two; `None` if one failed.
    let records = |role: Role| {
        let of = runs.iter().filter(|run| run.planned.role == role);
        let usable = of.map(|run| (run.status == Status::Ok).then_some(&run.records));
        match usable.collect::<Option<Vec<&Records>>>()?[..] {
            [run] => Some(run.clone()),
            [coarse, fine] => Some(extrapolated(coarse, fine)),
            _ => None,
        }
    };
    let [verlet, newton, rest] = [Role::Verlet, Role::Newton, Role::Rest].map(records);
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
    for mut row in runs {
        let records = std::mem::take(&mut row.records);
        row.planned = Planned::default();
        row.noise_amplification = noise_amplification;
        if row.status != Status::Ok || row.family.is_none() {
            rows.push(row);
            continue;
        }
        rows.extend(floors.iter().map(|&(observable, error_floor)| Row {
            observable: Some(observable),
            error_floor,
            error_total: error_floor.and(error(case, observable, &records, reference)),
            ..row.clone()
        }));
    }
    rows
}

#[cfg(test)]
mod tests;
