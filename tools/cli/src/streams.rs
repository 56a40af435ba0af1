//! The input and output streams of a run, which need not be those of the process.

use std::collections::BTreeMap;
use std::io::{Read, Write};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::exit::{Exit, Stop};
use crate::output;
use crate::say::{Color, Fault, is_colored};

/// The streams that the command reads and writes.
pub struct Streams<'a> {
    /// The standard input, which is read if an input file is named `-`.
    pub input: &'a mut dyn Read,
    /// The standard output, for the summary, the JSON report, or a file whose name is `-`.
    pub output: &'a mut dyn Write,
    /// The standard error stream, for warnings and errors. It also gets the summary if standard output is
    /// used for the mesh.
    pub error: &'a mut dyn Write,
    /// Whether standard output is a terminal. A mesh is written to a terminal only on request.
    pub output_is_terminal: bool,
    /// Whether standard error is a terminal. Diagnostics on a terminal are coloured by default.
    pub error_is_terminal: bool,
}

/// How many diagnostics of a kind are shown, unless all are asked for.
const SHOWN: usize = 3;

impl Streams<'_> {
    /// Shows what there is to say of some work, and its summary if there is one; gives the exit status.
    pub(crate) fn conclude(
        &mut self,
        worked: Result<String, Stop>,
        mut faults: Vec<Fault>,
        color: Color,
        shows_all: bool,
    ) -> Exit {
        let (exit, words) = match worked {
            Ok(words) => (Exit::Done, words),
            Err(Stop { exit, faults: why }) => {
                faults.extend(why);
                (exit, String::new())
            }
        };
        self.show(&faults, color, shows_all);
        if words.is_empty() {
            return exit;
        }
        match output::print(self.output, |out| writeln!(out, "{words}")) {
            Ok(_) => exit,
            Err(fault) => self.fail(&fault, color, Exit::Output),
        }
    }

    /// A progress bar: on a terminal only, and only if it `is_wanted`.
    pub(crate) fn bar(&self, length: u64, template: &str, is_wanted: bool) -> ProgressBar {
        let target = match is_wanted && self.error_is_terminal {
            true => ProgressDrawTarget::stderr(),
            false => ProgressDrawTarget::hidden(),
        };
        let style = ProgressStyle::with_template(template);
        let style = style.expect("templates are of this program");
        ProgressBar::with_draw_target(Some(length), target).with_style(style)
    }

    /// Shows an error, and ends with this exit status.
    pub(crate) fn fail(&mut self, fault: &Fault, color: Color, exit: Exit) -> Exit {
        self.show(std::slice::from_ref(fault), color, true);
        exit
    }

    /// Shows diagnostics: all of them, or of each kind the first and the last, which can tell of all, and
    /// how many there are between.
    pub(crate) fn show(&mut self, faults: &[Fault], color: Color, all: bool) {
        let colored = is_colored(color, self.error_is_terminal);
        let mut left = BTreeMap::new();
        for fault in faults {
            *left.entry(fault.code).or_insert(0) += 1;
        }
        let totals = left.clone();
        for fault in faults {
            let left = left.entry(fault.code).or_insert(1);
            let (total, number) = (totals[fault.code], totals[fault.code] - *left + 1);
            *left -= 1;
            let is_shown = all || total <= SHOWN || number < SHOWN || number == total;
            let shown = if is_shown {
                fault.render(colored)
            } else if number == SHOWN {
                let (more, code) = (total - SHOWN, fault.code);
                format!("and {more} more of {code}; -v shows all")
            } else {
                continue;
            };
            if writeln!(self.error, "{shown}").is_err() {
                break; // Standard error is closed: nowhere is left to complain.
            }
        }
    }
}

impl std::fmt::Debug for Streams<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Streams").finish_non_exhaustive()
    }
}
