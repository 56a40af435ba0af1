//! Damping of what is crushed, so that an explicit step makes no energy there.
//!
//! A spring under compression pushes its ends sideways, and one whose ends pass through each other
//! within a step turns round without having pushed at all. Below any stability limit of small
//! motions a crushed sheet makes energy by both: 3 to 3000 times what it had, by plain velocity
//! Verlet at seven tenths of its limit. So whatever is shorter than nine tenths of its rest length
//! is damped along itself, with a ramp to eight tenths, by
//!
//! ```text
//! θ c k Δt,    c = min(1, (1 − l/L − κ)/κ),   κ = 1/10, θ = 1/4
//! ```
//!
//! **Why it is stable.** Let A = Δt² M⁻¹ K and the damping B ≤ θ A, taken in by the velocities of
//! the middle of the step before. With the change δ of positions in a step and δ′ in the next,
//! |δ′|² − ½ δ′Bδ′ + x′Ax changes by −½ (δ′ + δ) B (δ′ + δ), so it never grows, and it is positive
//! where A (1 + 2θ) ≤ 4. [`mass_scaling`](crate::system::mass_scaling) keeps A within 2.6, which makes that 3.9. That is
//! the linear theory; for what is not linear, the table of [`verlet`](crate::method::verlet) is the evidence.
//!
//! At rest it is zero, so it is no part of any tension. It fades with Δt and is physical nowhere:
//! what it takes from the motion is the method's loss.

use tearmesh::geometry::Vector;

/// What is known of a step by those that are crushed in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crush<'a> {
    /// The velocities in the middle of the step.
    pub(crate) velocities: &'a [Vector],
    pub(crate) dt_s: f64,
}

/// κ: what may be lost of the rest length without damping, and again until all of it acts.
const RAMP: f64 = 0.1;

impl Crush<'_> {
    /// θ: the damping as a part of k Δt.
    pub(crate) const SHARE: f64 = 0.25;

    /// The part of its rest length below which something is crushed.
    pub(crate) const BELOW: f64 = 1.0 - RAMP;

    /// What is added to the pull of a spring of this stiffness whose length is such a part of its
    /// rest length, and changes at this speed.
    pub(crate) fn pull(&self, stiffness: f64, ratio: f64, speed: f64) -> f64 {
        let depth = ((1.0 - ratio - RAMP) / RAMP).clamp(0.0, 1.0);
        Crush::SHARE * depth * stiffness * self.dt_s * speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damping_sets_in_without_a_jump_and_acts_both_ways() {
        let crush = Crush {
            velocities: &[],
            dt_s: 0.5,
        };
        assert!(crush.pull(8.0, Crush::BELOW, 1.0).abs() < 1e-15);
        let [half, all, more] = [0.85, 0.8, 0.1].map(|ratio| crush.pull(8.0, ratio, 1.0));
        assert!((half - 0.5).abs() < 1e-12 && (all - 1.0).abs() < 1e-12);
        assert_eq!(more, 1.0);
        assert_eq!(crush.pull(8.0, 0.1, -2.0), -2.0);
    }
}
