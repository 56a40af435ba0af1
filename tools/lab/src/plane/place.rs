//! The results at a place of the plane: its runs, and the cheapest run of each family that meets a tolerance.

use serde::{Deserialize, Serialize};

use crate::pareto::{CaseStudy, FLOORS, Family, Observable, PARTS, Row, Status};

/// A tolerance of an observable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// The observable.
    pub observable: Observable,
    /// The largest relative error that is allowed.
    pub tolerance: f64,
}

/// The tolerances for which the plane is drawn: the largest force at the held particles within 5 %, and
/// displacements within 1 %.
pub const QUESTIONS: [Asked; 2] = [
    Asked {
        observable: Observable::ReactionLargest,
        tolerance: 0.05,
    },
    Asked {
        observable: Observable::Displacement,
        tolerance: 0.01,
    },
];

/// The results at one stiffness and one mass ratio.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Place {
    /// The stiffness of the springs, in N/m.
    pub stiffness_n_per_m: f64,
    /// The factor by which the mass of the middle particle is multiplied.
    pub mass_ratio: f64,
    /// The largest number of visits of edges that a run was allowed. References and the gate have no limit.
    pub visits_max: u64,
    /// The distance of the two runs of the gate divided by the noise; `None` if they failed.
    pub amplification: Option<f64>,
    /// The runs of the references and of the gate.
    pub references: Vec<Reference>,
    /// The runs of the budget and those at default settings, however they ended.
    pub runs: Vec<Run>,
    /// The answer to each of [`QUESTIONS`].
    pub answers: Vec<Answer>,
}

/// A run of a reference or of the gate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reference {
    /// The name of the run.
    pub run: String,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The number of steps that succeeded.
    pub steps: u64,
    /// The number of visits of edges.
    pub visits: u64,
}

/// The result of one run: at a step of the budget, or at default settings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Run {
    /// The name of the run: the method with its settings, and the fraction of the base step or `default`.
    pub run: String,
    /// The name of the method with its settings.
    pub series: String,
    /// The family of methods.
    pub family: Family,
    /// The fraction of the base step; `None` for a run at default settings.
    pub part: Option<f64>,
    /// The step, in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if the run was not begun, a step failed, or the energy grew too much; otherwise empty.
    pub why: String,
    /// The number of steps that succeeded.
    pub steps: u64,
    /// The number of visits of edges.
    pub visits: u64,
    /// The errors of a run that succeeded, one per observable whose error is known.
    pub errors: Vec<RunError>,
}

impl Run {
    /// Returns whether the run and all shorter steps of its series meet a tolerance.
    fn meets(&self, asked: Asked) -> bool {
        let mut errors = self.errors.iter();
        let error = errors.find(|error| error.observable == asked.observable);
        error.is_some_and(|error| error.vouched <= asked.tolerance)
    }
}

/// The relative error of a run.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct RunError {
    /// The observable.
    pub observable: Observable,
    /// The distance of the run from the reference.
    pub total: f64,
    /// The largest `total` of this and all shorter steps of the series, which is compared with tolerances.
    pub vouched: f64,
}

/// The cost of each family at a tolerance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Answer {
    /// The tolerance.
    pub asked: Asked,
    /// The floor of the observable: the relative distance between the two references. `None` if the
    /// observable is barred or a reference has no value.
    pub floor: Option<f64>,
    /// Whether displacements are not compared, because noise grows too much or its growth is unknown.
    pub is_barred: bool,
    /// Whether the tolerance is at least ten times the floor. If not, no family has a cost.
    pub is_known: bool,
    /// One entry per family of the methods, in the order of [`Family::ALL`].
    pub costs: Vec<FamilyCost>,
}

/// The cheapest run of a family that meets a tolerance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FamilyCost {
    /// The family of methods.
    pub family: Family,
    /// The visits of edges of the cheapest run; `None` if no run meets the tolerance.
    pub visits: Option<u64>,
    /// The name of the cheapest run; `None` if no run meets the tolerance.
    pub run: Option<String>,
    /// Whether the cheapest run has the longest step of the budget, so that a longer one may cost less.
    pub is_at_most: bool,
    /// Whether a run of the family was given up because of its cost, so that a shorter step may meet the
    /// tolerance if none of the others does.
    pub is_cut_short: bool,
}

impl Place {
    /// Reads the results of a place from those of its case.
    pub(super) fn new(
        (stiffness_n_per_m, mass_ratio): (f64, f64),
        visits_max: u64,
        case: &CaseStudy,
    ) -> Place {
        let references = case.references.iter().map(|of| Reference {
            run: of.name.clone(),
            status: of.status,
            why: of.why.clone(),
            steps: of.cost.steps,
            visits: of.cost.visits(),
        });
        let runs: Vec<Run> = case.rows.iter().map(told).collect();
        Place {
            stiffness_n_per_m,
            mass_ratio,
            visits_max,
            amplification: case.amplification.filter(|a| a.is_finite()),
            references: references.collect(),
            answers: QUESTIONS
                .map(|asked| Answer::new(asked, case, &runs))
                .into(),
            runs,
        }
    }

    /// Returns the answer for an observable; `None` if it was not asked.
    #[must_use]
    pub fn answer(&self, observable: Observable) -> Option<&Answer> {
        let mut all = self.answers.iter();
        all.find(|answer| answer.asked.observable == observable)
    }
}

fn told(row: &Row) -> Run {
    let errors = row.errors.iter().map(|error| RunError {
        observable: error.observable,
        total: error.total,
        vouched: error.vouched,
    });
    Run {
        run: row.run.rsplit('/').next().unwrap_or_default().to_owned(),
        series: row.series.clone(),
        family: row.family,
        part: row.part,
        dt_s: row.dt_s,
        status: row.status,
        why: row.why.clone(),
        steps: row.cost.steps,
        visits: row.cost.visits(),
        errors: errors.collect(),
    }
}

impl Answer {
    fn new(asked: Asked, case: &CaseStudy, runs: &[Run]) -> Answer {
        let mut floors = case.floors.iter();
        let found = floors.find(|floor| floor.observable == asked.observable);
        let floor = found.and_then(|found| found.floor);
        let is_known = floor.is_some_and(|floor| asked.tolerance >= FLOORS * floor);
        let has_run = |family: &Family| runs.iter().any(|run| run.family == *family);
        let families = Family::ALL.into_iter().filter(has_run);
        Answer {
            asked,
            floor,
            is_barred: case.is_barred && asked.observable == Observable::Displacement,
            is_known,
            costs: families
                .map(|family| FamilyCost::new(family, asked, is_known, runs))
                .collect(),
        }
    }

    /// Returns the visits of edges of a family; `None` if no run of it meets the tolerance.
    #[must_use]
    pub fn visits(&self, family: Family) -> Option<u64> {
        self.cost(family)?.visits
    }

    /// Returns the cost of a family; `None` if it has no runs.
    #[must_use]
    pub fn cost(&self, family: Family) -> Option<&FamilyCost> {
        self.costs.iter().find(|cost| cost.family == family)
    }

    /// Returns the family with the fewest visits of edges; `None` if no run meets the tolerance.
    #[must_use]
    pub fn winner(&self) -> Option<&FamilyCost> {
        let met = self.costs.iter().filter(|cost| cost.visits.is_some());
        met.min_by_key(|cost| cost.visits)
    }

    /// Returns the visits of one family divided by those of another; `None` if either is missing.
    #[must_use]
    pub fn ratio(&self, of: Family, to: Family) -> Option<f64> {
        Some(self.visits(of)? as f64 / self.visits(to)? as f64)
    }
}

impl FamilyCost {
    pub(super) fn new(family: Family, asked: Asked, is_known: bool, runs: &[Run]) -> FamilyCost {
        let own = || {
            let of = move |run: &&Run| run.family == family && run.part.is_some();
            runs.iter().filter(of)
        };
        let met = own().filter(|run| is_known && run.meets(asked));
        let cheapest = met.min_by_key(|run| run.visits);
        FamilyCost {
            family,
            visits: cheapest.map(|run| run.visits),
            run: cheapest.map(|run| run.run.clone()),
            is_at_most: cheapest.is_some_and(|run| run.part == Some(PARTS[0])),
            is_cut_short: own().any(|run| run.status == Status::TooDear),
        }
    }
}
