//! Experiments on tearmesh, and their charts.
//!
//! [`tear`] is about what it takes to tear, [`pareto`] about what methods cost and how far they are
//! off, [`stability`] about where methods fail and what one is told then, [`cut`] about what cuts take
//! and how straight they are, [`fig7`] about the time that splitting vertices takes, and [`ensemble`] about
//! what many runs of one scene have in common. Each experiment gives its figures as plain data, which are also drawn as SVG and written as CSV. Nothing here
//! reads a file or a clock (one that is wanted comes in as an argument), so the same experiment gives the
//! same bytes. [`rk4`] is a method for experiments alone.

pub mod cut;
mod draw;
pub mod ensemble;
pub mod fig7;
pub mod pareto;
pub mod pool;
mod provenance;
mod random;
pub mod rk4;
mod sample;
pub mod stability;
pub mod tear;

pub use provenance::Provenance;
