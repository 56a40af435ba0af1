//! Experiments on tearmesh, and their charts.
//!
//! [`tear`] measures the forces that tear cloth. [`pareto`] measures the cost and the error of methods.
//! [`stability`] measures where methods fail, and whether users are told. [`space`] measures whether a finer
//! mesh or a shorter step is the better buy. [`plane`] measures which method is the cheapest at a fixed error,
//! by stiffness and mass ratio. [`cut`] measures the time and the accuracy of cuts. [`fig7`] measures the time
//! to split vertices. [`choice`] measures what choosing a method by scene could save.
//!
//! [`parts`] puts together what was run apart.
//!
//! Each experiment returns its figures as plain data, which can be drawn as SVG and written as CSV. Nothing
//! here reads a file or a clock: a clock is an argument. So the same experiment gives the same bytes.

pub mod choice;
pub mod cut;
mod draw;
pub mod fig7;
pub mod pareto;
pub mod parts;
pub mod plane;
pub mod pool;
mod provenance;
pub mod rk4;
pub mod space;
pub mod stability;
pub mod tear;

pub use provenance::Provenance;
