//! How a run ends: the exit statuses, and what stops a verb before its work is done.

use std::process::ExitCode;

use crate::say::Fault;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    /// Nothing was cut or mended; for `check`, some file is no mesh that could be cut.
    NothingCut = 1,
    /// The arguments make no sense.
    Usage = 2,
    /// The input cannot be read, or is no valid mesh; for `check`, some file could not be opened.
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
