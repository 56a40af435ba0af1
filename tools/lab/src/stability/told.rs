//! What came of a cell, and what a user is told of it.

use serde::Serialize;
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};

/// What came of a method in some scene at some step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// It did what it should.
    Fine,
    /// It came to its end, somewhere else than it should.
    Wrong,
    /// It has energy that nobody put in, without bound.
    BlowsUp,
    /// It was not done.
    Refused,
}

impl Class {
    /// In words.
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

/// Something that a user is told.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Told {
    /// The code, such as `W-SIM-SOFT`.
    pub code: String,
    /// The words.
    pub words: String,
}

/// Who tells users: the command, whose words are none of this crate's.
pub trait Teller: Sync {
    /// What is said of a step that was not taken, to who takes steps of a system.
    fn step(&self, error: &StepError) -> Told;

    /// What is said of a run that has ended, warnings from before its first step included, to who plays
    /// scenes; with the error that ended it, if one did.
    fn run(&self, run: &Run, frame: &Frame, error: Option<&StepError>) -> Vec<Told>;
}
