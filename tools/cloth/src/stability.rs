//! How long a step may be: the watch over explicit methods, by springs and air.

use crate::air::{self, AirRate};
use crate::frequency;
use crate::solver::{Solver, StepError, StepReport};
use crate::system::{System, Unstable};

/// How many substeps a step takes, by the springs of an explicit method, and by air that a
/// method takes in by the velocities before.
pub(crate) fn admit(
    system: &mut System,
    solver: &(impl Solver + ?Sized),
    dt_s: f64,
) -> Result<StepReport, StepError> {
    let whole = StepReport {
        substeps: 1,
        limit_s: None,
    };
    if system.unstable == Unstable::Allow {
        return Ok(whole);
    }
    match (
        solver.abilities().frequency_limit,
        air_share(system, solver),
    ) {
        (Some(limit), air) => admit_springs(system, limit, air, dt_s),
        (None, Some(air)) => admit_air(system, air, dt_s),
        (None, None) => Ok(whole),
    }
}

/// The same by the springs, the cheap answer first; the share of the air shortens either.
///
/// The bound holds wherever the particles go. A measured frequency is that of one
/// configuration: springs that turn toward each other at a light particle can raise it to the
/// bound within a few steps. So a step is divided by the bound, and one that is longer than
/// that and admitted whole is measured again and again.
fn admit_springs(
    system: &mut System,
    limit: f64,
    air: Option<AirShare>,
    dt_s: f64,
) -> Result<StepReport, StepError> {
    let springs_s = limit / frequency::bound(system);
    let bound_s = with_air(springs_s, air);
    if dt_s <= bound_s || system.unstable == Unstable::Substep {
        return divided(dt_s, bound_s);
    }
    let frequency = frequency::recent(system);
    let springs_s = (system.margin * limit / frequency.omega_rad_per_s).max(springs_s);
    let limit_s = with_air(springs_s, air);
    if dt_s <= limit_s {
        return divided(dt_s, limit_s);
    }
    match air.filter(|air| air.per_s * springs_s > 1.0) {
        Some(air) => Err(air.refused(dt_s, limit_s)),
        None => Err(StepError::Unstable {
            given_s: dt_s,
            limit_s,
            frequency,
        }),
    }
}

/// The same by the air alone.
fn admit_air(system: &System, air: AirShare, dt_s: f64) -> Result<StepReport, StepError> {
    let limit_s = with_air(f64::INFINITY, Some(air));
    if dt_s <= limit_s || system.unstable == Unstable::Substep {
        return divided(dt_s, limit_s);
    }
    Err(air.refused(dt_s, limit_s))
}

/// The largest step in seconds that the watch admits whole in the present configuration, for
/// a method with this limit of ω Δt: 2 for [`Verlet`](crate::Verlet). Measures the frequency.
/// Springs alone: what wind takes of it is [`Abilities::air_limit`](crate::Abilities::air_limit) by [`wind_rate`](air::wind_rate).
pub fn stable_step_s(system: &mut System, frequency_limit: f64) -> f64 {
    let bound_s = frequency_limit / frequency::bound(system);
    (system.margin * frequency_limit / frequency::largest(system).omega_rad_per_s).max(bound_s)
}

/// The same for this method with the air that blows now; `None` where nothing limits it.
pub(crate) fn whole_step_s(system: &mut System, solver: &impl Solver) -> Option<f64> {
    let springs_s = solver
        .abilities()
        .frequency_limit
        .map(|limit| stable_step_s(system, limit));
    match air_share(system, solver) {
        None => springs_s,
        air => Some(with_air(springs_s.unwrap_or(f64::INFINITY), air)),
    }
}

/// What the air takes of a step by this method.
fn air_share(system: &mut System, solver: &(impl Solver + ?Sized)) -> Option<AirShare> {
    let abilities = solver.abilities();
    let limit = abilities.air_limit?;
    let drag = match abilities.takes_drag_explicitly {
        true => air::drag_rate(system),
        false => None,
    };
    let rate = match (air::wind_rate(system), drag) {
        (Some(wind), Some(drag)) => AirRate {
            rate_per_s: wind.rate_per_s + drag.rate_per_s,
            ..wind
        },
        (wind, drag) => wind.or(drag)?,
    };
    let per_s = rate.rate_per_s / limit;
    Some(AirShare { rate, per_s })
}

/// What the air takes of a step.
#[derive(Clone, Copy, Debug)]
struct AirShare {
    rate: AirRate,
    /// One over the longest step in seconds that is stable without springs.
    per_s: f64,
}

impl AirShare {
    /// A step that the air makes too long.
    fn refused(self, given_s: f64, limit_s: f64) -> StepError {
        StepError::Air {
            given_s,
            limit_s,
            rate: self.rate,
        }
    }
}

/// The longest stable step of springs and air together, in seconds, by that of the springs.
fn with_air(springs_s: f64, air: Option<AirShare>) -> f64 {
    air.map_or(springs_s, |air| 1.0 / (1.0 / springs_s + air.per_s))
}

/// A step in as many parts as are admitted.
fn divided(dt_s: f64, limit_s: f64) -> Result<StepReport, StepError> {
    let substeps = (dt_s / limit_s).ceil();
    if substeps > f64::from(StepError::SUBSTEPS_MAX) {
        return Err(StepError::Substeps {
            given_s: dt_s,
            limit_s,
        });
    }
    Ok(StepReport {
        substeps: (substeps as u32).max(1),
        limit_s: Some(limit_s),
    })
}
