//! Implicit time steps and states of rest, as Baraff and Witkin 1998 ("Large steps in cloth
//! simulation") made them: pure functions over slices, with no mesh in sight.
//!
//! * [`triangle`] – stretch and shear of a triangle from `w_u` and `w_v`,
//! * [`spring`] – springs with exact derivatives, [`bend`] – Choi and Ko 2002,
//! * [`Layout`], [`Hessian`] – the sparse matrix, changed in place when something tears,
//! * [`Filter`] – held directions; conjugate gradients that respect them,
//! * [`Implicit`] – backward Euler and BDF2, linearised or with Newton's iterations, and
//!   [`Implicit::rest`], the state of rest,
//! * [`damping`] – how much of an oscillation a method swallows.
//!
//! **When to use it.** When Δt has to be far above the explicit limit 2/ω, or for a state of
//! rest. Backward Euler damps everything that moves ([`damping::factor`] says how much); BDF2 is
//! of order two and damps far less. For uniform cloth an explicit method at its limit is
//! cheaper at the same accuracy.
//!
//! **Never silent.** An indefinite matrix, terms that were dropped because of it, halvings of
//! the line search, and the residual are in the [`StepReport`]; a step that fails is an error
//! and leaves positions and velocities as they were.
//!
//! ```
//! use tearmesh::{Point, Vector};
//! use tearmesh_cloth::implicit::{Filter, Implicit, Model, RestSettings, Settings, Spring};
//!
//! // One spring, held at its upper end.
//! let model = Model {
//!     masses: &[0.1, 0.1],
//!     filters: &[Filter::Fixed, Filter::Free],
//!     accelerations: &[Vector::new(0.0, 0.0, -9.81); 2],
//!     springs: &[Spring { ends: [0, 1], rest_length: 1.0, stiffness: 50.0, tension_only: false }],
//!     drag_per_s: 0.5,
//!     ..Model::default()
//! };
//! let mut x = [Point::origin(), Point::new(0.1, 0.0, -1.0)];
//! let mut v = [Vector::zeros(); 2];
//! let mut solver = Implicit::new(&model)?;
//! let report = solver.step(&model, &mut x, &mut v, 1.0 / 60.0, &Settings::default())?;
//! assert!(report.residual <= report.limit && report.clamped == 0);
//!
//! solver.rest(&model, &mut x, &RestSettings::default())?;
//! assert!((x[1].z + 1.0 + 0.1 * 9.81 / 50.0).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bend;
pub mod damping;
mod energy;
mod filter;
mod layout;
mod matrix;
mod model;
mod pcg;
mod rest;
mod settings;
pub mod spring;
mod step;
pub mod triangle;
mod work;

pub use bend::{Bend, BendError, Buckling};
pub use filter::Filter;
pub use layout::Layout;
pub use matrix::{Block, Hessian};
pub use model::{Model, ModelError, Part};
pub use rest::{RestError, RestReport, RestSettings};
pub use settings::{Jacobian, Method, Settings, StepError, StepReport, Tolerance};
pub use spring::Spring;
pub use step::Implicit;
pub use triangle::Triangle;
pub use work::Work;
