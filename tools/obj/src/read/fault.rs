//! A fault in a line, and how it becomes a diagnostic with line, column and text.
//!
//! Parsers know byte offsets within their logical line and nothing else; the place in the
//! file is worked out (`line.rs`) once something is wrong.

use std::ops::Range;

use super::line::{Line, locate};
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};

/// Something that makes a line unacceptable.
#[derive(Debug)]
pub(super) struct Fault {
    code: &'static str,
    /// The bytes meant, from the start of the logical line.
    span: Range<usize>,
    message: String,
    label: String,
    help: Option<String>,
}

/// A result on the fast path: one word.
pub(super) type Parsed<T> = Result<T, Box<Fault>>;

impl Fault {
    #[cold]
    pub(super) fn new(
        code: &'static str,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Box<Fault> {
        Box::new(Fault {
            code,
            span,
            message: message.into(),
            label: label.into(),
            help: None,
        })
    }

    pub(super) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Fault> {
        self.help = Some(help.into());
        self
    }

    /// This fault with its columns shifted by `offset`, for a line that was read only from there
    /// on.
    pub(super) fn after(mut self: Box<Self>, offset: usize) -> Box<Fault> {
        self.span = self.span.start + offset..self.span.end + offset;
        self
    }

    #[cold]
    #[expect(clippy::boxed_local, reason = "a fault travels in one word")]
    pub(super) fn at(self: Box<Self>, line: &Line<'_>) -> ReadError {
        let (location, text) = locate(line, &self.span);
        refuse(
            self.code,
            location,
            self.message,
            Some(text.labelled(self.label)),
            self.help,
        )
    }
}

/// An error of the file.
pub(super) fn refuse(
    code: &'static str,
    location: Location,
    message: String,
    excerpt: Option<Excerpt>,
    help: Option<String>,
) -> ReadError {
    ReadError::Refused(Box::new(Diagnostic {
        level: Level::Error,
        code,
        location: Some(location),
        message,
        excerpt,
        help,
    }))
}

impl Excerpt {
    pub(super) fn labelled(self, label: impl Into<String>) -> Excerpt {
        Excerpt {
            label: label.into(),
            ..self
        }
    }
}
