//! Position based dynamics, the second model of the paper.
//!
//! Predict, project the constraints so many times, and take as velocity what was moved
//! (Müller et al. 2007). Its constraints are stable at any step, and so is drag; wind, which is that
//! of the velocities before, up to λ Δt = 2 ([`wind_rate`](crate::air::wind_rate)). Never sold as accurate: how
//! stiff it is depends on the step and on the number of sweeps, and as the step goes to zero there
//! is no limit. What it converges to with more sweeps is an inextensible net. Judge it by
//! [`System::strain_rms`].

use tearmesh::geometry::{Point, Vector};

use crate::contact;
use crate::element::Forces;
use crate::solver::{Failure, SettingError, Solver};
use crate::spring;
use crate::system::{Model, System};

/// Position based dynamics. Stiffness of constraints in N/m plays no part: they are rigid, or as
/// soft as [`Pbd::stiffness`] says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pbd {
    /// Sweeps over all constraints a step; none counts as one.
    pub sweeps: u32,
    /// The part of an error that a step corrects, 0 to 1, whatever the number of
    /// sweeps: each corrects 1 − (1 − k)^(1/n) (Müller et al. 2007, §3.3).
    pub stiffness: f64,
    /// The same of bend constraints.
    pub bend_stiffness: f64,
}

impl Default for Pbd {
    /// Ten sweeps, rigid stretch constraints, and bend constraints of 0.1.
    fn default() -> Pbd {
        Pbd {
            sweeps: 10,
            stiffness: 1.0,
            bend_stiffness: 0.1,
        }
    }
}

impl Pbd {
    /// The method with rigid constraints and so many sweeps.
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
    fn check(&self) -> Result<(), SettingError> {
        for (setting, given) in [
            ("stiffness", self.stiffness),
            ("bend_stiffness", self.bend_stiffness),
        ] {
            SettingError::unless((0.0..=1.0).contains(&given), setting, given, "0 to 1")?;
        }
        Ok(())
    }

    fn air_limit(&self) -> Option<f64> {
        Some(2.0)
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
            for (family, fraction) in [(&mut model.stretch, stretch), (&mut model.bend, bend)] {
                for (batch, memories) in family.batches_mut() {
                    counters.projections += batch.ends.len() as u64;
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
        model.scale_multipliers((1.0 + dt_s * model.drag_per_s()) / (dt_s * dt_s));
        model.forces = Forces::Multipliers;
        finish(system, dt_s);
        Ok(())
    }
}

/// Moves all particles as if there were no constraint, and keeps where they were. Velocities stay
/// those of before: [`finish`] takes new ones from the positions.
pub(crate) fn predict(system: &mut System, dt_s: f64) {
    let System {
        positions,
        velocities,
        model,
        scratch,
        counters,
        ..
    } = system;
    scratch.is_fresh = false;
    scratch.before.resize(positions.len(), Point::origin());
    let accelerations = &mut scratch.accelerations;
    if model.loads.wind.is_some() {
        accelerations.clear();
        accelerations.resize(positions.len(), Vector::zeros());
        model.external(positions, velocities, accelerations, counters);
    }
    let flight = Flight::new(model, dt_s);
    let particles = positions.iter_mut().zip(&mut scratch.before);
    let particles = particles.zip(&*velocities).zip(&model.inverse_masses);
    if model.loads.wind.is_some() {
        for ((((x, before), v), &w), &a) in particles.zip(&*accelerations) {
            *before = *x;
            *x += flight.moved(*v, a, w);
        }
    } else {
        // Without wind, all accelerations are one.
        for (((x, before), v), &w) in particles {
            *before = *x;
            *x += flight.moved(*v, flight.gravity, w);
        }
    }
}

/// Takes as velocity what was moved.
pub(crate) fn finish(system: &mut System, dt_s: f64) {
    let per_s = 1.0 / dt_s;
    let moves = system.positions.iter().zip(&system.scratch.before);
    for (v, (x, before)) in system.velocities.iter_mut().zip(moves) {
        *v = (x - before) * per_s;
    }
}

/// [`finish`], the push of colliders, and [`predict`] of the next substep: in one pass where nobody
/// asks for velocities in between.
pub(crate) fn finish_and_predict(system: &mut System, dt_s: f64) {
    if system.model.loads.wind.is_some() || !system.model.loads.colliders.is_empty() {
        finish(system, dt_s);
        contact::push_out(system);
        predict(system, dt_s);
        return;
    }
    let per_s = 1.0 / dt_s;
    let flight = Flight::new(&system.model, dt_s);
    let particles = system.positions.iter_mut().zip(&mut system.scratch.before);
    for ((x, before), &w) in particles.zip(&system.model.inverse_masses) {
        let v = (*x - *before) * per_s;
        *before = *x;
        *x += flight.moved(v, flight.gravity, w);
    }
}

/// A substep without constraints.
struct Flight {
    gravity: Vector,
    /// The part of a velocity that drag leaves.
    keep: f64,
    dt_s: f64,
}

impl Flight {
    fn new(model: &Model, dt_s: f64) -> Flight {
        Flight {
            gravity: model.gravity(),
            keep: 1.0 / (1.0 + dt_s * model.drag_per_s()),
            dt_s,
        }
    }

    /// How far a particle flies.
    fn moved(&self, v: Vector, acceleration: Vector, inverse_mass: f64) -> Vector {
        if inverse_mass > 0.0 {
            (v + acceleration * self.dt_s) * self.keep * self.dt_s
        } else {
            v * self.dt_s
        }
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
