//! Statements that are carried through as bytes, and what is said about them.

use super::Reader;
use super::face::Element;
use super::face::absolute;
use super::fault::{Fault, Parsed};
use super::line::{Line, locate, quoted};
use super::lines::logical_line_length;
use super::scan::Scan;
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location};
use crate::keyword::{Class, is_said_of_vertex, tokens_before_indices};
use crate::store::{extend, push};

/// The most keywords that are reported by name.
const KEYWORDS_MAX: usize = 32;

/// Which uninterpreted statements there are.
#[derive(Debug, Default)]
pub(super) struct Tally {
    keywords: Vec<Counted>,
    /// Statements with keywords beyond [`KEYWORDS_MAX`].
    others: usize,
    /// Statements whose relative indices were made absolute.
    relative: Option<Counted>,
    /// The first keyword of the file that was not known.
    pub(super) first: Option<Vec<u8>>,
}

#[derive(Debug)]
struct Counted {
    keyword: Vec<u8>,
    count: usize,
    location: Location,
    excerpt: Excerpt,
}

impl Tally {
    fn count(&mut self, keyword: &[u8], line: &Line<'_>, start: usize) {
        if let Some(known) = self
            .keywords
            .iter_mut()
            .find(|known| known.keyword == keyword)
        {
            known.count += 1;
        } else if self.keywords.len() < KEYWORDS_MAX {
            self.keywords.push(Counted::new(keyword, line, start));
        } else {
            self.others += 1;
        }
    }

    /// A warning for each keyword, in the order in which they were met.
    pub(super) fn report(self, diagnostics: &mut Vec<Diagnostic>) {
        for counted in self.keywords {
            let (keyword, statements) = (quoted(&counted.keyword), counted.statements());
            let (code, message) = match Class::of(&counted.keyword) {
                Class::Element => (
                    "W-OBJ-ELEMENT",
                    format!("{keyword} elements are kept, but never cut ({statements})"),
                ),
                _ if is_said_of_vertex(&counted.keyword) => (
                    "W-OBJ-FOREIGN",
                    format!(
                        "{keyword} is not interpreted, and kept with its vertex and the \
                         copies of that ({statements})"
                    ),
                ),
                _ => (
                    "W-OBJ-FOREIGN",
                    format!("{keyword} is not interpreted, and kept as it is ({statements})"),
                ),
            };
            diagnostics.push(counted.warn(Level::Warning, code, message));
        }
        if self.others > 0 {
            diagnostics.push(Diagnostic {
                level: Level::Warning,
                code: "W-OBJ-FOREIGN",
                location: None,
                message: format!(
                    "and {} more statements that are not interpreted",
                    self.others
                ),
                excerpt: None,
                help: None,
            });
        }
        if let Some(counted) = self.relative {
            let message = format!(
                "negative indices of {} were made absolute ({})",
                quoted(&counted.keyword),
                counted.statements()
            );
            diagnostics.push(counted.warn(Level::Note, "W-OBJ-RELATIVE", message));
        }
    }
}

impl Counted {
    fn new(keyword: &[u8], line: &Line<'_>, start: usize) -> Counted {
        let (location, excerpt) = locate(line, &(start..start + keyword.len()));
        Counted {
            keyword: keyword.to_vec(),
            count: 1,
            location,
            excerpt,
        }
    }

    fn statements(&self) -> String {
        match self.count {
            1 => "1 statement".to_owned(),
            count => format!("{count} statements, the first here"),
        }
    }

    fn warn(self, level: Level, code: &'static str, message: String) -> Diagnostic {
        let (location, excerpt) = (Some(self.location), Some(self.excerpt));
        Diagnostic {
            level,
            code,
            location,
            message,
            excerpt,
            help: None,
        }
    }
}

impl Reader {
    /// Carries a line through that begins with none of `v`, `vt`, `vn`, `f` and `fo`; the cursor
    /// stands at its keyword, if it has one.
    pub(super) fn carry(&mut self, line: &Line<'_>, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.at;
        let keyword = scan.token();
        if let Some(control) = keyword.iter().position(|byte| byte.is_ascii_control()) {
            return Err(binary(start + control, keyword[control]));
        }
        if keyword.is_empty() && self.record.takes(line, start) {
            return Ok(());
        }
        let class = Class::of(keyword);
        if !keyword.is_empty() && class != Class::Structure {
            if class == Class::Foreign && self.tally.first.is_none() {
                self.tally.first = Some(keyword[..keyword.len().min(40)].to_vec());
            }
            self.tally
                .count(&keyword[..keyword.len().min(40)], line, start);
            if let Some(skipped) = tokens_before_indices(keyword) {
                scan.at += keyword.len();
                if let Some(bytes) = self.absolute_indices(*scan, skipped)? {
                    match &mut self.tally.relative {
                        Some(counted) => counted.count += 1,
                        none => *none = Some(Counted::new(keyword, line, start)),
                    }
                    return self.push_text(&bytes, line.number);
                }
            }
        }
        self.push_text(line.bytes, line.number)
    }

    /// The line with its relative indices made absolute; `None` if it has none.
    ///
    /// A relative index counts the vertices before it, and a cut may put more there.
    fn absolute_indices(&self, mut scan: Scan<'_>, skipped: usize) -> Parsed<Option<Vec<u8>>> {
        let mut bytes = Vec::new();
        let mut copied = 0;
        let mut token_number = 0;
        while scan.find_token() {
            let end = scan.at + scan.token().len();
            let mut element = 0;
            while token_number >= skipped && scan.at < end && element < 3 {
                let start = scan.at;
                let counted = Element::ALL[element];
                if let Some(given @ ..0) = scan.integer()
                    && (scan.at_token_end() || scan.peek() == Some(b'/'))
                {
                    let index = absolute(given, self.count(counted), counted, &(start..scan.at))?;
                    bytes.extend_from_slice(&scan.bytes[copied..start]);
                    bytes.extend_from_slice(index.to_string().as_bytes());
                    copied = scan.at;
                }
                if scan.peek() != Some(b'/') {
                    break;
                }
                scan.at += 1;
                element += 1;
            }
            scan.at = end;
            token_number += 1;
        }
        if copied == 0 {
            return Ok(None);
        }
        bytes.extend_from_slice(&scan.bytes[copied..]);
        Ok(Some(bytes))
    }

    /// Keeps the comment at the end of a statement as a line of its own.
    #[inline]
    pub(super) fn carry_comment(&mut self, line: &Line<'_>, scan: &Scan<'_>) -> Parsed<()> {
        match line.bytes.get(scan.at..) {
            None | Some([]) => Ok(()),
            Some(_) if self.record.takes(line, scan.at) => Ok(()),
            Some(comment) => self
                .push_text(comment, line.number)
                .map_err(|fault| fault.after(scan.at)),
        }
    }

    /// Keeps bytes, with `\n` for every line end.
    fn push_text(&mut self, bytes: &[u8], line: u32) -> Parsed<()> {
        if let Some(at) = bytes.iter().position(|&byte| byte == 0) {
            return Err(binary(at, 0));
        }
        let text = &mut self.document.text;
        let before = text.len();
        if bytes.contains(&b'\r') {
            let mut rest = bytes;
            while let Some(at) = rest.iter().position(|&byte| byte == b'\r') {
                extend(text, &rest[..at]);
                push(text, b'\n');
                rest = &rest[at + 1..];
                rest = rest.strip_prefix(b"\n").unwrap_or(rest);
            }
            extend(text, rest);
        } else {
            extend(text, bytes);
        }
        push(text, b'\n');
        let length = text.len() - before;
        self.document.layout.push_text(length, line);
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

/// How many bytes at the start of a text are foreign statements, which belong to the
/// statement before it: whole lines, each with `\n` at its end.
pub(crate) fn attached_length(text: &[u8]) -> usize {
    let mut length = 0;
    while length < text.len() {
        let rest = &text[length..];
        let mut scan = Scan::new(rest);
        if !scan.find_token() || rest[..scan.at].contains(&b'\n') {
            break;
        }
        if Class::of(scan.token()) != Class::Foreign {
            break;
        }
        length += logical_line_length(rest);
    }
    length
}

/// The statements of a text, each with its keyword (empty for a comment or a blank line) and its
/// whole lines, each with `\n` at its end.
pub(crate) fn statements(mut text: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    std::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let (statement, rest) = text.split_at(logical_line_length(text));
        text = rest;
        let mut scan = Scan::new(statement);
        scan.find_token();
        Some((scan.token(), statement))
    })
}
