//! Policies: what each pays where it always takes the same family of methods, and what it regrets.

use serde::{Deserialize, Serialize};

use super::trial::{Run, Trial};
use crate::pareto::{FLOORS, Family, METHODS, Status};

/// A way to choose a run in every task alike.
#[derive(Clone, Copy, Debug)]
pub struct Policy {
    /// The name in tables.
    pub name: &'static str,
    choice: Choice,
}

#[derive(Clone, Copy, Debug)]
enum Choice {
    /// The cheapest run of these families that meets the tolerance.
    Foresight(&'static [Family]),
    /// The run of this series at this part of its base step.
    Part(&'static str, f64),
    /// The run of this method at default settings.
    Default(&'static str),
}

/// All policies, with the two rivals of a planner first.
pub const POLICIES: [Policy; 9] = [
    policy("Verlet, best step", Choice::Foresight(&[Family::Verlet])),
    policy("XPBD, best step", Choice::Foresight(&[Family::Xpbd])),
    policy(
        "Verlet without guards, best step",
        Choice::Foresight(&[Family::Plain]),
    ),
    policy(
        "symplectic Euler, best step",
        Choice::Foresight(&[Family::Euler]),
    ),
    policy(
        "implicit, best step",
        Choice::Foresight(&[Family::BackwardEuler, Family::Bdf2]),
    ),
    policy(
        "Verlet, the step that suits it",
        Choice::Part("verlet", 0.5),
    ),
    policy("Verlet, default", Choice::Default("verlet")),
    policy("XPBD, default", Choice::Default("xpbd")),
    policy("implicit, default", Choice::Default("implicit")),
];

/// How many of [`POLICIES`] are the rivals of a planner.
const RIVALS: usize = 2;

/// The largest regret of a planner that is worth having, as a fraction of that of the better rival.
pub const PLANNER_SHARE: f64 = 0.8;

/// What a missed tolerance costs, as a multiple of the cost of always-Verlet or, where that misses it as
/// well, of the cheapest run.
pub const FAILURE: f64 = 10.0;

const fn policy(name: &'static str, choice: Choice) -> Policy {
    Policy { name, choice }
}

/// The errors that have to meet the tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Demand {
    /// All three: displacements, the forces in edges, and reactions.
    All,
    /// Displacements and reactions.
    Outside,
    /// The forces in edges.
    Force,
    /// Reactions.
    Reaction,
}

impl Demand {
    /// All demands, with that of the verdict first.
    pub const ALL: [Demand; 4] = [
        Demand::All,
        Demand::Outside,
        Demand::Force,
        Demand::Reaction,
    ];

    /// Returns the name of the demand in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Demand::All => "all three",
            Demand::Outside => "displacement and reaction",
            Demand::Force => "edge forces",
            Demand::Reaction => "reaction",
        }
    }

    /// Whether the error at this place of `OBSERVABLES` counts in a trial.
    fn counts(self, place: usize, trial: &Trial) -> bool {
        let is_asked = match self {
            Demand::All => true,
            Demand::Outside => place != 1,
            Demand::Force => place == 1,
            Demand::Reaction => place == 2,
        };
        is_asked && !(place == 0 && trial.is_barred())
    }

    fn is_met_by(self, run: &Run, trial: &Trial) -> bool {
        let meets = |error: Option<f64>| error.is_some_and(|e| e <= trial.task.tolerance);
        let mut errors = run.errors.iter().enumerate();
        run.status == Status::Ok
            && errors.all(|(place, &error)| !self.counts(place, trial) || meets(error))
    }
}

/// The comparison of the policies over all tasks.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ranking {
    /// The errors that had to meet the tolerance.
    pub demand: Demand,
    /// The tasks whose answer is known, in the order of the trials.
    pub standings: Vec<Standing>,
    /// The tasks whose answer is not known, in the order of the trials.
    pub unknown: Vec<Unknown>,
    /// The regret of each policy, in the order of [`POLICIES`]. Empty if no answer is known.
    pub regrets: Vec<Regret>,
    /// The largest regret with which a planner would be worth having; `None` if no answer is known.
    pub planner_max: Option<f64>,
}

/// A task whose answer is known: its cheapest run, and what each policy pays.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Standing {
    /// The number of the task.
    pub number: u32,
    /// The series of the cheapest run that meets the tolerance, of those that all shorter steps vouch for.
    pub series: String,
    /// The fraction of the base step of that run.
    pub part: Option<f64>,
    /// The visits of edges of that run.
    pub visits: u64,
    /// The cost of each policy over that of the cheapest run, in the order of [`POLICIES`].
    pub ratios: Vec<f64>,
    /// Whether each policy misses the tolerance, in the order of [`POLICIES`].
    pub is_missed: Vec<bool>,
}

impl Standing {
    /// Returns the family of the cheapest run; `None` if the name in `series` is unknown.
    #[must_use]
    pub fn family(&self) -> Option<Family> {
        family(&self.series)
    }
}

/// A task whose answer is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unknown {
    /// The number of the task.
    pub number: u32,
    /// The reason.
    pub why: Why,
}

/// The reasons why the answer of a task is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// A reference failed, or noise bars all that is compared.
    NoReference,
    /// The tolerance is below ten times the floor.
    BelowFloor,
    /// No run meets the tolerance.
    NobodyMeetsIt,
}

impl Why {
    /// Returns the reason in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Why::NoReference => "no reference",
            Why::BelowFloor => "tolerance below ten floors",
            Why::NobodyMeetsIt => "nobody meets the tolerance",
        }
    }
}

/// The regret of a policy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regret {
    /// The name of the policy.
    pub policy: String,
    /// The geometric mean of its cost over that of the cheapest run.
    pub regret: f64,
    /// The 95 % interval of the regret over tasks drawn alike, by the spread of the logarithms.
    pub interval: [f64; 2],
    /// The number of tasks in which it misses the tolerance.
    pub missed: usize,
}

/// Returns the comparison of the policies over these trials.
#[must_use]
pub fn rank(trials: &[Trial], demand: Demand) -> Ranking {
    let (mut standings, mut unknown) = (Vec::new(), Vec::new());
    for trial in trials {
        match stand(trial, demand) {
            Ok(standing) => standings.push(standing),
            Err(why) => unknown.push(Unknown {
                number: trial.task.number,
                why,
            }),
        }
    }
    let policies = POLICIES.iter().enumerate();
    let regrets: Vec<Regret> = policies
        .filter_map(|(place, policy)| Regret::of(policy, place, &standings))
        .collect();
    let rivals = regrets.iter().take(RIVALS).map(|rival| rival.regret);
    let planner_max = rivals.reduce(f64::min).map(|best| PLANNER_SHARE * best);
    Ranking {
        demand,
        standings,
        unknown,
        regrets,
        planner_max,
    }
}

fn stand(trial: &Trial, demand: Demand) -> Result<Standing, Why> {
    let places = 0..trial.floors.len();
    let counted: Vec<usize> = places.filter(|&i| demand.counts(i, trial)).collect();
    let floors = counted.iter().map(|&i| trial.floors[i]);
    let floors: Vec<f64> = floors.collect::<Option<_>>().ok_or(Why::NoReference)?;
    let floor = floors
        .into_iter()
        .reduce(f64::max)
        .ok_or(Why::NoReference)?;
    if trial.task.tolerance < FLOORS * floor {
        return Err(Why::BelowFloor);
    }
    let met = trial.runs.iter().filter(|run| demand.is_met_by(run, trial));
    let met: Vec<&Run> = met.collect();
    let best = cheapest(&met, |run| run.part.is_some()).ok_or(Why::NobodyMeetsIt)?;
    let cost = |run: Option<&Run>| run.map(|run| run.visits as f64 / best.visits as f64);
    let paid = POLICIES.map(|policy| cost(policy.pick(&met)));
    let failed = FAILURE * paid[0].unwrap_or(1.0);
    Ok(Standing {
        number: trial.task.number,
        series: best.series.clone(),
        part: best.part,
        visits: best.visits,
        ratios: paid.iter().map(|cost| cost.unwrap_or(failed)).collect(),
        is_missed: paid.iter().map(Option::is_none).collect(),
    })
}

impl Policy {
    /// The run that it takes of those that meet the tolerance.
    fn pick<'a>(&self, met: &[&'a Run]) -> Option<&'a Run> {
        cheapest(met, |run| match self.choice {
            Choice::Foresight(families) => {
                run.part.is_some() && family(&run.series).is_some_and(|f| families.contains(&f))
            }
            Choice::Part(series, part) => run.series == series && run.part == Some(part),
            Choice::Default(series) => run.series == series && run.part.is_none(),
        })
    }
}

fn cheapest<'a>(runs: &[&'a Run], is_wanted: impl Fn(&Run) -> bool) -> Option<&'a Run> {
    let wanted = runs.iter().copied().filter(|run| is_wanted(run));
    wanted.min_by_key(|run| run.visits)
}

fn family(series: &str) -> Option<Family> {
    let mut methods = METHODS.iter();
    let named = methods.find(|method| method.name == series);
    named.map(|method| method.family).or(match series {
        "xpbd" => Some(Family::Xpbd),
        "implicit" => Some(Family::BackwardEuler),
        _ => None,
    })
}

impl Regret {
    fn of(policy: &Policy, place: usize, standings: &[Standing]) -> Option<Regret> {
        if standings.is_empty() {
            return None;
        }
        let count = standings.len() as f64;
        let logs = || standings.iter().map(|standing| standing.ratios[place].ln());
        let mean = logs().sum::<f64>() / count;
        let square = logs().map(|log| (log - mean) * (log - mean)).sum::<f64>();
        let error = (square / (count - 1.0).max(1.0) / count).sqrt();
        let missed = standings
            .iter()
            .filter(|standing| standing.is_missed[place]);
        Some(Regret {
            policy: policy.name.to_owned(),
            regret: mean.exp(),
            interval: [mean - 1.96 * error, mean + 1.96 * error].map(f64::exp),
            missed: missed.count(),
        })
    }
}
