//! Tests of the command: transcripts, the README's commands, streams and files, and cuts
//! checked against a reader of OBJ that shares no code with ours.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod answers;
mod cache;
mod charts;
mod check;
mod cut;
#[path = "../support/digest.rs"]
mod digest;
mod edited;
mod files;
mod frames;
mod full;
mod fuzz;
mod gap;
mod guide;
mod harness;
mod in_process;
#[path = "../support/inputs.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod inputs;
#[cfg(unix)]
mod killed;
mod map;
#[cfg(target_os = "linux")]
mod memory;
mod pages;
mod pieces;
mod plain;
mod play;
#[cfg(target_os = "linux")]
mod progress;
#[path = "../support/random.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod random;
#[path = "../support/stride.rs"]
mod stride;
mod tear;
mod transcripts;
mod units;
#[path = "../support/vectors.rs"]
mod vectors;
mod words;
