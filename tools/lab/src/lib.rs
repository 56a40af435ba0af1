//! Experiments on tearmesh, and their charts.
//!
//! [`guide`] answers which method to use for which scene. [`pareto`] measures the cost and the error of all
//! methods. [`stability`] measures where methods fail, and whether users are told. [`tear`] measures the forces
//! that tear cloth, and what follows after the first tear. [`step`] answers whether a scene's result depends on its
//! time step. [`cut`] measures the time and the accuracy of cuts.
//! [`fig7`] measures the time to split vertices, as Figure 7 of the paper does.
//!
//! Every experiment has the same shape ([`experiment`]): a plan of runs, a table with a row for each, and a
//! figure of that table. No experiment reads a file or a clock: a clock is an argument. So the same
//! experiment gives the same bytes.

#![forbid(unsafe_code)]

pub mod cut;
mod ensemble;
pub mod experiment;
pub mod fig7;
pub mod guide;
mod method;
pub mod pareto;
mod plain_verlet;
mod plot;
mod reference;
mod rk4;
pub mod sheet;
pub mod stability;
pub mod statistics;
pub mod step;
pub mod tear;

pub use self::method::default_names;
