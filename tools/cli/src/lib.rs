//! The command `tearmesh` as a function: [`run`] takes arguments and streams, and gives an
//! exit status. The program is a thin shell round it, so that tests and fuzz targets can call
//! the command in their own process.
//!
//! Map: `args` says what can be typed, `rays` reads rays, `scene` reads scenes, `cut`, `tear`,
//! `mend`, `check` and `chart` carry out the verbs, `session` is what the first three have in
//! common, `report` is their JSON, `defects` shows what is wrong with a mesh, `say` puts
//! diagnostics on a screen, `output` writes files whole or not at all, `files` says where, `bug`
//! writes a reproducer when an invariant broke.

mod args;
mod bug;
mod chart;
mod check;
mod cut;
mod defects;
mod files;
mod input;
mod interrupt;
mod mend;
mod output;
mod rays;
mod report;
mod say;
mod scene;
mod session;
mod tear;

use std::ffi::OsString;
use std::io::{Read, Write};
use std::process::ExitCode;

use clap::Parser as _;

pub use interrupt::interrupt;
pub use output::abandon as abandon_output;

use args::{Args, Verb};

/// Where the command reads and writes.
pub struct Streams<'a> {
    /// Standard input, read where the input is named `-`.
    pub input: &'a mut dyn Read,
    /// Standard output: the summary, the JSON report, or the mesh.
    pub output: &'a mut dyn Write,
    /// Standard error: warnings and errors, and words when the mesh is on standard output.
    pub error: &'a mut dyn Write,
    /// Whether standard output is a terminal, which is no place for a mesh.
    pub output_is_terminal: bool,
    /// Whether standard error is a terminal, which shows colours.
    pub error_is_terminal: bool,
}

impl std::fmt::Debug for Streams<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Streams").finish_non_exhaustive()
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// Nothing was cut or mended; for `check`, some file failed.
    NothingCut = 1,
    /// The arguments make no sense.
    Usage = 2,
    /// The input cannot be read, or is no valid mesh.
    Input = 3,
    /// The rays span no plane.
    NoPlane = 4,
    /// The simulation failed; its state up to there was kept.
    Simulation = 5,
    /// An invariant broke inside tearmesh: our bug.
    Bug = 6,
    /// The output cannot be written.
    Output = 7,
    /// Interrupted, after saving what was done.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// Runs the command with these arguments, the first of which is the program's name.
pub fn run(args: impl IntoIterator<Item = OsString>, mut streams: Streams<'_>) -> Exit {
    let args: Vec<OsString> = args.into_iter().collect();
    let exit = match Args::try_parse_from(args::join_rays(&args)) {
        Ok(Args {
            verb: Verb::Cut(cut),
        }) => cut::run(&cut, &args, &mut streams),
        Ok(Args {
            verb: Verb::Tear(tear),
        }) => tear::run(&tear, &args, &mut streams),
        Ok(Args {
            verb: Verb::Mend(mend),
        }) => mend::run(&mend, &args, &mut streams),
        Ok(Args {
            verb: Verb::Check(check),
        }) => check::run(&check, &mut streams),
        Ok(Args {
            verb: Verb::Chart(chart),
        }) => chart::run(&chart, &mut streams),
        Err(help) if !help.use_stderr() => {
            let text = help.render();
            let shown = if streams.output_is_terminal {
                write!(streams.output, "{}", text.ansi())
            } else {
                write!(streams.output, "{text}")
            };
            output::ignore_closed_pipe(shown)
        }
        Err(error) => {
            let text = error.render();
            // Nowhere is left to complain if standard error is closed.
            let _ = if streams.error_is_terminal {
                write!(streams.error, "{}", text.ansi())
            } else {
                write!(streams.error, "{text}")
            };
            Exit::Usage
        }
    };
    match output::ignore_closed_pipe(streams.output.flush()) {
        Exit::Done => exit,
        failed => failed,
    }
}
