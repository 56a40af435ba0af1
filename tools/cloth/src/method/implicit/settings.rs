//! The settings of an implicit method, what it did, and the reasons for refusing a step.

use std::fmt;

/// The settings of an implicit method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The time discretisation.
    pub method: Method,
    /// The accuracy T to which a step must be solved, in m/s per s^(p+1), where p is the order of the
    /// method: the rms error of the velocity is at most T Δt^(p+1), as far as the last iterations
    /// say what is left. Where little changes it is also at most a tenth of the change, by energy,
    /// but no less than rounding. Where something touches a collider it is a hundredth of that.
    pub tolerance: f64,
    /// The largest number of conjugate gradient iterations per solve.
    pub solver_iterations_max: u32,
}

impl Default for Settings {
    /// Returns backward Euler, with T = 1 and at most 2000 iterations.
    fn default() -> Settings {
        Settings {
            method: Method::BackwardEuler,
            tolerance: 1.0,
            solver_iterations_max: 2000,
        }
    }
}

/// The time discretisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Backward Euler: of order one, and damps all motion.
    #[default]
    BackwardEuler,
    /// The two-step backward differentiation formula: of order two, and damps little. Where it has
    /// no last step to go on from, a step is one of backward Euler.
    Bdf2,
}

/// What an implicit method did in all steps so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stats {
    /// The number of steps, each part counted of one that was divided because it overshot.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub parts: u64,
    /// The number of parts by backward Euler: with BDF2, those that had no last step to go on from.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub first_order_parts: u64,
    /// The number of matrices that proved to be indefinite, which happens to cloth under
    /// compression.
    pub indefinite: u64,
    /// The number of terms, in the matrices that were used, that had a part dropped because the
    /// matrix was indefinite.
    pub clamped: u64,
    /// The number of conjugate gradient iterations.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub solver_iterations: u64,
    /// The largest error that was left in a part, as an estimated bound on the rms error of the velocity in m/s.
    pub residual_max_m_per_s: f64,
}

/// The reason why an implicit step was not taken. Positions and velocities are unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// The error stayed above the limit that the tolerance sets.
    NotConverged {
        /// The bound on the rms error of the velocity that was reached, in m/s.
        residual: f64,
        /// The bound that the tolerance set, in m/s: a tenth of the change where that is less.
        limit: f64,
        /// The number of conjugate gradient iterations that were spent.
        solver_iterations: u32,
    },
    /// The step overshot, and so did each of 1024 parts of it.
    Overshot,
    /// The step would have moved a particle beyond the coordinates or velocities that are usable.
    NotFinite {
        /// The index of the first such particle.
        particle: usize,
    },
}

impl StepError {
    /// The largest number of parts into which a step that overshoots is divided.
    pub(crate) const PARTS_MAX: u32 = 1024;
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::NotConverged {
                residual,
                limit,
                solver_iterations,
            } => write!(
                f,
                "after {solver_iterations} iterations of conjugate gradients an error of {residual} \
                 m/s is left, above the limit of {limit} m/s"
            ),
            StepError::Overshot => write!(
                f,
                "even a {}th of the step would stretch something by turning it too far",
                StepError::PARTS_MAX
            ),
            StepError::NotFinite { particle } => {
                write!(f, "particle {particle} would be thrown to infinity")
            }
        }
    }
}

impl std::error::Error for StepError {}
