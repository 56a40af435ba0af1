//! Tests of `tearmesh-cloth` through its public interface.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod air;
mod allocation;
#[cfg(feature = "serde")]
#[path = "../combinations/array.rs"]
#[allow(dead_code, reason = "the other tables print rows by their words")]
mod array;
mod balance;
mod bending;
mod bodies;
mod clamps;
#[cfg(feature = "serde")]
mod combinations;
mod damping;
mod defaults;
mod failures;
mod follow;
mod garments;
mod held;
mod implicit;
mod limiter;
mod meshes;
mod orthotropic;
mod overstretched;
mod parsimony;
mod parts;
#[path = "../../tools/lab/src/plain_verlet.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the experiments")]
mod plain_verlet;
mod reaction;
#[path = "../../tools/lab/src/reference.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the experiments")]
mod reference;
#[cfg(feature = "serde")]
mod refused;
mod ripple;
#[path = "../../tools/lab/src/rk4.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with the experiments")]
mod rk4;
#[cfg(feature = "serde")]
mod scene_file;
mod scenes;
mod second;
mod sewing;
mod simulation;
mod stiff;
mod strain;
#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;
mod sway;
mod tables;
mod tear_log;
mod tearing;
mod tearing_order;
#[path = "../support/vectors.rs"]
mod vectors;
mod watch;
mod wheel;

use support::{digest, plain, random};
