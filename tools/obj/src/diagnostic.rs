//! What there is to say about a file: refusals, warnings and notes.
//!
//! A [`Diagnostic`] is plain data, so that a program can render it with a caret under the
//! offending text, print it on one line, or put it into a report. It names no file:
//! only the caller knows where the bytes came from.

use std::{fmt, io};

/// One thing to say about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub level: Level,
    /// A stable name such as `E-OBJ-FLOAT`: `E-` errors, `W-` warnings and notes.
    pub code: &'static str,
    /// Where it is; `None` where it concerns no single line.
    pub location: Option<Location>,
    /// What is the matter, in one line.
    pub message: String,
    /// The text of the line, with what to underline; `None` where the text is not at hand.
    pub excerpt: Option<Excerpt>,
    /// What to do about it.
    pub help: Option<String>,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Level {
    /// The file was refused.
    Error,
    /// The file was read, but something in it will not be treated as one may expect.
    Warning,
    /// The file was read, and something harmless was set right.
    Note,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Location {
    /// The physical line, from 1.
    pub line: usize,
    /// The character of that line, from 1. A byte that is no UTF-8 counts as a character.
    pub column: usize,
}

/// The text of a line, and the part of it that is meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The line without its end, or a window of it if it is very long.
    /// Bytes that are no UTF-8, and control characters, show as U+FFFD.
    pub text: String,
    /// The column of the first character of `text`: 1, unless the line was cut.
    pub first_column: usize,
    /// How many characters are meant, from the column of the [`Location`] on;
    /// they lie within `text`, or directly behind its end.
    pub length: usize,
    /// What was expected there; may be empty.
    pub label: String,
}

impl fmt::Display for Diagnostic {
    /// One line without the code: ``line 3, column 5: cannot read number `0,5` ``.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Location { line, column }) = self.location {
            match self.excerpt {
                Some(_) => write!(f, "line {line}, column {column}: ")?,
                None => write!(f, "line {line}: ")?,
            }
        }
        f.write_str(&self.message)
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Level::Error => "error",
            Level::Warning => "warning",
            Level::Note => "note",
        })
    }
}

/// Why a file could not be read.
#[derive(Debug)]
pub enum ReadError {
    /// The bytes themselves could not be had.
    Input(io::Error),
    /// The bytes are not what a strict reader accepts. The first offender is named.
    Refused(Box<Diagnostic>),
}

impl ReadError {
    /// What is wrong with the file; `None` if its bytes could not be had.
    #[must_use]
    pub fn diagnostic(&self) -> Option<&Diagnostic> {
        match self {
            ReadError::Input(_) => None,
            ReadError::Refused(diagnostic) => Some(diagnostic),
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReadError::Input(error) => write!(f, "cannot read: {error}"),
            ReadError::Refused(diagnostic) => diagnostic.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ReadError::Input(error) => Some(error),
            ReadError::Refused(_) => None,
        }
    }
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        ReadError::Input(error)
    }
}
