//! The settings of an implicit step, its report, and the reasons for refusing it.

use std::fmt;

/// The time discretisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Backward Euler: of order one, and damps all motion.
    #[default]
    BackwardEuler,
    /// The two-step backward differentiation formula: of order two, and damps little. The first
    /// step, and each step after [`Implicit::forget`](crate::Implicit::forget), is one of backward
    /// Euler.
    Bdf2,
}

/// The second derivatives that an implicit step uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Jacobian {
    /// Exact derivatives. If the matrix proves to be indefinite, the solve is repeated with the
    /// offending terms dropped.
    #[default]
    UnlessIndefinite,
    /// Exact derivatives. An indefinite matrix is an error.
    Exact,
    /// Derivatives without the terms that may be indefinite (Baraff and Witkin 1998, Choi and Ko
    /// 2002).
    Clamped,
}

/// The accuracy to which the equation of a step must be solved: a bound on the rms error of the
/// velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The bound is T Δt^(p+1), where p is the order of the method, and T is in m/s per s^(p+1). If
    /// forces are small, the bound is at most a tenth of the rms change of velocity that the forces
    /// at the start of the step would make, but no less than rounding.
    Tied(f64),
    /// The bound is this many m/s at every Δt. The error of the simulation then *rises* as Δt
    /// falls.
    Fixed(f64),
}

/// The settings of an implicit method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The time discretisation.
    pub method: Method,
    /// The second derivatives that are used.
    pub jacobian: Jacobian,
    /// The largest number of Newton iterations per step. With 1 a step is linearised, and Newton's
    /// method is used only if that overshoots ([`StepReport::overshot`]). With more, Newton's
    /// method runs until the residual is within the tolerance.
    pub newton_iterations_max: u32,
    /// The tolerance at which the solver may stop.
    pub tolerance: Tolerance,
    /// The largest number of conjugate gradient iterations per solve.
    pub solver_iterations_max: u32,
}

impl Default for Settings {
    /// Returns linearised backward Euler, with a tied tolerance of T = 1 and at most 2000
    /// iterations.
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

/// The report of an implicit step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// The method that was used: backward Euler for the first step of BDF2.
    pub method: Method,
    /// The number of matrices that proved to be indefinite.
    pub indefinite: u32,
    /// The number of terms, in the matrices that were used, that had a part dropped.
    pub clamped: u64,
    /// The number of Newton iterations; 1 for a linearised step.
    pub newton_iterations: u32,
    /// Whether the linearised step ended at a higher potential than it started from, and was taken
    /// back. The step is then the result of up to 50 iterations of Newton's method from the start,
    /// and its residual may be above the limit.
    pub overshot: bool,
    /// The number of times that the line search halved a step.
    pub halvings: u32,
    /// The residual, as a bound on the rms error of the velocity, in m/s. It is that of the linear
    /// equation for a linearised step, and of the nonlinear equation otherwise.
    pub residual: f64,
    /// The residual that the tolerance allowed, in m/s.
    pub limit: f64,
    /// The cost of this step.
    pub work: Work,
}

/// The cost of an implicit step, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// The number of evaluations of all forces.
    pub force_evaluations: u64,
    /// The number of evaluations of all second derivatives.
    pub hessian_evaluations: u64,
    /// The number of evaluations of the energy, for line searches.
    pub energy_evaluations: u64,
    /// The number of products of the matrix with a vector.
    pub matrix_products: u64,
    /// The number of conjugate gradient iterations.
    pub solver_iterations: u64,
}

/// The reason why an implicit step was not taken. Positions, velocities and history are unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepError {
    /// The matrix is indefinite, and [`Jacobian::Exact`] does not allow that.
    Indefinite {
        /// The time step, in seconds. A shorter one helps.
        time_step_s: f64,
    },
    /// The residual stayed above the limit that the tolerance sets.
    NotConverged {
        /// The bound on the rms error of the velocity that was reached, in m/s.
        residual: f64,
        /// The bound that the tolerance set, in m/s.
        limit: f64,
        /// The number of Newton iterations that were spent; 1 for a linearised step.
        newton_iterations: u32,
        /// The total number of conjugate gradient iterations in this step.
        solver_iterations: u64,
    },
    /// The step would have moved a particle beyond the coordinates or velocities that are usable.
    NotFinite {
        /// The index of the first such particle.
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
