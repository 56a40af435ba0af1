//! What has been read so far, and how much there may be.

use super::decimal::Widths;
use super::fault::{Fault, Parsed};
use super::forward::Forward;
use super::index::Element;
use super::record::RecordReader;
use super::tally::ForeignStatements;
use crate::document::Document;

/// What has been read so far.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) document: Document,
    pub(super) forward: [Forward; 3],
    pub(super) tally: ForeignStatements,
    pub(super) record: RecordReader,
    pub(super) widths: Widths,
}

impl Reader {
    /// How many elements of a kind there are so far.
    #[inline]
    pub(super) fn count(&self, element: Element) -> usize {
        match element {
            Element::Vertex => self.document.positions.len(),
            Element::Texture => self.document.texture.len(),
            Element::Normal => self.document.normals.len(),
        }
    }
}

/// Refuses what would be more than `most` of something.
#[inline]
pub(super) fn limit(count: usize, most: usize, what: &str) -> Parsed<()> {
    if count < most {
        Ok(())
    } else {
        Err(over_limit(most, what))
    }
}

#[cold]
fn over_limit(most: usize, what: &str) -> Box<Fault> {
    Fault::new(
        "E-OBJ-LIMIT",
        0..1,
        format!("the file has more than {most} {what}"),
        "one too many",
    )
    .help("split the model into several files")
}

#[cfg(test)]
mod tests {
    use super::super::line::Line;
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
