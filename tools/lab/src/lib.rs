//! Experiments on tearmesh, and their charts.
//!
//! [`rk4`] is the method that references are made by. Each experiment gives its figures as plain
//! data; [`tear`] also draws them as SVG and writes them as CSV. Nothing here reads a file or a clock, so the same experiment gives the same bytes.

mod draw;
pub mod pool;
pub mod rk4;
pub mod tear;
