//! A run: a method takes a scene to its end, and the observables are recorded on the way.
//!
//! A run that does not get there has a status, the reason, and its cost up to then.

use std::time::Duration;

use tearmesh_cloth::{Solver, StepError, System, Visits, energy, force};

use super::observe::{Probe, Records};
use super::scene::{Case, Until};
use crate::experiment::{Bounds, Status};
use crate::method::StoredEnergy;

/// The cost of a run: its steps, and its visits of single edges by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// The number of steps that succeeded.
    pub steps: u64,
    /// The number of visits to project or shorten edges.
    pub project: u64,
    /// The number of visits for forces, products with the matrix and frequencies, and to detect blow-up.
    pub force: u64,
    /// The number of visits to find edges that may tear, and to measure.
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

    fn update(&mut self, visits: Visits) {
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
    /// The step, in seconds.
    pub dt_s: f64,
    /// The simulated time, in seconds.
    pub simulated_s: f64,
    /// The cost of the run.
    pub cost: Cost,
    /// The recorded numbers.
    pub records: Records,
}

/// The largest energy that is allowed, as a multiple of the energy put in.
pub const ENERGY_MAX: f64 = 1.25;

/// The number of checkpoints at which positions and strains are compared, evenly spaced over the time of the
/// scene. A scene that ends at rest has one, at its end.
pub const CHECKPOINTS: u64 = 10;

/// The longest step that is at most `fraction` of a base step and has a whole number of steps to each
/// checkpoint, and that number.
pub(super) fn fitted_step_s(until: Until, base_s: f64, fraction: f64) -> (f64, Option<u64>) {
    let Until::Time(seconds) = until else {
        return (base_s * fraction, None);
    };
    let span_s = seconds / CHECKPOINTS as f64;
    let whole = |wanted: f64| (wanted - 1e-9).ceil().max(1.0);
    // From the whole number of base steps, so that half of a fraction is half of the step.
    let count = whole(whole(span_s / base_s) / fraction);
    (span_s / count, Some(count as u64))
}

/// The settings of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// The base step, in seconds.
    pub(super) base_s: f64,
    /// The fraction of the base step that is taken.
    pub(super) fraction: f64,
    /// The speed in m/s below which a particle is at rest.
    pub(super) rest_m_per_s: f64,
    /// The way in which the energy stored in springs is computed.
    pub(super) stored: StoredEnergy,
    /// The largest number of visits of edges.
    pub(super) visits_max: u64,
}

/// Takes a system to the end of its scene. Returns `None` if it was interrupted.
pub(super) fn run(
    case: &Case,
    mut system: System,
    solver: &mut dyn Solver,
    settings: Settings,
    bounds: &Bounds<'_>,
) -> Option<Outcome> {
    let until = case.scene.until;
    let (dt_s, to_checkpoint) = fitted_step_s(until, settings.base_s, settings.fraction);
    let steps_max = match to_checkpoint {
        Some(count) => count * CHECKPOINTS,
        None => ((until.seconds() / dt_s) - 1e-9).ceil().max(1.0) as u64,
    };
    // Energy is checked 400 times, and rest every hundredth of a second.
    let every = (steps_max / 400).max(1);
    let rest_every = ((0.01 / dt_s) as u64).max(1);
    let moves_at_end = solver.abilities().frequency_limit.is_none();
    let mut probe = Probe::new(case, &system, moves_at_end);
    let mut cost = Cost::default();
    let mut balance = EnergyBalance::new(&system, settings.stored);
    let (mut cpu, mut status, mut why) = (Duration::ZERO, None, String::new());
    while status.is_none() && cost.steps < steps_max {
        if (bounds.stop)() {
            return None;
        }
        let began = bounds.now();
        let step = system.step(solver, dt_s);
        cpu += bounds.now().saturating_sub(began);
        cost.update(system.counters().visits);
        if let Err(error) = step {
            (status, why) = (Some(status_of(&error)), error.to_string());
            break;
        }
        cost.steps += 1;
        probe.step(&system, dt_s);
        let is_last = cost.steps == steps_max;
        if to_checkpoint.is_some_and(|count| cost.steps.is_multiple_of(count)) {
            probe.checkpoint(&system);
        }
        if cost.steps.is_multiple_of(every) || is_last {
            let is_bounded = balance.update(&system, probe.hand_j());
            probe.energy(balance.made());
            if !is_bounded {
                status = Some(Status::BlownUp);
                why = format!("{:.2} times the energy that was put in", balance.worst);
            }
        }
        if cost.visits() > settings.visits_max && !is_last {
            status = status.or(Some(Status::TooDear));
        }
        match until {
            Until::Rest(_) if cost.steps.is_multiple_of(rest_every) => {
                let fastest = system.velocities().iter().map(|v| v.norm_squared());
                if fastest.fold(0.0, f64::max).sqrt() < settings.rest_m_per_s {
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
    Some(Outcome {
        status,
        why,
        dt_s,
        simulated_s: system.elapsed_s(),
        cost,
        records: probe.records(&system),
    })
}

/// The status of a run in which a step failed.
pub(crate) fn status_of(error: &StepError) -> Status {
    match error {
        StepError::BlowUp { .. } => Status::BlownUp,
        StepError::Implicit { .. } => Status::Unsolved,
        _ => Status::Refused,
    }
}

/// The energy balance of a run: what was there, the work of gravity, and that of the hand that pulls.
#[derive(Clone, Copy, Debug)]
struct EnergyBalance {
    stored: StoredEnergy,
    began_j: f64,
    height_j: f64,
    /// The most energy that had been put in so far.
    put_in_j: f64,
    /// The energy beyond what was put in, less what drag took.
    made_j: f64,
    /// The largest energy so far, as a multiple of what was put in.
    worst: f64,
}

impl EnergyBalance {
    fn new(system: &System, stored: StoredEnergy) -> EnergyBalance {
        EnergyBalance {
            stored,
            began_j: energy::elastic_j(system),
            height_j: height_j(system),
            put_in_j: 0.0,
            made_j: 0.0,
            worst: 0.0,
        }
    }

    /// Updates the balance, and returns whether there is no more energy than is allowed.
    fn update(&mut self, system: &System, hand_j: f64) -> bool {
        let fallen_j = self.height_j - height_j(system);
        let now_j = stored_j(system, self.stored) + energy::kinetic_j(system);
        let put_in_j = self.began_j + fallen_j.max(0.0) + hand_j.max(0.0);
        self.put_in_j = self.put_in_j.max(put_in_j);
        self.made_j = now_j - (self.began_j + fallen_j + hand_j);
        self.worst = self.worst.max(now_j / self.put_in_j);
        // Written so that a NaN counts as above.
        now_j <= ENERGY_MAX * self.put_in_j
    }

    /// The energy that was made, as a fraction of what was put in; negative if some was lost.
    fn made(&self) -> f64 {
        self.made_j / self.put_in_j
    }
}

fn stored_j(system: &System, stored: StoredEnergy) -> f64 {
    match stored {
        StoredEnergy::None => 0.0,
        StoredEnergy::ByLength => energy::elastic_j(system),
        StoredEnergy::ByForce => {
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
