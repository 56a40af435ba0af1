//! What came of a cell, and what a user is told of it.

use serde::Serialize;
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};

/// The outcome of a method in a scene at one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// The outcome is right.
    Fine,
    /// The run ended normally with a wrong result.
    Wrong,
    /// The energy grew without bound.
    BlowsUp,
    /// A step was refused, or could not be solved.
    Refused,
}

impl Class {
    /// Returns the outcome in words, in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Class::Fine => "fine",
            Class::Wrong => "wrong",
            Class::BlowsUp => "blows up",
            Class::Refused => "refused",
        }
    }
}

/// A message to a user.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Told {
    /// The code of the message, such as `W-SIM-SOFT`.
    pub code: String,
    /// The text of the message.
    pub words: String,
}

/// The source of messages to users: the command, whose wording is not part of this crate.
pub trait Teller: Sync {
    /// Returns the message about a step that failed, for a user who steps a system.
    fn step(&self, error: &StepError) -> Told;

    /// Returns the messages about a run that has ended, for a user who plays scenes. They include warnings
    /// from before the first step. `error` is the error that ended the run; `None` if it reached its end.
    fn run(&self, run: &Run, frame: &Frame, error: Option<&StepError>) -> Vec<Told>;
}
