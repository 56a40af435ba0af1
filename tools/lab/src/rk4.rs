//! The classical Runge–Kutta method, used as a reference solution.

use tearmesh::{Point, Vector};
use tearmesh_cloth::{Abilities, Failure, Solver, System, force};

/// The classical Runge–Kutta method of fourth order, with four force evaluations per step.
///
/// It is stable up to ω Δt = 2√2, but damps motions near that limit. Under wind and drag alone it is stable
/// up to λ Δt = 2.785. Held particles move in a straight line within a step. It stores three more states.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rk4 {
    /// Where the step began.
    start: (Vec<Point>, Vec<Vector>),
    /// The sums of the four slopes.
    sums: (Vec<Vector>, Vec<Vector>),
    accelerations: Vec<Vector>,
}

impl Rk4 {
    /// Returns the method, with no memory allocated yet.
    #[must_use]
    pub(crate) fn new() -> Rk4 {
        Rk4::default()
    }
}

/// Where 1 − z + z²/2 − z³/6 + z⁴/24, what the method makes of a velocity that fades, is 1 again.
const REAL: f64 = 2.785_293_563_405_28;

impl Solver for Rk4 {
    fn abilities(&self) -> Abilities {
        Abilities {
            takes_drag_explicitly: true,
            ..Abilities::of_forces(Some(2.0 * std::f64::consts::SQRT_2), REAL)
        }
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let drag = system.loads().drag_per_s.unwrap_or(0.0);
        let (start, sums) = (&mut self.start, &mut self.sums);
        system.positions().clone_into(&mut start.0);
        system.velocities().clone_into(&mut start.1);
        let count = start.0.len();
        for sums in [&mut sums.0, &mut sums.1] {
            sums.clear();
            sums.resize(count, Vector::zeros());
        }
        let mut sane = true;
        // The weight of each slope, and how far along it the next stage lies.
        for (weight, next) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
            sane &= force::accelerations(system, &mut self.accelerations);
            for i in 0..count {
                let fade = if system.is_held(i) { 0.0 } else { drag };
                let (x, v) = system.state_mut();
                let (slope, speed) = (v[i], self.accelerations[i] - v[i] * fade);
                sums.0[i] += slope * weight;
                sums.1[i] += speed * weight;
                x[i] = start.0[i] + slope * (next * dt_s);
                v[i] = start.1[i] + speed * (next * dt_s);
            }
        }
        let (x, v) = system.state_mut();
        for i in 0..count {
            x[i] = start.0[i] + sums.0[i] * (dt_s / 6.0);
            v[i] = start.1[i] + sums.1[i] * (dt_s / 6.0);
        }
        if sane { Ok(()) } else { Err(Failure::BlowUp) }
    }
}
