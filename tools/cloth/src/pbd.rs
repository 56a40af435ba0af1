//! Position based dynamics, the second model of the paper.
//!
//! Predict positions, project the constraints a fixed number of times, and take the resulting
//! motion as the velocity (Müller et al. 2007). Its constraints are stable at any step, and so is
//! drag; wind, which is that of the velocities before, up to λ Δt = 2
//! ([`wind_rate`](crate::air::wind_rate)). Never sold as accurate: how stiff it is depends on the
//! step and on the number of sweeps, and as the step goes to zero there is no limit. What it
//! converges to with more sweeps is an inextensible net. [`System::strain_rms`] says how far its
//! lengths are from that, and not where it hangs: pushes act along the directions that constraints
//! had when they were projected, as those of [`Xpbd`](crate::Xpbd) do.

use crate::flight::{finish, force_scale, predict};
use crate::solver::{Abilities, Failure, SettingError, Solver};
use crate::spring;
use crate::system::{Recorded, System};

/// Position based dynamics. It ignores the stiffness of constraints in N/m: they are rigid, or as
/// soft as [`Pbd::stiffness`] makes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pbd {
    /// The number of sweeps over all constraints per step. Zero counts as one.
    pub sweeps: u32,
    /// The fraction k of an error in a stretch constraint that one step corrects, from 0 to 1. It
    /// does not depend on the number of sweeps n, since each sweep corrects 1 − (1 − k)^(1/n)
    /// (Müller et al. 2007, §3.3).
    pub stiffness: f64,
    /// The fraction of an error in a bend constraint that one step corrects, from 0 to 1, whatever
    /// the number of sweeps.
    pub bend_stiffness: f64,
}

impl Default for Pbd {
    /// Returns the method with ten sweeps, rigid stretch constraints, and a bend stiffness of 0.1.
    fn default() -> Pbd {
        Pbd {
            sweeps: 10,
            stiffness: 1.0,
            bend_stiffness: 0.1,
        }
    }
}

impl Pbd {
    /// Creates the method with rigid constraints and `sweeps` sweeps per step.
    #[must_use]
    pub fn new(sweeps: u32) -> Pbd {
        Pbd {
            sweeps,
            ..Pbd::default()
        }
    }

    /// The part of an error that a sweep corrects, of stretch and of bend constraints.
    pub(super) fn fractions(&self) -> [f64; 2] {
        [self.stiffness, self.bend_stiffness].map(|k| 1.0 - root(1.0 - k, self.sweeps.max(1)))
    }
}

impl Solver for Pbd {
    fn abilities(&self) -> Abilities {
        Abilities {
            air_limit: Some(2.0),
            ..Abilities::default()
        }
    }

    fn check(&self) -> Result<(), SettingError> {
        for (setting, given) in [
            ("stiffness", self.stiffness),
            ("bend_stiffness", self.bend_stiffness),
        ] {
            SettingError::unless((0.0..=1.0).contains(&given), setting, given, "0 to 1")?;
        }
        Ok(())
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        predict(system, dt_s);
        let [stretch, bend] = self.fractions();
        let System {
            positions,
            model,
            counters,
            ..
        } = system;
        model.clear_multipliers();
        for _ in 0..self.sweeps.max(1) {
            let features = &mut counters.features;
            for (family, fraction, of_family) in [
                (&mut model.stretch, stretch, &mut features.stretch),
                (&mut model.bend, bend, &mut features.bend),
            ] {
                for (batch, memories) in family.batches_mut() {
                    counters.visits.project += batch.ends.len() as u64;
                    *of_family += batch.ends.len() as u64;
                    Failure::unless(spring::project(
                        batch,
                        memories.multipliers,
                        &model.inverse_masses,
                        fraction,
                        model.stretch_ratio_max,
                        positions,
                    ))?;
                }
            }
        }
        finish(system, dt_s);
        let model = &mut system.model;
        model.scale_multipliers(force_scale(model, dt_s));
        model.recorded = Recorded::RigidForces;
        Ok(())
    }
}

/// The n-th root of a number from 0 to 1, by Newton's iteration from above.
fn root(a: f64, n: u32) -> f64 {
    if a <= 0.0 || n == 0 {
        return 0.0;
    }
    let mut x = 1.0;
    for _ in 0..200 {
        let power = (1..n).fold(1.0, |power, _| power * x);
        let next = x - (x - a / power) / f64::from(n);
        if next >= x {
            break;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_to_a_power_give_the_number() {
        for n in 1..=40 {
            for a in [1e-6, 0.1, 0.5, 0.9, 1.0] {
                let x = root(a, n);
                let back = (0..n).fold(1.0, |power, _| power * x);
                assert!((back - a).abs() < 1e-13, "{a} {n}: {x}");
            }
            assert_eq!(root(0.0, n), 0.0);
        }
    }
}
