//! What the runs of a case say: errors, fronts, and who is cheapest.

use serde::Serialize;

use super::front::{Point, front, rising, vouched};
use super::method::{DEFAULT, Family, METHODS, PARTS};
use super::observable::Observable;
use super::observe::{Records, apart_m, distance, error};
use super::plan::{Planned, Role};
use super::run::{Cost, Outcome, Status};
use super::scene::Case;
use crate::ensemble::NOISE_M;

/// A case and all that is known of it.
#[derive(Clone, Debug, Serialize)]
pub struct CaseStudy {
    /// Its name: scene, mesh and cells.
    pub name: String,
    /// What happens in the scene.
    pub about: &'static str,
    /// How many particles there are.
    pub particles: usize,
    /// How many edges.
    pub edges: usize,
    /// By how much noise grows: metres over metres. `None` where nobody asked, or the runs failed.
    pub amplification: Option<f64>,
    /// Whether that bars displacements from being compared.
    pub is_barred: bool,
    /// The edges that tore first in both references, where that is what was asked.
    pub references: Vec<ReferenceRun>,
    /// By observable: what the two references differ by.
    pub floors: Vec<Floor>,
    /// Each run of the budget.
    pub rows: Vec<Row>,
    /// Who is cheapest, by observable and tolerance.
    pub cheapest: Vec<Cheapest>,
}

/// A run that references and the gate are made of.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceRun {
    /// Its name.
    pub name: String,
    /// How it ended.
    pub status: Status,
    /// Why, where it failed.
    pub why: String,
    /// Its step, in seconds.
    pub dt_s: f64,
    /// What it cost.
    pub cost: Cost,
}

/// How well the truth is known.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Floor {
    /// By what.
    pub observable: Observable,
    /// The distance of the two references, or what is left where rows end at rest, if that is more; `None` where one of them has no answer, so that there is
    /// none to hold rows against.
    pub floor: Option<f64>,
}

/// Errors below so many times the floor are told as being there.
pub const FLOORS: f64 = 10.0;

/// A run of the budget.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name: case, method and settings, and the part of its base step.
    pub run: String,
    /// The method whatever its settings.
    pub family: &'static str,
    /// The method and its settings.
    pub series: &'static str,
    /// The part of the base step; `None` of a row at the step that a scene chooses.
    pub part: Option<f64>,
    /// Whether it is what a user gets who names nothing.
    pub is_default: bool,
    /// The step, in seconds.
    pub dt_s: f64,
    /// How it ended.
    pub status: Status,
    /// Why, where it failed.
    pub why: String,
    /// The seconds that it simulated.
    pub simulated_s: f64,
    /// What it cost.
    pub cost: Cost,
    /// The CPU times of repetitions: the least and the median, in seconds.
    pub repeated_s: Option<[f64; 2]>,
    /// By observable, as far as they are known.
    pub errors: Vec<Error>,
}

impl Row {
    /// Its error by an observable.
    #[must_use]
    pub fn error(&self, observable: Observable) -> Option<&Error> {
        let mut errors = self.errors.iter();
        errors.find(|error| error.observable == observable)
    }

    /// Its method.
    #[must_use]
    pub fn family(&self) -> Option<Family> {
        let mut all = Family::ALL.into_iter();
        all.find(|family| family.name() == self.family)
    }
}

/// How far a run is off by an observable, in three parts.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Error {
    /// By what.
    pub observable: Observable,
    /// From the reference.
    pub total: f64,
    /// The reference from the limit that the method goes to as Δt → 0; `None` where it has none.
    pub model: Option<f64>,
    /// The run from that limit.
    pub discretisation: Option<f64>,
    /// The largest total of this and all shorter steps: what it can be relied on for.
    pub vouched: f64,
    /// Whether it is larger than that of a longer step.
    pub is_rising: bool,
    /// Whether it is below ten times the floor, and known no better than that.
    pub is_at_floor: bool,
    /// Whether it is on the front by visits of edges.
    pub is_on_front: bool,
    /// Whether it is on the front by CPU time, where that was taken.
    pub is_on_front_by_time: bool,
}

/// Who is cheapest of those that meet a tolerance.
#[derive(Clone, Debug, Serialize)]
pub struct Cheapest {
    /// By what.
    pub observable: Observable,
    /// The largest error that is allowed.
    pub tolerance: f64,
    /// Whether the references know the truth well enough to tell.
    pub is_known: bool,
    /// The run, and its visits of edges.
    pub winner: Option<Winner>,
    /// The cheapest of the other methods.
    pub runner_up: Option<Winner>,
    /// The winner by CPU time, where that was taken.
    pub winner_by_time: Option<Winner>,
    /// What the default costs over the winner, where it meets the tolerance.
    pub default_ratio: Option<f64>,
}

/// A run that meets a tolerance.
#[derive(Clone, Debug, Serialize)]
pub struct Winner {
    /// Its name, after the slash.
    pub run: String,
    /// Its method.
    pub family: &'static str,
    /// Its cost, by visits or by seconds.
    pub cost: f64,
}

/// What is made or lost of energy below ten times this, as a part, is told as nothing.
const ENERGY_FLOOR: f64 = 1e-4;

/// The tolerances of displacements.
pub const FINE: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Those of all else.
pub const COARSE: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// The amplification from which on displacements are barred.
pub const AMPLIFICATION_MAX: f64 = 1e3;

/// Makes of the runs of a case what they say.
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
            family: family.name(),
            series,
            part,
            is_default,
            dt_s: outcome.dt_s,
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
        dt_s: outcome.dt_s,
        cost: outcome.cost,
    });
    let mut study = CaseStudy {
        name: case.name(),
        about: case.scene.about,
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
    /// Marks errors that rise and rows on fronts, and finds who is cheapest; again where times were taken
    /// since.
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
        let best = |by_time: bool, but: Option<&str>| -> Option<Winner> {
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
    /// What it cost, by visits of edges or by the median of its CPU times, or the one that there is.
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
