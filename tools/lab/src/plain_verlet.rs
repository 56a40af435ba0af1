//! Velocity Verlet as in textbooks, with which the guards of the product's are compared.

use tearmesh::{Point, Vector};
use tearmesh_cloth::{Abilities, Failure, Solver, System, force};

/// Velocity Verlet without guards: of second order, and symplectic without drag; one force evaluation per step.
///
/// It is stable for small motions up to ω Δt = 2, and for wind alone up to λ Δt = 1. Its oscillators have the
/// frequency ω′ with cos ω′Δt = 1 − (ωΔt)²/2, so it runs fast by up to π/2 at the limit. Crushed springs make
/// energy below every limit. Drag is applied in a forward and a backward half step, and wind at velocities that
/// are predicted, which keeps the second order.
///
/// A step goes on with the forces at the end of the last one if every particle is still there. So constraints
/// and loads must not change between two steps of one solver unless a particle moves.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlainVerlet {
    accelerations: Vec<Vector>,
    /// Where the last step ended.
    reached: Vec<Point>,
    /// The velocities in the middle of the step.
    halfway: Vec<Vector>,
}

impl PlainVerlet {
    /// Returns the method, with no memory allocated yet.
    #[must_use]
    pub(crate) fn new() -> PlainVerlet {
        PlainVerlet::default()
    }

    /// Speeds free particles up for half a step, by `change` of velocity and acceleration.
    fn kick(&self, system: &mut System, change: impl Fn(Vector, Vector) -> Vector) {
        for (i, a) in self.accelerations.iter().enumerate() {
            if system.inverse_masses()[i] > 0.0 {
                let (_, v) = system.state_mut();
                v[i] = change(v[i], *a);
            }
        }
    }
}

impl Solver for PlainVerlet {
    fn abilities(&self) -> Abilities {
        Abilities::of_forces(Some(2.0), 1.0)
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let half_s = dt_s / 2.0;
        let slowed = half_s * system.loads().drag_per_s.unwrap_or(0.0);
        let goes_on = self.reached == system.positions();
        let began_sane = goes_on || force::accelerations(system, &mut self.accelerations);
        self.kick(system, |v, a| (v + a * half_s) / (1.0 + slowed));
        let (x, v) = system.state_mut();
        for (x, v) in x.iter_mut().zip(v) {
            *x += *v * dt_s;
        }
        let second_half = |v: Vector, a: Vector| v * (1.0 - slowed) + a * half_s;
        if system.loads().wind.is_some() {
            // The velocities at the end, as far as they are known in the middle: they err by O(Δt²).
            system.velocities().clone_into(&mut self.halfway);
            self.kick(system, second_half);
        }
        let is_sane = force::accelerations(system, &mut self.accelerations);
        if system.loads().wind.is_some() {
            system.state_mut().1.copy_from_slice(&self.halfway);
        }
        self.kick(system, second_half);
        system.positions().clone_into(&mut self.reached);
        if began_sane && is_sane {
            Ok(())
        } else {
            Err(Failure::BlowUp)
        }
    }
}
