//! Methods that move particles until constraints hold: extended position based dynamics with small
//! steps, and the position based dynamics of the paper.
//!
//! Constraints with a compliance α = 1/k (Macklin, Müller and Chentanez 2016), and many substeps of
//! one sweep rather than one step of many (Macklin et al. 2019, "Small Steps"): 6.5–11 times
//! less strain for about the same cost. The force in each constraint is known as its
//! multiplier, so a tear threshold can be in newtons.
//!
//! With many sweeps it comes near backward Euler, and damps like it, but not to it: each sweep pushes along
//! the directions that constraints had then, not those that they have in the end, and once it has converged
//! there is nothing left to turn the pushes with. At 60 steps a second a chain that sags by 0.39 m stays off
//! by 0.26 mm where [`Quality::Residual`] is rounding alone. With few sweeps it is softer than its springs,
//! and at rest too: by how much is in the table of [`Verlet`](crate::Verlet), and the command says it of a
//! scene.
//!
//! Sweeps always run in the same direction; alternating stretches 33 times more. Drag enters the
//! prediction *and* the compliance (a factor 1 + c Δt), otherwise the static stretch would be
//! wrong by just that factor.
//!
//! [`Pbd`] is that without compliance: predict positions, project the constraints a fixed number of times,
//! and take the resulting motion as the velocity (Müller et al. 2007). It is never accurate: how stiff it is
//! depends on the step and on the number of sweeps, and as the step goes to zero there is no limit. What
//! it converges to with more sweeps is an inextensible net.

use tearmesh::geometry::{Vector, length};

use crate::method::motion::{finish, force_scale, predict};
use crate::method::solver::{Abilities, Failure, Quality, Solver};
use crate::method::spring::{self, Correction};
use crate::system::System;
use crate::system::collide;
use crate::system::error::SettingError;
use crate::system::model::Recorded;
use crate::system::pair;

/// Extended position based dynamics (XPBD), with small substeps. Constraints and drag are stable at
/// any step. Wind is evaluated at the velocities before a substep, and is stable up to λ Δt = 2
/// ([`air_rate`](crate::air::air_rate)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Xpbd {
    /// The number of substeps per step. Zero counts as one.
    pub substeps: u32,
    /// The number of sweeps over all constraints per substep. Zero counts as one, and one is best.
    pub sweeps: u32,
}

impl Default for Xpbd {
    /// Returns the method with ten substeps of one sweep.
    fn default() -> Xpbd {
        Xpbd {
            substeps: 10,
            sweeps: 1,
        }
    }
}

impl Xpbd {
    /// Creates the method with these numbers of substeps per step and sweeps per substep.
    #[must_use]
    pub fn new(substeps: u32, sweeps: u32) -> Xpbd {
        Xpbd { substeps, sweeps }
    }
}

impl Solver for Xpbd {
    /// Returns the abilities of the method. The air limit is per step, since each substep has its
    /// own wind.
    fn abilities(&self) -> Abilities {
        Abilities {
            air_limit: Some(2.0 * f64::from(self.substeps.max(1))),
            ..Abilities::default()
        }
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let substeps = self.substeps.max(1);
        let substep_s = dt_s / f64::from(substeps);
        predict(system, substep_s);
        for substep in 0..substeps {
            if substep > 0 {
                finish(system, substep_s);
                collide::push_out(system);
                predict(system, substep_s);
            }
            let begins_s = system.elapsed_s + f64::from(substep) * substep_s;
            system.scratch.span_s = [begins_s, begins_s + substep_s];
            let scale = force_scale(&system.model, substep_s);
            sweep(system, self.sweeps, [1.0; 2], scale, substep_s)?;
        }
        conclude(system, substep_s, Recorded::SpringForces);
        Ok(())
    }

    /// Returns the largest difference, over all free particles, between the sum of the forces that the last
    /// substep used and the sum of those that the springs have now.
    fn quality(&self, system: &System) -> Quality {
        let (model, x) = (&system.model, &system.positions);
        let miss = |_, by_length, multiplier| by_length + multiplier;
        let residual_n = |particle| {
            let mut sum = Vector::zeros();
            for family in [&model.stretch, &model.bend] {
                pair::add_force_at(family, x, None, particle, miss, &mut sum);
            }
            length(sum)
        };
        let free = (0..x.len()).filter(|&particle| model.inverse_masses[particle] > 0.0);
        Quality::Residual(free.map(residual_n).fold(0.0, f64::max))
    }
}

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
        let check = |setting, given: f64| {
            SettingError::unless((0.0..=1.0).contains(&given), setting, given, "from 0 to 1")
        };
        check("stiffness", self.stiffness)?;
        check("bend_stiffness", self.bend_stiffness)
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        predict(system, dt_s);
        sweep(system, self.sweeps, self.fractions(), 0.0, dt_s)?;
        conclude(system, dt_s, Recorded::RigidForces);
        Ok(())
    }
}

/// Sweeps over all constraints: a part of the errors of stretch and of bend constraints, with the
/// compliances of a step by `scale`; and over pairs that are drawn together. What blew up is left as it is.
fn sweep(
    system: &mut System,
    sweeps: u32,
    fractions: [f64; 2],
    scale: f64,
    substep_s: f64,
) -> Result<(), Failure> {
    let (model, counters) = (&mut system.model, &mut system.counters);
    for sweep in 0..sweeps.max(1) {
        let project = match sweep {
            0 => spring::project::<true>,
            _ => spring::project::<false>,
        };
        let [stretch, bend] = [model.stretch.len() as u64, model.bend.len() as u64];
        counters.visits.project += stretch + bend;
        counters.features.stretch += stretch;
        counters.features.bend += bend;
        let families = [&mut model.stretch, &mut model.bend];
        for (family, fraction) in families.into_iter().zip(fractions) {
            let correction = Correction {
                fraction,
                scale,
                ratio_max: model.stretch_ratio_max,
            };
            for colour in &mut family.colours {
                let (weights, x) = (&model.inverse_masses, &mut system.positions);
                let is_sane = project(colour, weights, correction, x);
                Failure::unless(is_sane)?;
            }
        }
        let (weights, x) = (&model.inverse_masses, &mut system.positions);
        for pair in &model.drawn {
            system.drawn_j += pair.project(&system.scratch.before, substep_s, weights, x);
        }
    }
    Ok(())
}

/// Takes velocities from what was moved in a substep, and makes forces of multipliers: who asks for them
/// asks for those of the last substep.
fn conclude(system: &mut System, substep_s: f64, recorded: Recorded) {
    finish(system, substep_s);
    let model = &mut system.model;
    let scale = force_scale(model, substep_s);
    model.multipliers_mut().for_each(|lambda| *lambda *= scale);
    model.recorded = recorded;
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
