//! The state of a reader: what has been read so far, how it is counted, and how much there may be.

use std::ops::Range;

use super::decimal::Widths;
use super::fault::{Fault, Parsed};
use super::forward::Forward;
use super::record::RecordReader;
use super::tally::ForeignStatements;
use crate::document::Document;
use crate::store::Kind;

/// What has been read so far.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) document: Document,
    pub(super) forward: [Forward; 3],
    pub(super) tally: ForeignStatements,
    pub(super) record: RecordReader,
    pub(super) widths: Widths,
    /// Whether the corners of the last face had texture coordinates and normals, which those of the
    /// next are likely to have.
    pub(super) corner_kinds: [bool; 2],
    /// How many lines were read.
    pub(super) lines: u32,
}

impl Reader {
    /// How many elements of a kind there are so far.
    #[inline(always)]
    pub(super) fn count(&self, kind: Kind) -> usize {
        self.document.counts()[kind as usize]
    }

    /// The number of the next line.
    pub(super) fn number(&self) -> u32 {
        self.lines.saturating_add(1)
    }
}

/// Refuses what would be more than `most` of something.
#[inline(always)]
pub(super) fn limit(count: usize, most: usize, what: &str) -> Parsed<()> {
    if count < most {
        Ok(())
    } else {
        Err(over_limit(most, what))
    }
}

#[cold]
fn over_limit(most: usize, what: &str) -> Box<Fault> {
    let message = format!("the file has more than {most} {what}");
    Fault::new("E-OBJ-LIMIT", 0..1, message, "one too many")
        .help("split the model into several files")
}

/// The largest index: [`Mesh::MAX_VERTICES`].
const INDEX_MAX: i64 = 1 << 31;

/// An index as counted from 1 from the start of the file, with `count` elements so far.
/// It may lie beyond them.
#[cold]
pub(super) fn absolute(given: i64, count: usize, kind: Kind, span: &Range<usize>) -> Parsed<u32> {
    let [what, _] = kind.names();
    let fault = |code, message, label: &str| Fault::new(code, span.clone(), message, label);
    if given == 0 {
        let message = format!("{what} 0 does not exist: OBJ counts from 1");
        let label = "expected 1 or more, or a negative index to count back";
        let help = "if the program that wrote this counts from 0, add 1 to every index";
        return Err(fault("E-OBJ-ZERO", message, label).help(help));
    }
    if given > INDEX_MAX {
        let message = format!("{what} index beyond the limit of {INDEX_MAX}");
        return Err(fault("E-OBJ-RANGE", message, "too large"));
    }
    let absolute = if given > 0 {
        given
    } else {
        given.saturating_add(count as i64 + 1)
    };
    if absolute > 0 {
        return Ok(absolute as u32);
    }
    let (message, label) = match count {
        0 => (
            format!("{what} {given} does not exist: there are none before this line"),
            "expected an index that does not count back".to_owned(),
        ),
        _ => (
            format!("{what} {given} does not exist: there are {count} before this line"),
            format!("expected -{count} to -1"),
        ),
    };
    let help = "a negative index counts back from its own statement";
    Err(fault("E-OBJ-RANGE", message, &label).help(help))
}

#[cfg(test)]
mod tests {
    use super::super::fault::Line;
    use super::*;

    #[test]
    fn a_limit_is_the_most_that_is_accepted() {
        assert!(limit(2, 3, "vertices").is_ok());
        let fault = limit(3, 3, "vertices").expect_err("over the limit");
        let error = fault.at(&Line {
            bytes: b"v 0 0 0",
            number: 4,
        });
        assert_eq!(
            error.to_string(),
            "line 4, column 1: the file has more than 3 vertices"
        );
        assert_eq!(error.diagnostic().map(|d| d.code), Some("E-OBJ-LIMIT"));
    }
}
