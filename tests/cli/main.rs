//! Tests of the command: transcripts, the README's commands, streams and files, and cuts
//! checked against a reader of OBJ that shares no code with ours.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

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
#[cfg(unix)]
mod killed;
mod losses;
mod map;
mod memory;
mod numbers;
mod odd;
mod pages;
mod pictures;
mod pieces;
mod places;
mod play;
#[path = "../support/random.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod random;
mod shell;
mod step;
mod tear;
mod through;
mod transcripts;
mod traps;
mod units;
mod words;
