//! The classical Runge–Kutta method: the reference solution.

use tearmesh::geometry::{Point, Vector};

use crate::solver::{Failure, Solver};
use crate::system::System;

/// The classical Runge–Kutta method of fourth order; four force evaluations a step.
///
/// Stable up to ω Δt = 2√2, but damps what lies near, and of wind and drag alone up to λ Δt = 2.785.
/// Held particles move straight on within a
/// step. Keeps room for three more states.
#[derive(Clone, Debug, Default)]
pub struct Rk4 {
    /// The sums of the four slopes.
    moved: Vec<Vector>,
    sped: Vec<Vector>,
    /// Velocities of the stage.
    velocities: Vec<Vector>,
}

impl Rk4 {
    /// The method.
    #[must_use]
    pub fn new() -> Rk4 {
        Rk4::default()
    }
}

/// Where 1 − z + z²/2 − z³/6 + z⁴/24, what the method makes of a velocity that fades, is 1 again.
const REAL: f64 = 2.785_293_563_405_28;

impl Solver for Rk4 {
    fn frequency_limit(&self) -> Option<f64> {
        Some(2.0 * std::f64::consts::SQRT_2)
    }

    fn air_limit(&self) -> Option<f64> {
        Some(REAL)
    }

    fn takes_drag_explicitly(&self) -> bool {
        true
    }

    fn takes_triangles(&self) -> bool {
        true
    }

    fn takes_buckling(&self) -> bool {
        true
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let System {
            positions,
            velocities,
            model,
            scratch,
            counters,
            ..
        } = system;
        let count = positions.len();
        let drag = model.drag_per_s();
        scratch.is_fresh = false;
        scratch.before.resize(count, Point::origin());
        scratch.accelerations.resize(count, Vector::zeros());
        for sums in [&mut self.moved, &mut self.sped] {
            sums.clear();
            sums.resize(count, Vector::zeros());
        }
        scratch.before.copy_from_slice(positions);
        self.velocities.clone_from(velocities);
        let mut sane = true;
        // The weight of each slope, and how far along it the next stage lies.
        for (weight, next) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            let (stage, stage_velocities) = (&mut scratch.before, &mut self.velocities);
            sane &= model.accelerate(
                stage,
                stage_velocities,
                &mut scratch.accelerations,
                counters,
            );
            for i in 0..count {
                let fade = if model.inverse_masses[i] > 0.0 {
                    drag
                } else {
                    0.0
                };
                let (slope, speed) = (
                    stage_velocities[i],
                    scratch.accelerations[i] - stage_velocities[i] * fade,
                );
                self.moved[i] += slope * weight;
                self.sped[i] += speed * weight;
                stage[i] = positions[i] + slope * (next * dt_s);
                stage_velocities[i] = velocities[i] + speed * (next * dt_s);
            }
        }
        for i in 0..count {
            positions[i] += self.moved[i] * (dt_s / 6.0);
            velocities[i] += self.sped[i] * (dt_s / 6.0);
        }
        system.collide();
        Failure::unless(sane)
    }
}
