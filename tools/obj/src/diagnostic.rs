//! Diagnostics about a file: refusals, warnings and notes.
//!
//! A [`Diagnostic`] is plain data, so that a program can render it with a caret under the
//! offending text, print it on one line, or put it into a report. It names no file:
//! only the caller knows where the bytes came from.

use std::{fmt, io};

/// One error, warning or note about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The severity of the diagnostic.
    pub level: Level,
    /// The stable code, such as `E-OBJ-FLOAT`. It begins with `E-` for errors, and with `W-` for warnings
    /// and notes.
    pub code: &'static str,
    /// The place in the file; `None` if the diagnostic concerns no single line.
    pub location: Option<Location>,
    /// The message, on one line.
    pub message: String,
    /// The text of the line with the part to underline; `None` if the text is not available.
    pub excerpt: Option<Excerpt>,
    /// A hint on how to solve the problem; `None` if there is no hint.
    pub help: Option<String>,
}

/// The severity of a [`Diagnostic`]. Levels are ordered from the most to the least severe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Level {
    /// The file was refused, or its triangles do not form a mesh.
    Error,
    /// The file was read, but a part of it is not treated as a user may expect.
    Warning,
    /// The file was read, and something harmless was corrected.
    Note,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Location {
    /// The number of the physical line, counted from 1.
    pub line: usize,
    /// The number of the character within the line, counted from 1. A byte that is not UTF-8 counts as
    /// one character.
    pub column: usize,
}

/// The text of a line, and the part of it to underline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The line without its line end, or a window of it if the line is very long. Control
    /// characters and bytes that are not UTF-8 are replaced by U+FFFD.
    pub text: String,
    /// The column of the first character of `text`: 1, unless a window of the line is shown.
    pub first_column: usize,
    /// The number of characters to underline, starting at the column of the [`Location`]. They lie
    /// within `text`, or directly after its end.
    pub length: usize,
    /// The text to show at the underlined part, such as the expected syntax; may be empty.
    pub label: String,
}

impl Diagnostic {
    /// An error of the file with a hint, without an excerpt.
    pub(crate) fn error(
        code: &'static str,
        location: Option<Location>,
        message: String,
        help: &str,
    ) -> Diagnostic {
        Diagnostic {
            level: Level::Error,
            location,
            help: Some(help.to_owned()),
            ..Diagnostic::warning(code, 1, message)
        }
    }

    /// A warning about a line, which has no excerpt and no hint.
    pub(crate) fn warning(code: &'static str, line: usize, message: String) -> Diagnostic {
        Diagnostic {
            level: Level::Warning,
            code,
            location: Some(Location { line, column: 1 }),
            message,
            excerpt: None,
            help: None,
        }
    }
}

impl fmt::Display for Diagnostic {
    /// Writes one line without the code: ``line 3, column 5: cannot read number `0,5` ``.
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
#[non_exhaustive]
pub enum ReadError {
    /// An I/O error occurred while the input was read.
    Input(io::Error),
    /// The file is not valid. The diagnostic describes the first error in it.
    Refused(Box<Diagnostic>),
}

impl ReadError {
    /// Returns the diagnostic of an invalid file; `None` if the input itself failed.
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
            _ => None,
        }
    }
}

impl From<Diagnostic> for ReadError {
    fn from(diagnostic: Diagnostic) -> Self {
        ReadError::Refused(Box::new(diagnostic))
    }
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        ReadError::Input(error)
    }
}
