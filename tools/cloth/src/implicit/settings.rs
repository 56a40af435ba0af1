//! How a step is to be taken, what is told about it, and why it is refused.

use std::fmt;

/// How time is made discrete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Order one, damps everything.
    #[default]
    BackwardEuler,
    /// Order two, damps little. The first step, and each after
    /// [`Implicit::forget`](crate::Implicit::forget), is backward Euler's.
    Bdf2,
}

/// Which second derivatives are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jacobian {
    /// Exact ones; where the matrix shows that it is indefinite, once more with the offending
    /// terms dropped.
    #[default]
    UnlessIndefinite,
    /// Exact ones; an indefinite matrix is an error.
    Exact,
    /// Always without the terms that may be indefinite: Baraff and Witkin 1998, Choi and Ko
    /// 2002.
    Clamped,
}

/// How exactly a step's equation has to be solved: a bound on the rms error of the velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// T Δt^(p+1), with p the order of the method; T in m/s per s^(p+1). Less where little acts: a
    /// tenth of what all forces where the step begins would make of the velocities, Δt a or the part
    /// of that which drag leaves, by the rms; but no less than rounding.
    Tied(f64),
    /// The same at every Δt, in m/s. The error then *rises* as Δt falls.
    Fixed(f64),
}

/// How to take a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Which method.
    pub method: Method,
    /// Which second derivatives.
    pub jacobian: Jacobian,
    /// 1: linearised, and Newton's method only where that overshoots ([`StepReport::overshot`]).
    /// More: Newton's method until the residual is within the tolerance.
    pub newton_iterations_max: u32,
    /// When the solver may stop.
    pub tolerance: Tolerance,
    /// How many iterations of conjugate gradients a solve may take.
    pub solver_iterations_max: u32,
}

impl Default for Settings {
    /// Backward Euler, linearised; T = 1; 2000 iterations.
    fn default() -> Settings {
        Settings {
            method: Method::BackwardEuler,
            jacobian: Jacobian::UnlessIndefinite,
            newton_iterations_max: 1,
            tolerance: Tolerance::Tied(1.0),
            solver_iterations_max: 2000,
        }
    }
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// The method that was used: backward Euler for the first step of BDF2.
    pub method: Method,
    /// How many matrices showed that they are indefinite.
    pub indefinite: u32,
    /// How many terms of matrices that were used had a part dropped.
    pub clamped: u64,
    /// Newton's iterations; 1 if linearised.
    pub newton_iterations: u32,
    /// Whether the linearised step ended above the potential that it started from, and was
    /// taken back: the step is then that of Newton's method, as far as that came in 50 iterations
    /// from where the step started. Its residual may be above the limit.
    pub overshot: bool,
    /// Halvings of the line search.
    pub halvings: u32,
    /// The residual as a bound on the rms error of the velocity, in m/s: of the linear
    /// equation if linearised, of the nonlinear one if not.
    pub residual: f64,
    /// What the tolerance allowed, in m/s.
    pub limit: f64,
    /// What this step cost.
    pub work: Work,
}

/// What was done, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How often all forces were computed.
    pub force_evaluations: u64,
    /// How often all second derivatives were.
    pub hessian_evaluations: u64,
    /// How often the energy was, for line searches.
    pub energy_evaluations: u64,
    /// Products of the matrix and a vector.
    pub matrix_products: u64,
    /// Iterations of conjugate gradients.
    pub solver_iterations: u64,
}

/// Why a step was not taken. Positions, velocities and history are as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepError {
    /// The matrix is indefinite, and [`Jacobian::Exact`] was asked for.
    Indefinite {
        /// The time step, in s: a shorter one helps.
        time_step_s: f64,
    },
    /// The residual stayed above what the tolerance allows.
    NotConverged {
        /// The bound on the rms error of the velocity that was reached, in m/s.
        residual: f64,
        /// The bound that was asked for, in m/s.
        limit: f64,
        /// Newton's iterations that were spent; 1 if linearised.
        newton_iterations: u32,
        /// The iterations of conjugate gradients in all of them.
        solver_iterations: u64,
    },
    /// The step would have thrown this particle to infinity.
    NotFinite {
        /// The first such particle.
        particle: usize,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::Indefinite { time_step_s } => {
                write!(f, "the matrix is indefinite at a step of {time_step_s} s")
            }
            StepError::NotConverged {
                residual,
                limit,
                newton_iterations,
                solver_iterations,
            } => write!(
                f,
                "after {newton_iterations} iterations of Newton and {solver_iterations} of conjugate \
                 gradients an error of {residual} m/s is left, above the limit of {limit} m/s"
            ),
            StepError::NotFinite { particle } => {
                write!(f, "particle {particle} would be thrown to infinity")
            }
        }
    }
}

impl std::error::Error for StepError {}
