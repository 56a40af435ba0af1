//! Implicit time steps in the manner of Baraff and Witkin 1998 ("Large steps in cloth simulation").
//!
//! * [`Implicit`] – backward Euler and BDF2, linearised or with Newton's iterations,
//!   by these [`Settings`],
//! * [`Layout`], [`Hessian`] – the sparse matrix of a system, changed in place when something tears.
//!
//! **When to use it.** When Δt must be far above the explicit limit 2/ω, or to find a state of
//! rest. Backward Euler damps all motion: an oscillation of frequency ω by the factor 1/√(1 +
//! (ωΔt)²) per step. At 60 steps per second an oscillation of 5 Hz loses 99.9 % of its amplitude in
//! a second. BDF2 is of order two and damps far less, by a factor of about 1 − ¼ (ωΔt)⁴ per step.
//! For uniform cloth an explicit method at its limit is cheaper at the same accuracy.
//!
//! **Never silent.** An indefinite matrix, terms that were dropped because of it, halvings of
//! the line search, and the residual are in the [`StepReport`]; a step that fails is an error
//! and leaves positions and velocities as they were.

mod equation;
mod history;
mod layout;
mod newton;
mod pcg;
mod problem;
mod settings;
mod step;

pub use crate::matrix::{Block, Hessian};
pub use layout::Layout;
pub use settings::{Jacobian, Method, Settings, StepError, StepReport, Tolerance, Work};
pub use step::Implicit;
