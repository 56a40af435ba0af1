//! The stability limit of a step of an explicit method, given by springs and air.

use crate::method::solver::{Abilities, Solver, StepError, StepLimit};
use crate::system::air;
use crate::system::guard::{Frequency, Guard};
use crate::system::{System, Unstable};

/// What the air takes of a step: the rate at which it slows, with the particle ([`air_rate`](air::air_rate)),
/// and one over the longest step in seconds that is stable without springs.
type AirShare = ((f64, usize), f64);

/// How many substeps a step takes, by the springs of an explicit method, and by air that a method takes in by
/// the velocities before. With light particles carried there are none up to twice the step that suits, and
/// beyond that as many as make each substep suit, or more if those would not be stable.
pub(crate) fn admit(system: &mut System, solver: &dyn Solver, dt_s: f64) -> Result<u32, StepError> {
    let abilities = solver.abilities();
    if abilities.damps {
        damp(system);
    }
    if system.unstable == Unstable::Allow {
        return Ok(1);
    }
    let (springs_s, air) = limit(system, abilities);
    let mut limit_s = with_air(springs_s, air);
    let is_whole = dt_s <= limit_s;
    if !is_whole && system.unstable == Unstable::Refuse {
        return Err(refused(system, [dt_s, limit_s], springs_s, air));
    }
    if !abilities.carries_light {
        return divided(dt_s, limit_s);
    }
    let suited_s = with_air(springs_s / Guard::WHOLE, air);
    let mut substeps = divided(dt_s, if is_whole { limit_s } else { suited_s })?;
    system.scratch.air_per_s = air.map_or(0.0, |(_, per_s)| per_s);
    loop {
        weigh_for(system, dt_s / f64::from(substeps));
        if system.guard.is_sound(&system.model, &mut system.counters) {
            break;
        }
        limit_s = dt_s / f64::from(2 * substeps);
        substeps = divided(dt_s, limit_s)?;
    }
    if substeps > 1 && system.unstable == Unstable::Refuse {
        return Err(refused(system, [dt_s, limit_s], limit_s, air));
    }
    Ok(substeps)
}

/// The longest step in seconds that springs admit whole by such a method, infinite where they admit any, and
/// what the air takes of it.
fn limit(system: &mut System, abilities: Abilities) -> (f64, Option<AirShare>) {
    let springs_s = match abilities.frequency_limit {
        _ if abilities.carries_light => Guard::WHOLE * recommended_step_s(system),
        Some(limit) => stable_step_s(system, limit),
        None => f64::INFINITY,
    };
    let air_share = |limit| {
        let rate = air::air_rate(system, abilities.takes_drag_explicitly)?;
        Some((rate, rate.0 / limit))
    };
    (springs_s, abilities.air_limit.and_then(air_share))
}

/// A step in seconds beyond a limit, which springs or air make too long.
fn refused(
    system: &mut System,
    [given_s, limit_s]: [f64; 2],
    springs_s: f64,
    air: Option<AirShare>,
) -> StepError {
    let by = match air.filter(|(_, per_s)| per_s * springs_s > 1.0) {
        Some(((rate_per_s, particle), _)) => StepLimit::Air {
            rate_per_s,
            particle,
        },
        None => StepLimit::Springs(frequency_bound(system)),
    };
    StepError::Unstable {
        given_s,
        limit_s,
        by,
    }
}

/// Returns the step in seconds that suits [`Verlet`](crate::Verlet): the longest at which at most a
/// tenth of the particles must be carried by their neighbours. A step of up to twice that is taken
/// whole. It considers springs, and triangles as they are stretched now; it is infinite if there
/// are none. Cuts and tears do not shorten it, since particles that become light are carried. Costs
/// a pass over all constraints if something has changed.
pub fn recommended_step_s(system: &mut System) -> f64 {
    reach_out(system);
    system.guard.suited_s()
}

/// Weighs particles for steps of this length.
pub(crate) fn weigh_for(system: &mut System, dt_s: f64) {
    damp(system);
    let air = dt_s * system.scratch.air_per_s;
    if system.guard.weigh(&system.model, dt_s, air) {
        system.scratch.is_weighed = false;
    }
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
/// [`air_rate`](air::air_rate)).
pub fn stable_step_s(system: &mut System, frequency_limit: f64) -> f64 {
    frequency_limit / frequency_bound(system).omega_rad_per_s
}

fn reach_out(system: &mut System) {
    damp(system);
    system.guard.reach_out(&system.model, &system.positions);
}

/// Computes the damping of springs where masses or stiffness have changed.
fn damp(system: &mut System) {
    system.guard.damp(&mut system.model);
}

/// The largest step in seconds that is taken whole by this method with the present wind, where of that of the
/// springs alone only a part is to be taken; infinite if nothing limits it.
pub(crate) fn whole_step_s(system: &mut System, solver: &dyn Solver, springs_part: f64) -> f64 {
    let (springs_s, air) = limit(system, solver.abilities());
    with_air(springs_part * springs_s, air)
}

/// The longest stable step of springs and air together, in seconds, by that of the springs.
fn with_air(springs_s: f64, air: Option<AirShare>) -> f64 {
    air.map_or(springs_s, |(_, per_s)| 1.0 / (1.0 / springs_s + per_s))
}

/// A step in as many parts as are admitted.
fn divided(dt_s: f64, limit_s: f64) -> Result<u32, StepError> {
    let substeps = (dt_s / limit_s).ceil();
    if substeps > f64::from(StepError::SUBSTEPS_MAX) {
        return Err(StepError::Substeps {
            given_s: dt_s,
            limit_s,
        });
    }
    Ok((substeps as u32).max(1))
}
