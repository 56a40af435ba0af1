//! The watch over energy: whether the method makes any out of nothing.
//!
//! A step below its stability limit is stable for small motions about where the cloth is. What is
//! torn violently does not move little: a spring whose ends fly through each other within a step
//! turns round in it, and its force, which was never felt in between, pushes them apart faster than
//! they came. (At 128 × 128 cells, `rip` by Verlet at 0.67 of the limit: in the 18 ms in which it
//! begins to shatter, 4011 of 22 million steps of a spring turned it by more than 90°. They made
//! 16.6 J, and all others lost 1.4 J. With half the step it was 12 that turned.) So the balance of
//! energy is judged at every frame of 1/60 s; see [`EnergyBalance`].

use crate::method::FRAME_S;
use crate::system::System;
use crate::system::balance::EnergyBalance;

/// The energy that a method made out of nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::scene) struct EnergyGain {
    /// The time at which it was first noticed, in seconds: at most 1/60 s after it exceeded the
    /// margin.
    pub(in crate::scene) since_s: f64,
    /// The largest energy made so far, in joules.
    pub(in crate::scene) made_j: f64,
    /// The largest energy put in so far, in joules: see [`EnergyBalance::put_in_j`].
    pub(in crate::scene) put_in_j: f64,
}

/// Judges the balance frame by frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    /// The steps of a frame.
    pub(super) every: u64,
    /// What rounding may make, in joules.
    least_j: f64,
    /// What the method may make of the energy that was put in.
    share: f64,
    /// The largest values of any frame, and since when more is made than its share of what was put in.
    pub(super) gain: EnergyGain,
    /// Whether more is made.
    pub(super) is_beyond: bool,
}

impl Watch {
    /// What a method may make of the energy that was put in. The energy of Verlet's oscillators
    /// swings about a mean that is larger than what was put into them by (1 − s/2)/(1 − s), where
    /// s = (ωΔt/2)²: at 0.7 of the limit 1.5 for the fastest, in which little of the energy is. It
    /// comes and goes, so that the sum of its rises alone would grow without bound: what is judged is
    /// the balance since the beginning, against the most that was put in by any frame.
    const SHARE: f64 = 0.01;

    /// The same where there are colliders. Contact is of first order: what is pushed out of a tip or an edge in other
    /// directions than it came in by makes up to this, and half of it at half the step.
    const SHARE_IN_CONTACT: f64 = 0.02;

    /// What rounding may make of the energy ½ k L² that all springs would have without length.
    const ROUNDING: f64 = 1e-9;

    pub(super) fn new(system: &System, step_s: f64) -> Watch {
        let springs = system.stretches().springs();
        let collapsed = springs.map(|(_, rest, stiffness)| 0.5 * stiffness * rest * rest);
        let every = (FRAME_S / step_s).round().max(1.0);
        Watch {
            every: every as u64,
            least_j: Watch::ROUNDING * collapsed.sum::<f64>(),
            share: match system.loads().colliders.is_empty() {
                true => Watch::SHARE,
                false => Watch::SHARE_IN_CONTACT,
            },
            gain: EnergyGain::default(),
            is_beyond: false,
        }
    }

    /// Judges a frame. What was made before more was put in may turn out to be within its share.
    pub(super) fn judge(&mut self, elapsed_s: f64, balance: &EnergyBalance) {
        let gain = &mut self.gain;
        gain.made_j = gain.made_j.max(balance.made_j());
        gain.put_in_j = gain.put_in_j.max(balance.put_in_j());
        if !self.is_beyond {
            gain.since_s = elapsed_s;
        }
        self.is_beyond = gain.made_j > self.share * gain.put_in_j + self.least_j;
    }
}
