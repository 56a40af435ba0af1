//! Provot's mass-spring model, the first of the two that the paper tears.
//!
//! Springs along edges and, if there are bend constraints, across them; gravity, drag and wind;
//! symplectic Euler. Then a *limiter* shortens what is stretched by more than 10 %, by moving
//! ends, and velocities are rewritten to what was really moved (Provot 1995, §4–5). Without that
//! rewrite a load that the limit cannot carry makes every step unstable, however short: positions are
//! held while velocities go on to grow.
//!
//! A threshold of stretch has to be held against lengths before the limiter, or nothing ever
//! tears: the limiter leaves where it began behind in the system ([`System::unlimited_ratio`]), and
//! with what it did itself the force that each constraint carried ([`force_n`](crate::force::force_n)).

use crate::method::motion::{force_scale, kick_and_drift};
use crate::method::solver::{Abilities, Failure, Quality, Solver};
use crate::method::spring;
use crate::system::System;
use crate::system::error::SettingError;
use crate::system::force::accelerate;
use crate::system::model::Recorded;

/// Provot's mass-spring model: a step of symplectic Euler, and then a limiter of stretch. It is of
/// first order and takes one force evaluation per step. Springs are stable up to ω Δt = 2, and wind
/// alone up to λ Δt = 2.
#[must_use]
#[derive(Clone, Copy, Debug, Default)]
pub struct Provot {
    /// Infinite without a limiter.
    limiter: Limiter,
    // What it did so far: see [`Quality::Limiter`].
    passes: u64,
    steps_short: u64,
    steps_infeasible: u64,
    excess_max: f64,
    steps_limited: u64,
}

/// The settings of Provot's limiter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limiter {
    /// The largest length of a stretch constraint, as a multiple of its rest length. The default is
    /// 1.1.
    pub stretch_ratio_max: f64,
    /// The largest number of passes over all constraints. The default is 20.
    pub passes_max: u32,
}

impl Default for Limiter {
    fn default() -> Limiter {
        Limiter {
            stretch_ratio_max: 1.1,
            passes_max: 20,
        }
    }
}

impl Provot {
    /// Creates the model with this limiter.
    pub fn new(limiter: Limiter) -> Provot {
        Provot {
            limiter,
            ..Provot::default()
        }
    }

    /// Creates the model without a limiter.
    pub fn unlimited() -> Provot {
        Provot::new(Limiter {
            stretch_ratio_max: f64::INFINITY,
            passes_max: 0,
        })
    }

    fn shorten(&mut self, system: &mut System, dt_s: f64) {
        let limiter = self.limiter;
        let (model, scratch) = (&mut system.model, &mut system.scratch);
        let (positions, counters) = (&mut system.positions, &mut system.counters);
        scratch.is_fresh = false;
        scratch.unlimited.clone_from(positions);
        model.multipliers_mut().for_each(|lambda| *lambda = 0.0);
        let ratio_max = limiter.stretch_ratio_max;
        let (mut passes, mut has_shortened) = (0, false);
        let (mut largest, mut last) = (f64::INFINITY, f64::INFINITY);
        while passes < limiter.passes_max && largest > ratio_max {
            last = largest;
            largest = 0.0;
            counters.visits.project += model.stretch.len() as u64;
            counters.features.stretch += model.stretch.len() as u64;
            for colour in &mut model.stretch.colours {
                let met = spring::limit(colour, &model.inverse_masses, ratio_max, positions);
                largest = largest.max(met);
            }
            has_shortened |= largest > ratio_max;
            passes += 1;
        }
        if has_shortened {
            let moved = positions.iter().zip(&scratch.unlimited);
            for (v, (x, before)) in system.velocities.iter_mut().zip(moved) {
                *v += (x - before) / dt_s;
            }
        }
        let scale = force_scale(model, dt_s);
        model.multipliers_mut().for_each(|lambda| *lambda *= scale);
        model.recorded = Recorded::Limiter;
        self.passes += u64::from(passes);
        self.steps_limited += u64::from(has_shortened);
        if largest > ratio_max {
            let stretches = system.stretches().iter();
            let longest = stretches.map(|id| system.stretch_ratio(id));
            let longest = longest.fold(0.0, f64::max);
            let excess = (longest - ratio_max).max(0.0);
            // Rounding leaves some 1e-14 of an edge that was shortened to the limit.
            let is_short = excess > 1e-9;
            let is_infeasible = is_short && last - largest < 0.01 * excess;
            self.steps_short += u64::from(is_short);
            self.steps_infeasible += u64::from(is_infeasible);
            self.excess_max = self.excess_max.max(excess);
        }
    }
}

impl Solver for Provot {
    fn abilities(&self) -> Abilities {
        Abilities::of_forces(Some(2.0), 2.0)
    }

    fn check(&self) -> Result<(), SettingError> {
        let given = self.limiter.stretch_ratio_max;
        SettingError::unless(given >= 1.0, "stretch_ratio_max", given, "at least 1")
    }

    fn quality(&self, _system: &System) -> Quality {
        Quality::Limiter {
            passes: self.passes,
            steps_short: self.steps_short,
            steps_infeasible: self.steps_infeasible,
            excess_max: self.excess_max,
            steps_limited: self.steps_limited,
        }
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        // What blew up is left as it is, for all to see.
        Failure::unless(accelerate(system, false, None))?;
        kick_and_drift(system, dt_s, dt_s);
        self.shorten(system, dt_s);
        Ok(())
    }
}
