//! References to elements that come later in the file, or never.
//!
//! A face may precede its vertices, so an index beyond the current count is judged at the
//! end of the file; the first one that is still beyond must then be named with its line, column
//! and text. What is kept is a staircase: only references larger than all before them, since a
//! smaller one fails only if an earlier one does. A step takes 24 bytes and has an index of its
//! own, which takes about as many digits in the file as the logarithm of the number of
//! steps, so the staircase stays within a few times the file. The texts, which would not, are
//! kept within a budget, and then the line and column must do.

use std::ops::Range;

use super::fault::{Line, locate};
use super::source::first_line;
use crate::diagnostic::{Diagnostic, Excerpt, Location, ReadError};
use crate::store::{Kind, push};

/// The most bytes of text that are kept.
const TEXT_BUDGET: usize = 1 << 20;

/// Lines with more bytes are kept no excerpt of, and counted through only once.
const LONG: usize = 64 << 10;

/// The staircase of forward references to one kind of element.
#[derive(Debug, Default)]
pub(super) struct Forward {
    steps: Vec<Step>,
    text: usize,
    /// The last place looked up on a long line: the line, the byte, and its place.
    place: Option<(u32, usize, Location)>,
}

#[derive(Debug)]
pub(super) struct Step {
    /// As in the file, from 1.
    index: u32,
    /// The line and the column.
    pub(super) place: [u32; 2],
    excerpt: Option<Box<Excerpt>>,
}

impl Forward {
    /// Notes a reference to the element `index` (from 1), of which `count` exist so far.
    #[cold]
    pub(super) fn note(&mut self, index: u32, count: usize, line: &Line<'_>, span: Range<usize>) {
        match self.steps.last() {
            Some(last) if last.index as usize <= count => {
                (self.steps, self.text) = Default::default(); // All are there by now.
            }
            Some(last) if last.index >= index => return,
            _ => {}
        }
        let (length, ..) = first_line(&line.bytes[..line.bytes.len().min(LONG + 1)]);
        if length > LONG {
            let location = self.place_on_long_line(line, span.start);
            return self.push(index, location, None);
        }
        let (location, excerpt) = locate(line, &span);
        let fits = self.text + excerpt.text.len() <= TEXT_BUDGET;
        self.text += if fits { excerpt.text.len() } else { 0 };
        self.push(index, location, fits.then(|| Box::new(excerpt)));
    }

    /// The place of a byte, counted from the last place on the same line: a face may have thousands
    /// of references ahead on a line of megabytes.
    fn place_on_long_line(&mut self, line: &Line<'_>, start: usize) -> Location {
        let (from, known) = match self.place {
            Some((number, at, known)) if number == line.number && at <= start => (at, known),
            _ => {
                let line = line.number as usize;
                (0, Location { line, column: 1 })
            }
        };
        let rest = Line {
            bytes: &line.bytes[from..],
            number: known.line as u32,
        };
        let (mut location, _) = locate(&rest, &(start - from..start - from));
        if location.line == known.line {
            location.column += known.column - 1;
        }
        self.place = Some((line.number, start, location));
        location
    }

    fn push(&mut self, index: u32, location: Location, excerpt: Option<Box<Excerpt>>) {
        let step = Step {
            index,
            place: [location.line as u32, location.column as u32],
            excerpt,
        };
        push(&mut self.steps, step);
    }

    /// The first reference beyond the final count.
    pub(super) fn first_beyond(&self, count: usize) -> Option<&Step> {
        self.steps.iter().find(|step| step.index as usize > count)
    }
}

/// The error for an index that no element has, though the whole file is known.
pub(super) fn beyond(kind: Kind, step: &Step, count: usize) -> ReadError {
    let ([what, plural], index) = (kind.names(), step.index);
    let message = match count {
        0 => format!("{what} {index} does not exist: the file has no {plural}"),
        1 => format!("{what} {index} does not exist: the file has 1 {what}"),
        _ => format!("{what} {index} does not exist: the file has {count} {plural}"),
    };
    let label = match count {
        0 => "expected no index here".to_owned(),
        _ => format!("expected 1 to {count}"),
    };
    let help = "indices count from 1 through the whole file, not from each object on";
    let [line, column] = step.place.map(|place| place as usize);
    let location = Location { line, column };
    let excerpt = step.excerpt.as_deref().cloned();
    let excerpt = excerpt.map(|excerpt| excerpt.labelled(label));
    let error = Diagnostic::error("E-OBJ-RANGE", Some(location), message, help);
    Diagnostic { excerpt, ..error }.into()
}
