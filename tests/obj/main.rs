//! Tests of `tearmesh-obj` through its public interface.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod accept;
mod apart;
mod bodies;
mod coincident;
mod collinear;
mod corpus;
mod differential;
mod digits;
mod edited;
mod fuzz;
mod memory;
mod normals;
mod numbers;
mod raw;
mod refuse;
mod repair;
mod round_trip;
mod same_bytes;
mod slides;
mod spelling;
#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;
mod tables;
mod torn;
mod torn_damage;
mod torn_record;
mod triangulate;
mod undone;
#[path = "../support/vectors.rs"]
mod vectors;
mod work;

use proptest::test_runner::Config;

use support::{cases, digest, inputs, plain, random};
use work::{positions, read, rewritten, text, write_as};

/// The settings of every property: no files are written for cases that fail (a find becomes a test of its own).
fn properties() -> Config {
    Config {
        cases: cases::cases().try_into().expect("below 2^32"),
        failure_persistence: None,
        ..Config::default()
    }
}
