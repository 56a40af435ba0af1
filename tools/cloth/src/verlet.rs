//! Velocity Verlet: the accurate explicit method.

use tearmesh::geometry::Vector;

use crate::solver::{Failure, Solver};
use crate::system::{Scratch, System};

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
    fn frequency_limit(&self) -> Option<f64> {
        Some(2.0)
    }

    /// By the prediction: z² − (1 − 3μ/2) z − μ/2 has the root −1 at μ = λΔt = 1.
    fn air_limit(&self) -> Option<f64> {
        Some(1.0)
    }

    fn takes_triangles(&self) -> bool {
        true
    }

    fn takes_buckling(&self) -> bool {
        true
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let half = dt_s / 2.0;
        let fade = half * system.model.drag_per_s();
        // The last accelerations of the step before are those of now, unless something has
        // changed in between.
        let mut sane = system.scratch.is_fresh || accelerate(system);
        let blows = system.model.loads.wind.is_some();
        let System {
            positions,
            velocities,
            model,
            scratch,
            ..
        } = system;
        let particles = positions
            .iter_mut()
            .zip(velocities)
            .zip(&scratch.accelerations);
        for (((x, v), a), &w) in particles.zip(&model.inverse_masses) {
            if w > 0.0 {
                *v = (*v + a * half) / (1.0 + fade);
            }
            *x += *v * dt_s;
        }
        if blows {
            predict(system, half, fade);
        }
        sane &= accelerate_by(system, blows);
        let System {
            velocities,
            model,
            scratch,
            ..
        } = system;
        for ((v, a), &w) in velocities
            .iter_mut()
            .zip(&scratch.accelerations)
            .zip(&model.inverse_masses)
        {
            if w > 0.0 {
                *v = *v * (1.0 - fade) + a * half;
            }
        }
        system.scratch.is_fresh = system.model.loads.colliders.is_empty();
        Failure::unless(sane)
    }
}

/// The velocities at the end of a step, as far as they are known in its middle: by the accelerations
/// at its beginning. They err by O(Δt²), and so the step by O(Δt³), as without wind. (Those of the
/// middle err by O(Δt).)
fn predict(system: &mut System, half: f64, fade: f64) {
    let (model, scratch) = (&system.model, &mut system.scratch);
    scratch.predicted.clone_from(&system.velocities);
    let particles = scratch.predicted.iter_mut().zip(&scratch.accelerations);
    for ((v, a), &w) in particles.zip(&model.inverse_masses) {
        if w > 0.0 {
            *v = *v * (1.0 - fade) + a * half;
        }
    }
}

/// The accelerations now, into the scratch room.
pub(crate) fn accelerate(system: &mut System) -> bool {
    accelerate_by(system, false)
}

/// The same, with wind at the velocities as they are or as they were predicted.
fn accelerate_by(system: &mut System, predicted: bool) -> bool {
    let System {
        positions,
        velocities,
        model,
        scratch,
        counters,
        ..
    } = system;
    scratch.is_fresh = false;
    scratch
        .accelerations
        .resize(positions.len(), Vector::zeros());
    let Scratch {
        accelerations,
        predicted: velocities_ahead,
        ..
    } = scratch;
    let velocities = if predicted {
        velocities_ahead
    } else {
        velocities
    };
    model.accelerate(positions, velocities, accelerations, counters)
}
