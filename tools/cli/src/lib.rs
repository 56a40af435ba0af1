//! The command `tearmesh` as a function: [`run`] takes arguments and streams, and returns an
//! exit status. The program is a thin shell around it, so that tests and fuzz targets can call
//! the command in their own process.
//!
//! [`guide`] is the guide to the command: how to cut a file, all codes, and all keys of its report and
//! of scene files.
//!
//! Map, from above: `verbs` carry out what is typed, each in a file of its own that no other one uses. `args`
//! defines the arguments, and `choice` the words in them. The rest is shared by the verbs. `session` is for those
//! that change a mesh, `report` is their JSON report, and `picture` and `page` show their results. `rays` reads rays,
//! `cuts` makes scissors of them, `scene` reads scenes, and `simulation` begins to play them. `weld` warns of seams
//! that are not sewn, and sews them. `defects` describes the defects of a mesh, `measure` measures it, and `say`
//! prints diagnostics. `output` writes files atomically, and `files` checks their paths. `bug` writes a reproducer if
//! an invariant is violated. `streams` holds the streams of a run, and `exit` its status.

#![forbid(unsafe_code)]

mod args;
mod bug;
mod choice;
mod cuts;
mod defects;
mod exit;
mod files;
pub mod guide;
mod input;
mod interrupt;
mod measure;
mod output;
mod page;
mod picture;
mod rays;
mod report;
mod say;
mod scene;
mod session;
mod simulation;
mod streams;
mod verbs;
mod weld;

use std::ffi::OsString;

pub use exit::Exit;
pub use interrupt::interrupt;
pub use output::abandon as abandon_output;
pub use streams::Streams;

use args::Args;
use say::Color;

/// Runs the command with these arguments, the first of which is the name of the program. Returns the exit
/// status; all output, including errors, goes to the streams and to the files that the arguments name.
pub fn run(args: impl IntoIterator<Item = OsString>, mut streams: Streams<'_>) -> Exit {
    let args: Vec<OsString> = args.into_iter().collect();
    match Args::read(&args).map(|args| args.verb) {
        Ok(verb) => verbs::run(&verb, &args, &mut streams),
        Err(answer) => {
            let is_help = !answer.use_stderr();
            let is_terminal = match is_help {
                true => streams.output_is_terminal,
                false => streams.error_is_terminal,
            };
            let text = match is_terminal {
                true => answer.render().ansi().to_string(),
                false => answer.render().to_string(),
            };
            if is_help {
                let shown = output::print_text(streams.output, &text).map(|()| Exit::Done);
                return shown
                    .unwrap_or_else(|fault| streams.fail(&fault, Color::Auto, Exit::Output));
            }
            // Nowhere is left to complain if standard error is closed.
            let _ = write!(streams.error, "{text}");
            Exit::Usage
        }
    }
}
