//! The input and output streams of a run, which need not be those of the process.

use std::io::{Read, Write};

use crate::exit::Exit;
use crate::say::{Color, Fault, Screen, is_colored};

/// The streams that the command reads and writes.
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

impl Streams<'_> {
    /// Shows an error, and ends with this exit status.
    pub(crate) fn fail(&mut self, fault: &Fault, color: Color, exit: Exit) -> Exit {
        let colored = is_colored(color, self.error_is_terminal);
        let mut screen = Screen {
            error: self.error,
            colored,
        };
        // Nowhere is left to complain if standard error is closed.
        let _ = screen.show(fault);
        exit
    }
}

impl std::fmt::Debug for Streams<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Streams").finish_non_exhaustive()
    }
}
