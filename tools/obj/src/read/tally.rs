//! What is said about statements that are carried through as bytes.

use super::fault::{Line, locate, quoted};
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location};
use crate::keyword::{Class, is_said_of_vertex};

/// The most keywords that are reported by name.
const KEYWORDS_MAX: usize = 32;

/// Which uninterpreted statements there are.
#[derive(Debug, Default)]
pub(super) struct ForeignStatements {
    keywords: Vec<Counted>,
    /// Statements with keywords beyond [`KEYWORDS_MAX`].
    others: usize,
    /// Statements whose relative indices were made absolute.
    relative: Option<Counted>,
}

#[derive(Debug)]
struct Counted {
    keyword: Vec<u8>,
    count: usize,
    location: Location,
    excerpt: Excerpt,
}

impl ForeignStatements {
    /// The first keyword of the file that is not known: there are fewer known ones than are counted by
    /// name.
    pub(super) fn first_unknown(&self) -> Option<&[u8]> {
        let mut keywords = self.keywords.iter().map(|counted| &counted.keyword[..]);
        keywords.find(|keyword| Class::of(keyword) == Class::Foreign)
    }

    /// Counts a statement, whose keyword starts there.
    pub(super) fn count(&mut self, keyword: &[u8], line: &Line<'_>, start: usize) {
        let mut keywords = self.keywords.iter_mut();
        if let Some(known) = keywords.find(|known| known.keyword == keyword) {
            known.count += 1;
        } else if self.keywords.len() < KEYWORDS_MAX {
            self.keywords.push(Counted::new(keyword, line, start));
        } else {
            self.others += 1;
        }
    }

    /// Counts a statement whose relative indices were made absolute.
    pub(super) fn count_relative(&mut self, keyword: &[u8], line: &Line<'_>, start: usize) {
        match &mut self.relative {
            Some(counted) => counted.count += 1,
            none => *none = Some(Counted::new(keyword, line, start)),
        }
    }

    /// A warning for each keyword, in the order in which they were met.
    pub(super) fn report(self, diagnostics: &mut Vec<Diagnostic>) {
        for counted in self.keywords {
            let (code, kept) = match Class::of(&counted.keyword) {
                Class::Element => ("W-OBJ-ELEMENT", "elements are kept, but never cut"),
                _ if is_said_of_vertex(&counted.keyword) => (
                    "W-OBJ-FOREIGN",
                    "is not interpreted, and is kept as it is, but for no copy of its vertex",
                ),
                _ => ("W-OBJ-FOREIGN", "is not interpreted, and is kept as it is"),
            };
            let message = format!("{} {kept}", quoted(&counted.keyword));
            diagnostics.push(counted.warn(Level::Warning, code, &message));
        }
        if self.others > 0 {
            let others = self.others;
            let message = format!("and {others} more statements that are not interpreted");
            diagnostics.push(Diagnostic {
                location: None,
                ..Diagnostic::warning("W-OBJ-FOREIGN", 1, message)
            });
        }
        if let Some(counted) = self.relative {
            let keyword = quoted(&counted.keyword);
            let message = format!("negative indices of {keyword} were made absolute");
            diagnostics.push(counted.warn(Level::Note, "W-OBJ-RELATIVE", &message));
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

    /// A message at the first statement that says how many there are.
    fn warn(self, level: Level, code: &'static str, message: &str) -> Diagnostic {
        let message = match self.count {
            1 => format!("{message} (1 statement)"),
            count => format!("{message} ({count} statements, the first here)"),
        };
        Diagnostic {
            level,
            location: Some(self.location),
            excerpt: Some(self.excerpt),
            ..Diagnostic::warning(code, self.location.line, message)
        }
    }
}
