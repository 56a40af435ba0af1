//! Combinations of features, by a table of factors: every three levels of different factors meet in some
//! sequence of verbs, which is judged whole.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod array;
mod naive_array;
#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;

use support::random;
