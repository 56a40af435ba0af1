//! The record at the end of a torn file: its lines, and whether it fits the file.
//!
//! A record that is damaged, of a later version, or of other faces than the file has is left
//! out with a warning, and the file read as one without.

use super::fault::{Fault, Line, Parsed, locate};
use super::fits::{forget_corners, misfit, settle};
use super::items::Items;

use super::restore::{join, put_in_place};
use super::scan::Scan;
use super::words::{CODE, damaged, exactly, hexadecimal, nothing_more, version, whole};
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
use crate::document::Document;
use crate::record::{END, HEADER, Hash, ITEM};

/// A record as far as it was read.
#[derive(Debug, Default)]
pub(super) struct RecordReader {
    state: State,
    header: Option<Header>,
    /// How many lines there are between the first and the last, and what they say.
    lines: usize,
    hash: Hash,
    items: Items,
    /// Why there is no record.
    warning: Option<Diagnostic>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Outside,
    Within,
    /// Within one that is no use.
    Skipping,
}

#[derive(Debug)]
struct Header {
    /// Of the faces.
    hash: u64,
    place: (Location, Excerpt),
}

impl RecordReader {
    /// Takes a comment, from `offset` on in its line, if it belongs to a record.
    pub(super) fn takes(&mut self, line: &Line<'_>, offset: usize) -> bool {
        let text = &line.bytes[offset..];
        let begins = |mark: &[u8]| {
            let rest = text.strip_prefix(mark);
            rest.is_some_and(|rest| rest.first().is_none_or(|&next| next == b' '))
        };
        if !text.starts_with(b"#") || text.contains(&0) {
            return false;
        }
        let mut scan = Scan::new(*line);
        let read = if begins(HEADER) {
            scan.go_to(offset + HEADER.len());
            self.header(line, &mut scan)
        } else if begins(END) {
            scan.go_to(offset + END.len());
            self.end(&mut scan)
        } else if begins(ITEM) && self.state != State::Outside {
            if self.state == State::Skipping {
                return true;
            }
            self.lines += 1;
            self.hash.add(text);
            self.hash.add(b"\n");
            scan.go_to(offset + ITEM.len());
            self.items.item(&mut scan)
        } else {
            return false;
        };
        if let Err(fault) = read {
            self.give_up(fault, line);
        }
        true
    }

    #[cold]
    fn give_up(&mut self, fault: Box<Fault>, line: &Line<'_>) {
        if self.state == State::Within {
            self.state = State::Skipping;
        }
        self.items = Items::default();
        if let (None, ReadError::Refused(diagnostic)) = (&self.warning, fault.at(line)) {
            self.warning = Some(Diagnostic {
                level: Level::Warning,
                code: CODE, // A number that cannot be read has another.
                help: Some(match diagnostic.help {
                    Some(help) => format!("{help}; {LEFT_OUT}"),
                    None => without_record(),
                }),
                ..*diagnostic
            });
        }
    }

    fn header(&mut self, line: &Line<'_>, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.at() - HEADER.len();
        self.state = State::Skipping;
        if self.header.is_some() || self.warning.is_some() {
            let message = "this file has two records, and neither is used";
            let fault = Fault::new(CODE, start..scan.at(), message, "begins here");
            return Err(fault.help("after joining files, cut the joined file again"));
        }
        self.items.counts.version = version(scan)?;
        let count = |scan: &mut Scan<'_>| whole(scan, 0, u32::MAX);
        exactly(scan, "v")?;
        self.items.counts.vertices = count(scan)?;
        exactly(scan, "f")?;
        self.items.counts.faces = count(scan)?;
        for (counts, word) in self.items.counts.indices.iter_mut().zip(["vt", "vn"]) {
            exactly(scan, word)?;
            *counts = [count(scan)?, count(scan)?];
        }
        exactly(scan, "faces")?;
        let hash = hexadecimal(scan)?;
        nothing_more(scan)?;
        let place = locate(line, &(start..start + HEADER.len()));
        self.header = Some(Header { hash, place });
        self.state = State::Within;
        Ok(())
    }

    fn end(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.at() - END.len();
        match std::mem::take(&mut self.state) {
            State::Within => {}
            State::Skipping => return Ok(()),
            State::Outside => {
                let message = "a record ends here that has not begun";
                return Err(Fault::new(CODE, start..scan.at(), message, "ends here"));
            }
        }
        if let Some(message) = self.items.wrong_counts() {
            return damaged(scan, start, message);
        }
        let at = scan.token_start();
        if whole(scan, 0, u32::MAX)? as usize != self.lines {
            return damaged(scan, at, "lines of this record are missing or were added");
        }
        let at = scan.token_start();
        if hexadecimal(scan)? != self.hash.0 {
            return damaged(scan, at, "a line of this record was changed");
        }
        nothing_more(scan)
    }

    /// Gives the document its record, if it has one that fits; or says why not.
    pub(super) fn finish(mut self, document: &mut Document) {
        let warning = self.warning.take();
        if let Some(warning) = warning {
            document.diagnostics.push(warning);
            return;
        }
        let Some(header) = self.header.take() else {
            return;
        };
        let misfit = match self.state {
            State::Outside => misfit(&mut self.items, header.hash, document),
            _ => Some("this record has no end, and is not used".to_owned()),
        };
        if let Some(message) = misfit {
            let (location, excerpt) = header.place;
            document.diagnostics.push(Diagnostic {
                location: Some(location),
                excerpt: Some(excerpt.labelled("begins here")),
                help: Some(without_record()),
                ..Diagnostic::warning(CODE, location.line, message)
            });
            return;
        }
        settle(&mut self.items, document);
        forget_corners(document, &mut self.items, header.place.0);
        let Items {
            mut record, fans, ..
        } = self.items;
        put_in_place(document, &mut record, &fans);
        join(document, &mut record, &fans);
        document.record = Some(Box::new(record));
    }
}

/// What becomes of a file whose record is not used.
fn without_record() -> String {
    format!(
        "the file is read as one without a record: what is torn in it cannot be mended, and {LEFT_OUT}"
    )
}

const LEFT_OUT: &str = "the lines of the record will not be written again";
