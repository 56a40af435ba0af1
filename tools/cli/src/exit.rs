//! How a run ends: the exit statuses, and what stops a verb before its work is done.

use std::process::ExitCode;

use crate::say::Fault;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The run did what it was asked to do.
    Done = 0,
    /// Nothing was cut or mended; for `check`, some file does not hold a mesh that could be cut.
    NothingCut = 1,
    /// The arguments are wrong.
    Usage = 2,
    /// The input cannot be read, or does not hold a valid mesh; for `check`, some file could not be
    /// opened.
    Input = 3,
    /// The rays span no plane.
    NoPlane = 4,
    /// The simulation failed. Its state up to that point was kept.
    Simulation = 5,
    /// An invariant broke inside tearmesh: our bug.
    Bug = 6,
    /// The output cannot be written.
    Output = 7,
    /// The run was interrupted. What had been done was saved.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// A run that ended early, and what has to be said about it.
pub(crate) struct Stop {
    pub(crate) exit: Exit,
    pub(crate) faults: Vec<Fault>,
}

impl Stop {
    pub(crate) fn new(exit: Exit, fault: Fault) -> Stop {
        Stop {
            exit,
            faults: vec![fault],
        }
    }
}
