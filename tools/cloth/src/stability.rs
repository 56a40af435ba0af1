//! The stability limit of a step of an explicit method, given by springs and air.

use crate::air::{self, AirRate};
use crate::guard::{Frequency, Guard};
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
    let abilities = solver.abilities();
    if abilities.carries_light {
        let air = air_share(system, solver);
        return admit_carried(system, air, dt_s);
    }
    match (abilities.frequency_limit, air_share(system, solver)) {
        (Some(limit), air) => admit_springs(system, limit, air, dt_s),
        (None, Some(air)) => admit_air(system, air, dt_s),
        (None, None) => Ok(whole),
    }
}

/// How many substeps a step takes because of the springs, by the bound of their frequencies. The share
/// of the air shortens the limit.
fn admit_springs(
    system: &mut System,
    limit: f64,
    air: Option<AirShare>,
    dt_s: f64,
) -> Result<StepReport, StepError> {
    let springs_s = stable_step_s(system, limit);
    let limit_s = with_air(springs_s, air);
    if dt_s <= limit_s || system.unstable == Unstable::Substep {
        return divided(dt_s, limit_s);
    }
    Err(refused(system, [dt_s, limit_s], springs_s, air))
}

/// A step in seconds beyond a limit, which springs and air make too long.
fn refused(
    system: &mut System,
    [given_s, limit_s]: [f64; 2],
    springs_s: f64,
    air: Option<AirShare>,
) -> StepError {
    match air.filter(|air| air.per_s * springs_s > 1.0) {
        Some(air) => air.refused(given_s, limit_s),
        None => StepError::Unstable {
            given_s,
            limit_s,
            frequency: frequency_bound(system),
        },
    }
}

/// How many substeps a step takes with light particles carried: none up to twice the one that
/// suits, and beyond that as many as make each substep suit, or more if those would not be stable.
fn admit_carried(
    system: &mut System,
    air: Option<AirShare>,
    dt_s: f64,
) -> Result<StepReport, StepError> {
    let suited_s = suited_step_s(system);
    let longest_s = Guard::WHOLE * suited_s;
    let mut limit_s = with_air(longest_s, air);
    let is_whole = dt_s <= limit_s;
    if !is_whole && system.unstable == Unstable::Refuse {
        return Err(refused(system, [dt_s, limit_s], longest_s, air));
    }
    let suited_s = with_air(suited_s, air);
    let mut report = divided(dt_s, if is_whole { limit_s } else { suited_s })?;
    system.scratch.air_per_s = air.map_or(0.0, |air| air.per_s);
    while !is_sound(system, dt_s / f64::from(report.substeps)) {
        limit_s = dt_s / f64::from(2 * report.substeps);
        report = divided(dt_s, limit_s)?;
    }
    if report.substeps > 1 && system.unstable == Unstable::Refuse {
        return Err(refused(system, [dt_s, limit_s], limit_s, air));
    }
    Ok(StepReport {
        limit_s: Some(limit_s),
        ..report
    })
}

/// Returns the step in seconds that suits [`Verlet`](crate::Verlet): the longest at which at most a
/// tenth of the particles must be carried by their neighbours. A step of up to twice that is taken
/// whole. It considers springs, and triangles as they are stretched now; it is infinite if there
/// are none. Cuts and tears do not shorten it, since particles that become light are carried. Costs
/// a pass over all constraints if something has changed.
pub fn suited_step_s(system: &mut System) -> f64 {
    reach_out(system);
    system.guard.suited_s(&system.model)
}

/// Returns the number of particles that were too light for the last step of
/// [`Verlet`](crate::Verlet), and so were carried by their neighbours.
#[must_use]
pub fn carried_count(system: &System) -> usize {
    system.guard.carry().len()
}

/// Weighs particles for steps of this length.
pub(crate) fn weigh_for(system: &mut System, dt_s: f64) {
    let air = dt_s * system.scratch.air_per_s;
    if system.guard.weigh(&system.model, dt_s, air) {
        system.scratch.is_fresh = false;
    }
}

/// Whether steps of this length are stable with particles carried for it.
fn is_sound(system: &mut System, dt_s: f64) -> bool {
    weigh_for(system, dt_s);
    system.guard.is_sound(&system.model, &mut system.counters)
}

/// How many substeps a step takes because of the air alone.
fn admit_air(system: &System, air: AirShare, dt_s: f64) -> Result<StepReport, StepError> {
    let limit_s = with_air(f64::INFINITY, Some(air));
    if dt_s <= limit_s || system.unstable == Unstable::Substep {
        return divided(dt_s, limit_s);
    }
    Err(air.refused(dt_s, limit_s))
}

/// Returns an upper bound of the frequencies of a system, and the constraint that sets it. It holds in
/// every configuration; with triangles that resist shear, as long as none is stretched more than now.
/// Costs a pass over all constraints if something has changed, and over all triangles.
pub fn frequency_bound(system: &mut System) -> Frequency {
    reach_out(system);
    system.guard.frequency(&system.model)
}

/// Returns the largest step in seconds that is taken whole by a method with this limit of ω Δt, which
/// is 2 for [`Provot`](crate::Provot); infinite without springs. It follows from the
/// [bound](frequency_bound) of frequencies, so it is safe in every configuration. It does not consider
/// wind, which shortens the step further ([`Abilities::air_limit`](crate::Abilities::air_limit),
/// [`wind_rate`](air::wind_rate)).
pub fn stable_step_s(system: &mut System, frequency_limit: f64) -> f64 {
    frequency_limit / frequency_bound(system).omega_rad_per_s
}

fn reach_out(system: &mut System) {
    let (model, counters) = (&system.model, &mut system.counters);
    system.guard.reach_out(model, &system.positions, counters);
}

/// The largest step that is taken whole by this method with the present wind; `None` if nothing
/// limits it.
pub(crate) fn whole_step_s(system: &mut System, solver: &impl Solver) -> Option<f64> {
    let abilities = solver.abilities();
    if abilities.carries_light {
        let longest_s = Guard::WHOLE * suited_step_s(system);
        return Some(with_air(longest_s, air_share(system, solver)));
    }
    let springs_s = abilities
        .frequency_limit
        .map(|limit| stable_step_s(system, limit));
    match air_share(system, solver) {
        None => springs_s,
        air => Some(with_air(springs_s.unwrap_or(f64::INFINITY), air)),
    }
}

/// The step that suits this method with the air that blows now; `None` where it carries nothing.
pub(crate) fn suited_s(system: &mut System, solver: &impl Solver) -> Option<f64> {
    if !solver.abilities().carries_light {
        return None;
    }
    let springs_s = suited_step_s(system);
    Some(with_air(springs_s, air_share(system, solver)))
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
