//! A fault in a line, and how it becomes a diagnostic with line, column and text.
//!
//! Parsers know byte offsets within their logical line and nothing else; the place in the
//! file is worked out once something is wrong.

use std::ops::Range;

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

    #[cold]
    #[expect(clippy::boxed_local, reason = "a fault travels in one word")]
    pub(super) fn at(self: Box<Self>, line: &Line<'_>) -> ReadError {
        let (location, excerpt) = locate(line, &self.span);
        let diagnostic = Diagnostic {
            level: Level::Error,
            code: self.code,
            location: Some(location),
            message: self.message,
            excerpt: Some(excerpt.labelled(self.label)),
            help: self.help,
        };
        diagnostic.into()
    }
}

impl Excerpt {
    pub(super) fn labelled(self, label: impl Into<String>) -> Excerpt {
        Excerpt {
            label: label.into(),
            ..self
        }
    }
}

/// How many characters of a long line are shown.
const WINDOW: usize = 160;

/// A logical line without its end; it holds the line ends of continued lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'b> {
    pub(super) bytes: &'b [u8],
    /// The number of its first physical line, from 1.
    pub(super) number: u32,
}

/// Where a part of a logical line is, and the physical line it is on (or a window of it).
#[cold]
pub(super) fn locate(line: &Line<'_>, span: &Range<usize>) -> (Location, Excerpt) {
    let start = span.start.min(line.bytes.len());
    let (before, after) = line.bytes.split_at(start);
    let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let line_start = before.iter().rposition(is_end).map_or(0, |at| at + 1);
    // Far behind the span nothing is shown, and a line may be long.
    let near = after.len().min(span.len() + 4 * WINDOW);
    let line_end = after[..near]
        .iter()
        .position(is_end)
        .map_or(start + near, |at| start + at);
    let ends_before = before[..line_start]
        .iter()
        .enumerate()
        .filter(|&(at, &byte)| byte == b'\n' || byte == b'\r' && before.get(at + 1) != Some(&b'\n'))
        .count();

    let column = 1 + characters(&before[line_start..]).count();
    let length = characters(&line.bytes[start..span.end.clamp(start, line_end)]).count();
    let total = column - 1 + characters(&line.bytes[start..line_end]).count();
    let first_column = if total <= WINDOW {
        1
    } else {
        column.saturating_sub(WINDOW / 2).max(1)
    };
    let text: String = characters(&line.bytes[line_start..line_end])
        .skip(first_column - 1)
        .take(WINDOW)
        .collect();
    let visible = (text.chars().count() + first_column).saturating_sub(column);
    (
        Location {
            line: line.number as usize + ends_before,
            column,
        },
        Excerpt {
            text,
            first_column,
            length: length.min(visible).max(1),
            label: String::new(),
        },
    )
}

/// The characters of bytes, fit for a terminal: U+FFFD stands for what is no UTF-8, and
/// for control characters other than a tab.
fn characters(bytes: &[u8]) -> impl Iterator<Item = char> + '_ {
    let printable = |c: char| {
        if c.is_control() && c != '\t' {
            '\u{fffd}'
        } else {
            c
        }
    };
    bytes.utf8_chunks().flat_map(move |chunk| {
        let replacement = if chunk.invalid().is_empty() {
            None
        } else {
            Some('\u{fffd}')
        };
        chunk.valid().chars().map(printable).chain(replacement)
    })
}

/// A part of a line for a message: lossy, and cut if it is long.
pub(super) fn quoted(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    let mut text: String = characters(bytes).take(SHOWN + 1).collect();
    if text.chars().count() > SHOWN {
        text.pop();
        text.push('…');
    }
    format!("`{text}`")
}
