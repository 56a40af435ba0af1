//! Tests of the command: transcripts, the README's commands, streams and files, and cuts
//! checked against a reader of OBJ that shares no code with ours.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod all_charts;
mod cache;
mod cascades;
mod check;
mod choice;
mod cut;
mod cut_chart;
mod edited;
mod fig7;
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
mod memory;
mod numbers;
mod odd;
mod pages;
mod pareto;
mod parts;
mod pictures;
mod pieces;
mod places;
mod plane;
mod shell;
mod space;
mod stability;
mod step;
mod tear;
mod through;
mod transcripts;
mod units;
mod words;
