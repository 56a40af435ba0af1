//! What the runs of a case say: errors, fronts, and who is cheapest.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::NOISE_M;

use super::front::{Point, front, rising, vouched};
use super::method::{DEFAULT, Family, METHODS, PARTS};
use super::observable::Observable;
use super::observe::{Records, apart_m, distance, error};
use super::plan::{Planned, Role};
use super::run::{Cost, Outcome, Status};
use super::scene::Case;

/// The results of a case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CaseStudy {
    /// The name of the case: scene, mesh and number of cells.
    pub name: String,
    /// A short description of the scene.
    pub about: String,
    /// The number of particles.
    pub particles: usize,
    /// The number of edges.
    pub edges: usize,
    /// The distance of the two runs of the gate divided by the noise; `None` if they failed, did not run, or
    /// ended infinitely far apart.
    pub amplification: Option<f64>,
    /// Whether displacements are not compared, because noise grows too much or its growth is unknown.
    pub is_barred: bool,
    /// The runs of the references and of the gate.
    pub references: Vec<ReferenceRun>,
    /// The floor of each observable that is compared.
    pub floors: Vec<Floor>,
    /// The runs of the budget and those at default settings.
    pub rows: Vec<Row>,
    /// The cheapest rows for each observable and tolerance.
    pub cheapest: Vec<Cheapest>,
}

/// A run of a reference or of the gate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ReferenceRun {
    /// The name of the run, without the name of the case.
    pub name: String,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The step in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The cost of the run.
    pub cost: Cost,
}

/// The accuracy to which the true value of an observable is known.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Floor {
    /// The observable.
    pub observable: Observable,
    /// The relative distance between the two references, or the error that remains where rows end at rest,
    /// if that is larger. `None` if a reference has no value; then rows have no error.
    pub floor: Option<f64>,
}

/// The multiple of the floor below which errors are not distinguished.
pub const FLOORS: f64 = 10.0;

/// The result of one run: at a step of the planned range, or at default settings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// The name of the run: case, method with settings, and the fraction of the base step or `default`.
    pub run: String,
    /// The family of methods.
    pub family: Family,
    /// The name of the method with its settings.
    pub series: String,
    /// The fraction of the base step; `None` for a run at default settings.
    pub part: Option<f64>,
    /// Whether this is the run of the default method at default settings.
    pub is_default: bool,
    /// The step in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The simulated time, in seconds.
    pub simulated_s: f64,
    /// The cost of the run.
    pub cost: Cost,
    /// The smallest and the median CPU time of the repetitions, in seconds; `None` without repetitions.
    pub repeated_s: Option<[f64; 2]>,
    /// The errors of a run that succeeded, one per observable whose error is known.
    pub errors: Vec<Error>,
}

impl Row {
    /// Returns the error of the row for an observable; `None` if it is not known.
    #[must_use]
    pub fn error(&self, observable: Observable) -> Option<&Error> {
        let mut errors = self.errors.iter();
        errors.find(|error| error.observable == observable)
    }
}

/// The error of a run for one observable, in three parts. Errors are relative; smaller is better.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Error {
    /// The observable.
    pub observable: Observable,
    /// The distance of the run from the reference.
    pub total: f64,
    /// The distance of the reference from the method's limit as Δt → 0; `None` if no limit is known.
    pub model: Option<f64>,
    /// The distance of the run from that limit; `None` if no limit is known.
    pub discretisation: Option<f64>,
    /// The largest `total` of this and all shorter steps of the series, which is compared with tolerances.
    pub vouched: f64,
    /// Whether `total` exceeds that of a longer step by more than a tenth, and is above ten times the floor.
    pub is_rising: bool,
    /// Whether `total` is below ten times the floor, and so known no better than that.
    pub is_at_floor: bool,
    /// Whether the run is on the front of error against visits of edges.
    pub is_on_front: bool,
    /// Whether the run is on the front of error against CPU time; false if no time was measured.
    pub is_on_front_by_time: bool,
}

/// The cheapest rows of the budget that meet a tolerance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cheapest {
    /// The observable.
    pub observable: Observable,
    /// The largest relative error that is allowed.
    pub tolerance: f64,
    /// Whether the tolerance is at least ten times the floor. If not, there is no winner.
    pub is_known: bool,
    /// The row with the fewest visits of edges; `None` if no row meets the tolerance.
    pub winner: Option<Winner>,
    /// The row with the fewest visits of those of other families; `None` if there is none.
    pub runner_up: Option<Winner>,
    /// The row with the least CPU time; `None` if no row meets the tolerance or no time was measured.
    pub winner_by_time: Option<Winner>,
    /// The visits of the default method divided by those of the winner; `None` if either is missing.
    pub default_ratio: Option<f64>,
}

/// A row that meets a tolerance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Winner {
    /// The name of the run, without the name of the case.
    pub run: String,
    /// The family of methods.
    pub family: Family,
    /// The cost, in visits of edges or, by time, in seconds.
    pub cost: f64,
}

/// What is made or lost of energy below ten times this, as a part, is told as nothing.
const ENERGY_FLOOR: f64 = 1e-4;

/// The tolerances for [`Observable::Displacement`], as relative errors.
pub const FINE: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The tolerances for all other observables, as relative errors.
pub const COARSE: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// The largest amplification of noise at which displacements are compared.
pub const AMPLIFICATION_MAX: f64 = 1e3;

/// Computes the results of a case from its runs. `outcomes` must be in the order of `plan`.
#[must_use]
pub fn assess(case: &Case, plan: &[Planned], outcomes: &[Outcome]) -> CaseStudy {
    let both = || plan.iter().zip(outcomes);
    let of = |wanted: fn(&Role) -> bool| -> Vec<&Outcome> {
        let found = both().filter(|(planned, _)| wanted(&planned.role));
        found.map(|(_, outcome)| outcome).collect()
    };
    let verlet = extrapolated(&of(|role| matches!(role, Role::Verlet)));
    let newton = extrapolated(&of(|role| matches!(role, Role::Newton)));
    let rest = extrapolated(&of(|role| matches!(role, Role::Rest)));
    let gate = of(|role| matches!(role, Role::Gate { .. }));
    let amplification = match gate[..] {
        [calm, noisy] if [calm, noisy].iter().all(|run| run.status == Status::Ok) => {
            Some(apart_m(case, [&noisy.records, &calm.records]) / NOISE_M)
        }
        _ => None,
    };
    let amplification = amplification.filter(|grown| grown.is_finite());
    let is_gated = gate.len() == 2 && case.scene.observables.contains(&Observable::Displacement);
    // Written so that what is not known bars as well.
    let passes = amplification.is_some_and(|a| a <= AMPLIFICATION_MAX);
    let is_barred = is_gated && !passes;
    let observables = || {
        let all = case.scene.observables.iter().copied();
        all.filter(move |&o| !(is_barred && o == Observable::Displacement))
    };
    let floor = |observable: Observable| match (&verlet, &newton) {
        _ if observable.is_energy() => Some(ENERGY_FLOOR),
        (Some(verlet), Some(newton)) => {
            let apart = distance(case, observable, [verlet, newton], verlet)?;
            // And what is left where rows end at rest.
            let rest = rest
                .as_ref()
                .map(|rest| error(case, observable, rest, verlet));
            Some(apart.max(rest.unwrap_or(Some(0.0))?))
        }
        _ => None,
    };
    let floors: Vec<Floor> = observables()
        .map(|observable| Floor {
            observable,
            floor: floor(observable),
        })
        .collect();
    let nothing = Records::default();
    let reference = verlet.as_ref().unwrap_or(&nothing);
    let mut rows: Vec<Row> = Vec::new();
    for (planned, outcome) in both() {
        let limit = limit(plan, outcomes, &planned.role);
        let errors = floors.iter().filter_map(|known| {
            let floor = known.floor?;
            if outcome.status != Status::Ok {
                return None;
            }
            let observable = known.observable;
            let total = error(case, observable, &outcome.records, reference)?;
            let of_limit = limit.as_ref();
            Some(Error {
                observable,
                total,
                model: of_limit.and_then(|limit| error(case, observable, limit, reference)),
                discretisation: of_limit.and_then(|limit| {
                    distance(case, observable, [&outcome.records, limit], reference)
                }),
                vouched: total,
                is_rising: false,
                is_at_floor: total < FLOORS * floor,
                is_on_front: false,
                is_on_front_by_time: false,
            })
        });
        let Some((family, series, part, is_default)) = kind(&planned.role) else {
            continue;
        };
        rows.push(Row {
            run: format!("{}/{}", case.name(), planned.name),
            family,
            series: series.to_owned(),
            part,
            is_default,
            dt_s: outcome.dt_s.is_finite().then_some(outcome.dt_s),
            status: outcome.status,
            why: outcome.why.clone(),
            simulated_s: outcome.simulated_s,
            cost: outcome.cost,
            repeated_s: None,
            errors: errors.collect(),
        });
    }
    let references = both().filter(|(planned, _)| kind(&planned.role).is_none());
    let references = references.map(|(planned, outcome)| ReferenceRun {
        name: planned.name.clone(),
        status: outcome.status,
        why: outcome.why.clone(),
        dt_s: outcome.dt_s.is_finite().then_some(outcome.dt_s),
        cost: outcome.cost,
    });
    let mut study = CaseStudy {
        name: case.name(),
        about: case.scene.about.to_owned(),
        particles: case.sheet.points.len(),
        edges: case.sheet.edges.len(),
        amplification,
        is_barred,
        references: references.collect(),
        floors,
        rows,
        cheapest: Vec::new(),
    };
    study.rank();
    study
}

impl CaseStudy {
    /// Marks rising errors and rows on fronts, and finds the cheapest rows. A change of times needs a new
    /// call.
    pub fn rank(&mut self) {
        self.cheapest.clear();
        for known in self.floors.clone() {
            let Some(floor) = known.floor else {
                continue;
            };
            let observable = known.observable;
            self.mark_series(observable, floor);
            self.mark_front(observable, floor);
            let tolerances = if observable == Observable::Displacement {
                &FINE[..]
            } else {
                &COARSE[..]
            };
            for &tolerance in tolerances {
                let cheapest = self.cheapest_of(observable, tolerance, floor);
                self.cheapest.push(cheapest);
            }
        }
    }

    fn mark_series(&mut self, observable: Observable, floor: f64) {
        for method in METHODS {
            let is_of = |row: &&mut Row| row.series == method.name && row.part.is_some();
            let errors = self.rows.iter_mut().filter(is_of);
            let mut errors: Vec<&mut Error> = errors
                .filter_map(|row| row.errors.iter_mut().find(|e| e.observable == observable))
                .collect();
            // In the order of the budget, from the longest step to the shortest.
            let totals: Vec<f64> = errors.iter().map(|error| error.total).collect();
            let marks = vouched(&totals).into_iter().zip(rising(&totals));
            for (error, (vouched, is_rising)) in errors.iter_mut().zip(marks) {
                error.vouched = vouched;
                error.is_rising = is_rising && error.total > FLOORS * floor;
            }
        }
    }

    fn mark_front(&mut self, observable: Observable, floor: f64) {
        for by_time in [false, true] {
            let points: Vec<(usize, Point)> = self
                .rows
                .iter()
                .enumerate()
                .filter_map(|(i, row)| {
                    let error = row.error(observable).filter(|error| !error.is_rising)?;
                    let cost = row.cost_by(by_time)?;
                    // Below the floor nobody is better than another.
                    let error = error.total.max(FLOORS * floor);
                    Some((i, Point { cost, error }))
                })
                .collect();
            let bare: Vec<Point> = points.iter().map(|(_, point)| *point).collect();
            for ((i, _), is_on) in points.iter().zip(front(&bare)) {
                let mut errors = self.rows[*i].errors.iter_mut();
                if let Some(error) = errors.find(|error| error.observable == observable) {
                    if by_time {
                        error.is_on_front_by_time = is_on;
                    } else {
                        error.is_on_front = is_on;
                    }
                }
            }
        }
    }

    fn cheapest_of(&self, observable: Observable, tolerance: f64, floor: f64) -> Cheapest {
        let meets = |row: &Row| {
            let error = row.error(observable);
            error.is_some_and(|error| error.vouched <= tolerance)
        };
        let best = |by_time: bool, but: Option<Family>| -> Option<Winner> {
            let rows = self.rows.iter().filter(|row| row.part.is_some());
            let rows = rows.filter(|row| meets(row) && Some(row.family) != but);
            let costs = rows.filter_map(|row| Some((row.cost_by(by_time)?, row)));
            let (cost, row) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let run = row.run.rsplit('/').next().unwrap_or_default().to_owned();
            Some(Winner {
                run,
                family: row.family,
                cost,
            })
        };
        let is_known = tolerance >= FLOORS * floor;
        let winner = best(false, None).filter(|_| is_known);
        let runner_up = winner
            .as_ref()
            .and_then(|winner| best(false, Some(winner.family)));
        let default = self.rows.iter().find(|row| row.is_default && meets(row));
        let default_ratio = winner
            .as_ref()
            .and_then(|winner| Some(default?.cost.visits() as f64 / winner.cost));
        Cheapest {
            observable,
            tolerance,
            is_known,
            winner_by_time: best(true, None).filter(|_| is_known),
            winner,
            runner_up,
            default_ratio,
        }
    }
}

impl Row {
    /// Returns the visits of edges or, if `time` is true, the CPU time in seconds: the median of the
    /// repetitions, or the time of the single run. `None` if no time was measured.
    #[must_use]
    pub fn cost_by(&self, time: bool) -> Option<f64> {
        if time {
            self.repeated_s
                .map(|[_, median]| median)
                .or(self.cost.cpu_s)
        } else {
            Some(self.cost.visits() as f64)
        }
    }
}

/// The method of a row of the budget, its series, its part, and whether it is the default.
fn kind(role: &Role) -> Option<(Family, &'static str, Option<f64>, bool)> {
    match role {
        Role::Budget { method, part } => {
            let method = &METHODS[*method];
            Some((method.family, method.name, Some(PARTS[*part]), false))
        }
        Role::Named(named) => Some((named.family, named.name, None, named.name == DEFAULT)),
        Role::Verlet | Role::Newton | Role::Rest | Role::Gate { .. } => None,
    }
}

/// Richardson's extrapolation for order two of a run and one with half its step; a run to rest is as it
/// is. `None` where one failed.
fn extrapolated(runs: &[&Outcome]) -> Option<Records> {
    let is_usable = |run: &&&Outcome| run.status == Status::Ok;
    if runs.iter().filter(is_usable).count() < runs.len() {
        return None;
    }
    match runs {
        [run] => Some(run.records.clone()),
        [coarse, fine] => Some(Records::mixed(4.0 / 3.0, &fine.records, &coarse.records)),
        _ => None,
    }
}

/// Where the method of a row goes as Δt → 0, by the last two halvings of its series.
fn limit(plan: &[Planned], outcomes: &[Outcome], role: &Role) -> Option<Records> {
    let Role::Budget { method, .. } = role else {
        return None;
    };
    let at = |back: usize| {
        let wanted = PARTS.len() - back;
        let is_it = |planned: &Planned| match planned.role {
            Role::Budget { method: m, part } => m == *method && part == wanted,
            _ => false,
        };
        let run = &outcomes[plan.iter().position(is_it)?];
        (run.status == Status::Ok).then_some(&run.records)
    };
    Some(Records::limit([at(3)?, at(2)?, at(1)?]))
}
