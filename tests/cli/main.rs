//! Tests of the command: transcripts, the README's commands, streams and files, and cuts
//! checked against a reader of OBJ that shares no code with ours.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod answers;
mod charts;
mod check;
mod cut;
mod edited;
mod files;
mod frames;
mod full;
mod fuzz;
mod gap;
mod guide;
mod harness;
mod in_process;
#[cfg(unix)]
mod killed;
mod map;
#[cfg(target_os = "linux")]
mod memory;
mod names;
mod pages;
mod pieces;
mod play;
#[cfg(target_os = "linux")]
mod progress;
mod read_back;
#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;
mod tear;
mod transcripts;
mod unsewn;
#[path = "../support/vectors.rs"]
mod vectors;
mod words;

use support::{digest, inputs, plain, random};
