//! Rows of a table, outcomes of runs, and the messages that users get about them.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};

use crate::experiment::Status;

/// A limit, a step of a limit, or a scene by one method. An interrupted scene has one row without a method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The kind of the row.
    pub what: RowKind,
    /// The name of the net or of the scene.
    #[serde(rename = "where")]
    pub place: String,
    /// The stiffness of the springs of the net, in N/m.
    pub stiffness_n_per_m: Option<f64>,
    /// The name of the method: for nets the family, for scenes the name on the command line.
    pub method: String,
    /// The step as a multiple of the limit in theory, or of 2/ω if there is no limit.
    pub step_ratio: Option<f64>,
    /// The step in seconds. For a limit it is the shortest step that failed; `None` if none did.
    pub dt_s: Option<f64>,
    /// The largest frequency ω of the net in rad/s, from its dense matrix.
    pub omega_rad_per_s: Option<f64>,
    /// The longest stable step in theory, in seconds; `None` if every step is stable.
    pub theory_s: Option<f64>,
    /// The expected outcome; `None` if theory makes no statement. For a step it is that without the guard.
    pub expected: Option<Class>,
    /// The measured outcome. For a step it is that without the guard.
    pub measured: Option<Class>,
    /// The measured outcome of a step with the guard, which is the default.
    pub watched: Option<Class>,
    /// The largest strain, the relative error of positions, or the largest energy divided by that at the
    /// start, depending on the scene. Smaller is better. `None` if the run failed, or if the scene only has
    /// to end.
    pub measure: Option<f64>,
    /// Whether the outcome is the expected one. A limit agrees only if all its steps do.
    pub agrees: Option<bool>,
    /// Whether the method failed without a message.
    pub is_silent: Option<bool>,
    /// The codes of the messages, with ` | ` between them.
    pub codes: String,
    /// The texts of the messages, with ` | ` between them.
    pub words: String,
    /// The way in which the part of the experiment ended.
    pub status: Status,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    /// A row of something that was not done, to be completed.
    pub(super) fn new(what: RowKind, place: &str, method: &str) -> Row {
        Row {
            what,
            place: place.to_owned(),
            stiffness_n_per_m: None,
            method: method.to_owned(),
            step_ratio: None,
            dt_s: None,
            omega_rad_per_s: None,
            theory_s: None,
            expected: None,
            measured: None,
            watched: None,
            measure: None,
            agrees: None,
            is_silent: None,
            codes: String::new(),
            words: String::new(),
            status: Status::Interrupted,
            why: String::new(),
        }
    }

    pub(super) fn with_messages(self, messages: &[Message]) -> Row {
        let joined =
            |of: fn(&Message) -> &str| messages.iter().map(of).collect::<Vec<_>>().join(" | ");
        Row {
            codes: joined(|message| &message.code),
            words: joined(|message| &message.text),
            ..self
        }
    }
}

/// The kinds of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RowKind {
    /// The limit of a method on a net.
    Limit,
    /// A single step of a method on a net.
    Step,
    /// A scene, played by one method.
    Scene,
}

/// The outcomes of a method in a scene, or on a net at one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// The outcome is right.
    Fine,
    /// The run ended normally with a wrong result.
    Wrong,
    /// The energy grew without bound.
    #[serde(rename = "blows up")]
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

    pub(super) fn of(error: &StepError) -> Class {
        match error {
            StepError::BlowUp { .. } => Class::BlowsUp,
            _ => Class::Refused,
        }
    }
}

/// The source of messages to users: the command, whose wording is not part of this crate.
pub trait Messages: Sync {
    /// Returns the message about a step that failed, for a user who steps a system.
    fn of_step(&self, error: &StepError) -> Message;

    /// Returns the messages about a run that has ended, for a user who plays scenes. They include warnings
    /// from before the first step. `error` is the error that ended the run; `None` if it reached its end.
    fn of_run(&self, run: &Run, frame: &Frame, error: Option<&StepError>) -> Vec<Message>;
}

/// A message to a user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// The code of the message, such as `W-SIM-SOFT`.
    pub code: String,
    /// The text of the message.
    pub text: String,
}
