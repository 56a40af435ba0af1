//! Pairs of particles that are drawn together, as the two sides of a seam that is sewn.
//!
//! In each substep an impulse between the two, along the line from one to the other, gives them a speed
//! toward each other. All else is left to the substep, so whatever a method does about contact, loads and holds it does
//! about a pair too. (To move them instead, at the end of a step, sewed through bodies and over short edges. One of
//! 20 µm was drawn to seventy times its length in a step.) An impulse across the line makes angular momentum, so there is
//! one only where two would go faster round each other than toward each other, and never meet.

use tearmesh::geometry::{Point, length};

/// Two particles, and the speed in m/s at which they are drawn together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    pub(crate) ends: [u32; 2],
    pub(crate) speed_m_per_s: f64,
    /// What is added to it since they are pulled apart while they go, in m/s.
    pub(crate) more_m_per_s: f64,
}

impl Drawn {
    /// Projects the pair onto the gap that it is to have at the end of a substep, if it is wider, as if it were a
    /// constraint, and returns the work in joules. By its start one of a method that projects moves nothing heavy.
    pub(crate) fn project(
        &self,
        began: &[Point],
        substep_s: f64,
        inverse_masses: &[f64],
        x: &mut [Point],
    ) -> f64 {
        let [a, b] = self.ends.map(|end| end as usize);
        let way_m = length(began[b] - began[a]).min(self.speed_m_per_s * substep_s);
        let wanted_m = length(began[b] - began[a]) - way_m;
        let apart = x[b] - x[a];
        let excess_m = length(apart) - wanted_m;
        let sum = inverse_masses[a] + inverse_masses[b];
        if excess_m <= 0.0 || sum == 0.0 {
            return 0.0;
        }
        let pull = apart * (excess_m / (length(apart) * sum));
        x[a] += pull * inverse_masses[a];
        x[b] -= pull * inverse_masses[b];
        length(pull) * way_m / (substep_s * substep_s)
    }
}
