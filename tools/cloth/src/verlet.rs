//! Velocity Verlet: the accurate explicit method.

use crate::flight::{accelerate, fly, foresee, kick};
use crate::solver::{Abilities, Failure, Solver};
use crate::system::System;

/// Velocity Verlet, of second order and symplectic without drag; one force evaluation a step.
///
/// Stable up to ω Δt = 2, and of wind alone up to λ Δt = 1 ([`wind_rate`](crate::air::wind_rate)). Its oscillators
/// have the frequency ω′ with cos ω′Δt = 1 − (ωΔt)²/2, so it runs fast by up to π/2 at the limit.
/// Drag is taken in by a backward and a forward half step, and wind by a prediction of the
/// velocities that it blows at: both leave the order. Contact is of first order.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verlet(());

impl Verlet {
    /// The method.
    #[must_use]
    pub fn new() -> Verlet {
        Verlet::default()
    }
}

impl Solver for Verlet {
    /// Air by the prediction: z² − (1 − 3μ/2) z − μ/2 has the root −1 at μ = λΔt = 1.
    fn abilities(&self) -> Abilities {
        Abilities::of_forces(Some(2.0), 1.0)
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let half_s = dt_s / 2.0;
        // The last accelerations of the step before are those of now, unless something has
        // changed in between.
        let mut sane = system.scratch.is_fresh || accelerate(system, false);
        fly(system, half_s, dt_s);
        // The velocities at the end of the step, at which wind blows, as far as they are known in its
        // middle: by the accelerations at its beginning. They err by O(Δt²), and so the step by O(Δt³),
        // as without wind. (Those of the middle err by O(Δt).)
        let blows = system.model.loads.wind.is_some();
        if blows {
            foresee(system, half_s);
        }
        sane &= accelerate(system, blows);
        kick(system, half_s);
        system.scratch.is_fresh = system.model.loads.colliders.is_empty();
        Failure::unless(sane)
    }
}
