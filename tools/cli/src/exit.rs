//! Exit statuses, and the early end of a verb.

use std::process::ExitCode;

use crate::say::Fault;

/// The exit status of a run. The discriminant is the exit code of the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The run succeeded.
    Done = 0,
    /// Nothing was cut or mended. For `check`, at least one file does not contain a valid mesh.
    NothingCut = 1,
    /// The arguments are wrong.
    Usage = 2,
    /// The input cannot be read, or does not contain a valid mesh. For `check`, at least one file cannot be
    /// opened.
    Input = 3,
    /// The rays do not span a plane.
    NoPlane = 4,
    /// The simulation failed. Its results up to that point were kept.
    Simulation = 5,
    /// An internal invariant was violated, which is a bug in tearmesh.
    Bug = 6,
    /// The output cannot be written.
    Output = 7,
    /// The run was interrupted. Its results up to that point were saved.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

impl Exit {
    /// The exit status of a run that an error of this code ends.
    fn of(code: &str) -> Exit {
        let family = code.split('-').nth(1).unwrap_or_default();
        match (code, family) {
            (
                "E-RAY-ONE-LINE" | "E-RAY-CROSS" | "E-RAY-SHORT" | "E-RAY-ZERO" | "E-PLANE-ZERO",
                _,
            ) => Exit::NoPlane,
            ("E-IO-WRITE", _) => Exit::Output,
            ("E-SIM-MESH" | "E-MASS", _) => Exit::Input,
            (_, "CHART" | "IO" | "MESH" | "OBJ" | "PLAY") => Exit::Input,
            (_, "MEND") => Exit::NothingCut,
            (_, "SIM") => Exit::Simulation,
            (_, "BUG") => Exit::Bug,
            _ => Exit::Usage,
        }
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

    /// A run whose end the report and the warnings explain.
    pub(crate) fn explained(exit: Exit) -> Stop {
        let faults = Vec::new();
        Stop { exit, faults }
    }

    /// A run that was asked for what cannot be done.
    pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> Stop {
        Fault::error("E-USAGE", message).help(help).into()
    }
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Stop {
        Stop::from(vec![fault])
    }
}

/// The first of several errors decides how the run ends.
impl From<Vec<Fault>> for Stop {
    fn from(faults: Vec<Fault>) -> Stop {
        let exit = Exit::of(faults.first().map_or("", |fault| fault.code));
        Stop { exit, faults }
    }
}
