//! The integration tests of the library, in one binary.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod exhaustive;
mod figures;
mod fuzz;
mod lockstep;
mod oracle;
mod properties;
mod scissor;
