//! One run: a method takes a scene to its end, and what was asked of it is noted on the way.
//!
//! A run that does not get there has a status that says why, and what it had cost until then.

use std::time::Duration;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::{Solver, StepError, System, Visits, energy, force};

use super::method::Store;
use super::observe::{Probe, Records};
use super::scene::{Case, Until};

/// The ways in which a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The run reached its end.
    Ok,
    /// A step was refused, at the start or later.
    Refused,
    /// The energy exceeded [`ENERGY_MAX`] times the energy put in, or a number was infinite, NaN or too
    /// large.
    BlownUp,
    /// The equations of an implicit step were not solved.
    Unsolved,
    /// The time of the scene passed before the cloth came to rest, or before both thresholds were reached.
    Restless,
    /// The run exceeded its limit of visits of edges.
    TooDear,
    /// The experiment was interrupted before the run was done.
    Interrupted,
}

impl Status {
    /// Returns the name of the status in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Refused => "refused",
            Status::BlownUp => "blown-up",
            Status::Unsolved => "unsolved",
            Status::Restless => "restless",
            Status::TooDear => "too-dear",
            Status::Interrupted => "interrupted",
        }
    }
}

/// The cost of a run: its steps, and its visits of single edges by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// The number of steps that succeeded.
    pub steps: u64,
    /// The number of visits to project or shorten edges.
    pub project: u64,
    /// The number of visits for forces, products with the matrix and frequencies, and to detect blow-up.
    pub force: u64,
    /// The number of visits to find edges that are about to tear, and to measure.
    pub other: u64,
    /// The CPU time of all steps in seconds; `None` without a clock.
    pub cpu_s: Option<f64>,
}

impl Cost {
    /// Returns the number of all visits of edges.
    #[must_use]
    pub fn visits(&self) -> u64 {
        self.project + self.force + self.other
    }

    fn note(&mut self, visits: Visits) {
        self.project = visits.project;
        self.force = visits.force;
        self.other = visits.detect + visits.meter;
    }
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The step in seconds; NaN if the run was not begun.
    pub dt_s: f64,
    /// The simulated time, in seconds.
    pub simulated_s: f64,
    /// The cost of the run.
    pub cost: Cost,
    /// The recorded numbers.
    pub records: Records,
}

impl Outcome {
    /// Returns the outcome of a run that was not begun because the experiment was interrupted.
    #[must_use]
    pub fn interrupted() -> Outcome {
        Outcome {
            status: Status::Interrupted,
            why: String::new(),
            dt_s: f64::NAN,
            simulated_s: 0.0,
            cost: Cost::default(),
            records: Records::default(),
        }
    }
}

/// The largest energy that is allowed, as a multiple of the energy put in.
pub const ENERGY_MAX: f64 = 1.25;

/// The number of checkpoints at which positions and strains are compared, evenly spaced over the time of the
/// scene. A scene that ends at rest has one, at its end.
pub const CHECKPOINTS: u64 = 10;

/// The limits that are imposed on a run from outside.
#[derive(Clone, Copy)]
pub struct Bounds<'a> {
    /// The largest number of visits of edges.
    pub visits_max: u64,
    /// The function that returns the CPU time of the calling thread; `None` to measure no times.
    pub clock: Option<&'a (dyn Fn() -> Duration + Sync)>,
    /// The function that returns whether the run must end. It is called before each step.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl std::fmt::Debug for Bounds<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bounds")
            .field("visits_max", &self.visits_max)
            .finish_non_exhaustive()
    }
}

/// The step nearest to `wanted_s` from below that has a whole number of steps to each checkpoint, and
/// that number: of `part` of a base step.
#[must_use]
pub(super) fn fitted_step_s(until: Until, base_s: f64, part: f64) -> (f64, Option<u64>) {
    let Until::Time(seconds) = until else {
        return (base_s * part, None);
    };
    let span_s = seconds / CHECKPOINTS as f64;
    let whole = |wanted: f64| (wanted - 1e-9).ceil().max(1.0);
    // By the whole number of base steps, so that halves of parts are halves of steps.
    let count = whole(whole(span_s / base_s) / part);
    (span_s / count, Some(count as u64))
}

/// How a run is made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// The base step, in seconds.
    pub(super) base_s: f64,
    /// The part of it that is taken.
    pub(super) part: f64,
    /// What moves no faster is at rest.
    pub(super) rest_m_per_s: f64,
    /// By what the energy in springs is told.
    pub(super) store: Store,
}

/// Takes a system to the end of its scene.
pub(super) fn run(
    case: &Case,
    mut system: System,
    solver: &mut dyn Solver,
    settings: Settings,
    bounds: &Bounds<'_>,
) -> Outcome {
    let until = case.scene.until;
    let Settings {
        base_s,
        part,
        rest_m_per_s,
        store,
    } = settings;
    let (dt_s, to_checkpoint) = fitted_step_s(until, base_s, part);
    let steps_max = match to_checkpoint {
        Some(count) => count * CHECKPOINTS,
        None => ((until.seconds() / dt_s) - 1e-9).ceil().max(1.0) as u64,
    };
    // Energy is looked at so often, and rest every hundredth of a second.
    let every = (steps_max / 400).max(1);
    let rest_every = ((0.01 / dt_s) as u64).max(1);
    let moves_at_end = solver.abilities().frequency_limit.is_none();
    let mut probe = Probe::new(case, &system, moves_at_end);
    let mut cost = Cost::default();
    let mut watch = Watch::new(&system, store);
    let (mut cpu, mut status, mut why) = (Duration::ZERO, None, String::new());
    while status.is_none() && cost.steps < steps_max {
        if (bounds.stop)() {
            status = Some(Status::Interrupted);
            break;
        }
        let began = bounds.clock.map(|clock| clock());
        let step = system.step(solver, dt_s);
        if let Some((clock, began)) = bounds.clock.zip(began) {
            cpu += clock().saturating_sub(began);
        }
        cost.note(system.counters().visits);
        if let Err(error) = step {
            (status, why) = (Some(named(&error)), error.to_string());
            break;
        }
        cost.steps += 1;
        probe.step(&system, dt_s);
        let is_last = cost.steps == steps_max;
        if to_checkpoint.is_some_and(|count| cost.steps % count == 0) {
            probe.checkpoint(&system);
        }
        if cost.steps % every == 0 || is_last {
            let made = watch.look(&system, probe.hand_j());
            probe.energy(watch.made());
            if !made {
                status = Some(Status::BlownUp);
                why = format!("{:.2} times the energy that was put in", watch.worst);
            }
        }
        if cost.visits() > bounds.visits_max && !is_last {
            status = status.or(Some(Status::TooDear));
        }
        match until {
            Until::Rest(_) if cost.steps % rest_every == 0 => {
                let fastest = system.velocities().iter().map(|v| v.norm_squared());
                // Held in place at the start of a fall nothing moves yet.
                if fastest.fold(0.0, f64::max).sqrt() < rest_m_per_s {
                    status = status.or(Some(Status::Ok));
                }
            }
            Until::Tears(_) if probe.has_torn() => status = status.or(Some(Status::Ok)),
            _ => {}
        }
    }
    let status = status.unwrap_or(match until {
        Until::Time(_) => Status::Ok,
        Until::Rest(_) | Until::Tears(_) => Status::Restless,
    });
    if matches!(until, Until::Rest(_)) && status == Status::Ok {
        probe.checkpoint(&system);
    }
    cost.cpu_s = bounds.clock.map(|_| cpu.as_secs_f64());
    Outcome {
        status,
        why,
        dt_s,
        simulated_s: system.elapsed_s(),
        cost,
        records: probe.records(&system),
    }
}

fn named(error: &StepError) -> Status {
    match error {
        StepError::BlowUp { .. } => Status::BlownUp,
        StepError::Implicit { .. } => Status::Unsolved,
        _ => Status::Refused,
    }
}

/// Keeps an eye on energy: gravity, the hand that pulls, and what was there.
#[derive(Clone, Copy, Debug)]
struct Watch {
    store: Store,
    began_j: f64,
    height_j: f64,
    /// What was put in at most so far.
    put_in_j: f64,
    /// Energy that nobody put in, with drag's loss.
    made_j: f64,
    /// The most energy so far as a multiple of what was put in.
    worst: f64,
}

impl Watch {
    fn new(system: &System, store: Store) -> Watch {
        Watch {
            store,
            began_j: energy::elastic_j(system),
            height_j: height_j(system),
            put_in_j: 0.0,
            made_j: 0.0,
            worst: 0.0,
        }
    }

    /// Whether there is no more energy than there may be.
    fn look(&mut self, system: &System, hand_j: f64) -> bool {
        let fallen_j = self.height_j - height_j(system);
        let now_j = stored_j(system, self.store) + energy::kinetic_j(system);
        let put_in_j = self.began_j + fallen_j.max(0.0) + hand_j.max(0.0);
        self.put_in_j = self.put_in_j.max(put_in_j);
        self.made_j = now_j - (self.began_j + fallen_j + hand_j);
        self.worst = self.worst.max(now_j / self.put_in_j);
        // Written so that a NaN counts as above.
        now_j <= ENERGY_MAX * self.put_in_j
    }

    /// Energy that nobody put in as a part of what was; negative where some was lost.
    fn made(&self) -> f64 {
        self.made_j / self.put_in_j
    }
}

fn stored_j(system: &System, store: Store) -> f64 {
    match store {
        Store::Nothing => 0.0,
        Store::Lengths => energy::elastic_j(system),
        Store::Forces => {
            let stretches = system.stretches();
            let each = stretches.iter().map(|id| {
                let force_n = force::force_n(system, id);
                force_n * force_n / (2.0 * stretches.get(id).stiffness_n_per_m)
            });
            each.sum()
        }
    }
}

fn height_j(system: &System) -> f64 {
    let Some(gravity) = system.loads().gravity_m_per_s2 else {
        return 0.0;
    };
    let particles = system.positions().iter().zip(system.masses());
    -particles
        .map(|(x, m)| m * gravity.dot(&x.coords))
        .sum::<f64>()
}
