//! Statements that are carried through as bytes.

use super::fault::{Fault, Line, Parsed};
use super::reader::{Reader, absolute};
use super::scan::Scan;
use super::source::first_line;
use crate::keyword::{Class, tokens_before_indices};
use crate::store::{Kind, extend, push};

impl Reader {
    /// Carries a line through that begins with none of `v`, `vt`, `vn`, `f` and `fo`; its keyword,
    /// if it has one, starts there.
    pub(super) fn carry(&mut self, line: &Line<'_>, start: usize, keyword: &[u8]) -> Parsed<()> {
        if let Some(control) = keyword.iter().position(|byte| byte.is_ascii_control()) {
            return Err(binary(start + control, keyword[control]));
        }
        if keyword.is_empty() && self.record.takes(line, start) {
            return Ok(());
        }
        if !keyword.is_empty() && Class::of(keyword) != Class::Structure {
            let shown = &keyword[..keyword.len().min(40)];
            self.tally.count(shown, line, start);
            if let Some(skipped) = tokens_before_indices(keyword) {
                let scan = Scan::new(*line).moved_to(start + keyword.len());
                if let Some(bytes) = self.absolute_indices(scan, skipped)? {
                    self.tally.count_relative(keyword, line, start);
                    let bytes = &bytes[..];
                    return self.push_text(&Line { bytes, ..*line }, 0);
                }
            }
        }
        self.push_text(line, 0)
    }

    /// The line with its relative indices made absolute; `None` if it has none.
    ///
    /// A relative index counts the vertices before it, and a cut may put more there.
    fn absolute_indices(&self, mut scan: Scan<'_>, skipped: usize) -> Parsed<Option<Vec<u8>>> {
        let mut bytes = Vec::new();
        let mut copied = 0;
        let mut token_number = 0;
        while scan.find_token() {
            let end = scan.at() + scan.token().len();
            let mut element = 0;
            while token_number >= skipped && scan.at() < end && element < 3 {
                let start = scan.at();
                let counted = Kind::INDEXED[element];
                if let Some(given @ ..0) = scan.integer()
                    && (scan.at_token_end() || scan.peek() == Some(b'/'))
                {
                    let index = absolute(given, self.count(counted), counted, &(start..scan.at()))?;
                    bytes.extend_from_slice(&scan.line.bytes[copied..start]);
                    bytes.extend_from_slice(index.to_string().as_bytes());
                    copied = scan.at();
                }
                if scan.peek() != Some(b'/') {
                    break;
                }
                scan.skip(1);
                element += 1;
            }
            scan.go_to(end);
            token_number += 1;
        }
        if copied == 0 {
            return Ok(None);
        }
        bytes.extend_from_slice(&scan.line.bytes[copied..]);
        Ok(Some(bytes))
    }

    /// Keeps a comment behind a statement as a line of its own; where the next line starts.
    #[cold]
    #[inline(never)]
    pub(super) fn comment<'l>(&mut self, scan: Scan<'l>) -> Parsed<&'l [u8]> {
        let (line, at) = (scan.line, scan.at());
        let (length, behind, _) = first_line(scan.rest);
        let bytes = &line.bytes[..at + length];
        let line = Line { bytes, ..line };
        if length > 0 && !self.record.takes(&line, at) {
            self.push_text(&line, at)?;
        }
        Ok(&scan.rest[behind..])
    }

    /// Keeps the bytes of a line from a place on, with `\n` for every line end.
    fn push_text(&mut self, line: &Line<'_>, start: usize) -> Parsed<()> {
        let text = &mut self.document.text;
        let before = text.len();
        let mut rest = &line.bytes[start..];
        while let Some(at) = memchr::memchr2(b'\r', 0, rest) {
            if rest[at] == 0 {
                return Err(binary(line.bytes.len() - rest.len() + at, 0));
            }
            extend(text, &rest[..at]);
            push(text, b'\n');
            rest = &rest[at + 1..];
            rest = rest.strip_prefix(b"\n").unwrap_or(rest);
        }
        extend(text, rest);
        push(text, b'\n');
        let length = text.len() - before;
        self.document.layout.push_text(length, line.number);
        Ok(())
    }
}

/// The error for bytes that no text has.
#[cold]
pub(super) fn binary(at: usize, byte: u8) -> Box<Fault> {
    let message = format!("this is binary data, not an OBJ file (byte 0x{byte:02x})");
    Fault::new("E-OBJ-BINARY", at..at + 1, message, "expected text")
        .help("binary formats such as glTF (.glb), STL or FBX must be converted to OBJ first")
}
