//! A run: a method takes a scene to its end, and the observables are recorded on the way.
//!
//! A run that does not get there has a status, the reason, and its cost up to then.

use std::time::Duration;

use tearmesh_cloth::StepError;

use super::observe::{Probe, Records};
use super::plan::{CHECKPOINTS, begin};
use super::row::Row;
use super::scene::{Case, REST_M_PER_S, Until, fastest_m_per_s};
use crate::experiment::{Bounds, Status};

/// The speed at which references are at rest, as a fraction of [`REST_M_PER_S`].
const REST_OF_REFERENCES: f64 = 1e-1;

/// Carries out the run of a key, which ends where it exceeds `visits_max` visits of edges unless it is a reference.
/// Returns `None` if it was interrupted.
pub(super) fn run(case: &Case, key: &Row, visits_max: u64, bounds: &Bounds<'_>) -> Option<Row> {
    let (until, dt_s, planned) = (case.scene.until, key.dt_s, key.planned);
    let (rest_m_per_s, visits_max) = match planned.role.is_reference() {
        true => (REST_M_PER_S * REST_OF_REFERENCES, u64::MAX),
        false => (REST_M_PER_S, visits_max),
    };
    let steps_max = match planned.steps_to_checkpoint {
        Some(count) => count * CHECKPOINTS,
        None => ((until.seconds() / dt_s) - 1e-9).ceil().max(1.0) as u64,
    };
    // Energy is checked 400 times, and rest every hundredth of a second.
    let every = (steps_max / 400).max(1);
    let rest_every = ((0.01 / dt_s) as u64).max(1);
    let (mut system, mut solver) = begin(case, key);
    let mut probe = Probe::new(case, &system, key.family);
    let (mut cpu, mut visits) = (Duration::ZERO, 0);
    let (mut status, mut why) = (Status::Restless, String::new());
    for number in 1..=steps_max {
        if (bounds.stop)() {
            return None;
        }
        let began = bounds.now();
        let step = system.step(&mut *solver, dt_s);
        cpu += bounds.now().saturating_sub(began);
        let counted = system.counters().visits;
        visits = counted.project + counted.force + counted.detect;
        if let Err(error) = step {
            (status, why) = (status_of(&error), error.to_string());
            break;
        }
        probe.step(&system, dt_s);
        let is_nth = |count: u64| number.is_multiple_of(count);
        if planned.steps_to_checkpoint.is_some_and(is_nth) {
            probe.checkpoint(&system);
        }
        let is_last = number == steps_max;
        let has_ended = match until {
            Until::Time(_) => is_last,
            Until::Rest(_) => is_nth(rest_every) && fastest_m_per_s(&system) < rest_m_per_s,
            Until::Tears(_) => probe.has_torn(),
        };
        let mut ended = has_ended.then_some(Status::Ok);
        if visits > visits_max && !is_last {
            ended = Some(Status::TooDear);
        }
        if (is_nth(every) || is_last)
            && let Some(grown) = probe.energy(&system)
        {
            ended = Some(Status::BlownUp);
            why = format!("{grown:.2} times the energy that was put in");
        }
        if let Some(ended) = ended {
            status = ended;
            break;
        }
    }
    if matches!(until, Until::Rest(_)) && status == Status::Ok {
        probe.checkpoint(&system);
    }
    Some(Row {
        status,
        why,
        visits: Some(visits),
        cpu_median_s: bounds.clock.map(|_| cpu.as_secs_f64()),
        records: match planned.round {
            0 => probe.records(&system),
            _ => Records::new(),
        },
        ..key.clone()
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
