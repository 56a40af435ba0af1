//! A scene file: its tables, what stands in them, and where, for those who find fault with it.

use std::collections::BTreeMap;
use std::ops::Range;

use tearmesh::{Point, Vector};

use crate::rays::Pair;
use crate::say::{Excerpt, Fault};

/// A value that its schema admits, and where it stands in the text.
#[derive(Clone, Debug)]
pub(crate) struct Value {
    pub(crate) content: Content,
    pub(crate) span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Content {
    Number(f64),
    Bool(bool),
    Text(String),
    /// Numbers in rows: one for a pair or a vector.
    Rows(Vec<Vec<f64>>),
    Rays(Box<Pair>),
}

/// A table: its keys, and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub(crate) values: BTreeMap<&'static str, Value>,
    pub(crate) span: Range<usize>,
}

/// A scene file whose every value has the right kind.
#[derive(Clone, Debug)]
pub(crate) struct SceneFile {
    pub(crate) source: Source,
    /// By the name of the table; one, or any number of those in lists.
    pub(crate) tables: BTreeMap<&'static str, Vec<Table>>,
}

impl SceneFile {
    pub(super) fn first(&self, table: &str) -> Option<&Table> {
        self.tables.get(table)?.first()
    }

    pub(super) fn all(&self, table: &str) -> &[Table] {
        self.tables.get(table).map_or(&[], Vec::as_slice)
    }

    pub(super) fn has(&self, table: &str, key: &str) -> bool {
        let has = |table: &Table| key.is_empty() || table.values.contains_key(key);
        self.all(table).iter().any(has)
    }

    pub(super) fn blame(
        &self,
        (table, number, key): (&str, usize, &str),
        code: &'static str,
        message: String,
    ) -> Fault {
        match self.all(table).get(number) {
            Some(table) => *self.fault(table, key, code, message),
            None => Fault::error(code, message),
        }
    }

    pub(super) fn missing(&self, table: &Table, name: &str, key: &str) -> Box<Fault> {
        let message = format!("[{name}] lacks `{key}`");
        let code = "E-SCENE-MISSING";
        Box::new(self.source.fault(code, message, &table.span, ""))
    }

    pub(super) fn fault(
        &self,
        table: &Table,
        key: &str,
        code: &'static str,
        message: String,
    ) -> Box<Fault> {
        let span = table.values.get(key).map(|Value { span, .. }| span.clone());
        let span = span.unwrap_or_else(|| table.span.clone());
        Box::new(self.source.fault(code, message, &span, ""))
    }
}

impl Table {
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.values.get(name)?.content {
            Content::Number(x) => Some(x),
            _ => None,
        }
    }

    pub(super) fn count(&self, name: &str) -> Option<u32> {
        self.number(name).map(|x| x as u32)
    }

    pub(super) fn bool(&self, name: &str) -> Option<bool> {
        match self.values.get(name)?.content {
            Content::Bool(x) => Some(x),
            _ => None,
        }
    }

    pub(super) fn word(&self, name: &str) -> Option<&str> {
        match &self.values.get(name)?.content {
            Content::Text(word) => Some(word),
            _ => None,
        }
    }

    pub(super) fn rows(&self, name: &str) -> Option<&[Vec<f64>]> {
        match &self.values.get(name)?.content {
            Content::Rows(rows) => Some(rows),
            _ => None,
        }
    }

    pub(super) fn row(&self, name: &str) -> Option<&[f64]> {
        self.rows(name)?.first().map(Vec::as_slice)
    }

    pub(super) fn pair(&self, name: &str) -> Option<[f64; 2]> {
        self.row(name)?.try_into().ok()
    }

    pub(super) fn vector(&self, name: &str) -> Option<Vector> {
        let [x, y, z] = self.row(name)?.try_into().ok()?;
        Some(Vector::new(x, y, z))
    }

    pub(super) fn point(&self, name: &str) -> Option<Point> {
        self.vector(name).map(Point::from)
    }

    /// Which of these keys stand in the table.
    pub(super) fn those_of<'n>(&self, names: &[&'n str]) -> Vec<&'n str> {
        let mut found = names.to_vec();
        found.retain(|name| self.values.contains_key(name));
        found
    }
}

/// The text, for those who find fault with it.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub(crate) path: String,
    text: String,
}

impl Source {
    pub(crate) fn new(path: &str, text: &str) -> Source {
        Source {
            path: path.to_owned(),
            text: text.to_owned(),
        }
    }

    /// A fault with the line in which a part of the text begins.
    pub(crate) fn fault(
        &self,
        code: &'static str,
        message: String,
        span: &Range<usize>,
        label: &str,
    ) -> Fault {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let rest = &self.text[line_start..];
        let line_text = rest.lines().next().unwrap_or_default();
        let at = (start - line_start).min(line_text.len());
        let mut end = (span.end.max(start) - line_start).clamp(at, line_text.len());
        while !line_text.is_char_boundary(end) {
            end += 1;
        }
        Fault {
            code,
            message,
            excerpt: Some(Box::new(Excerpt {
                path: self.path.clone(),
                line: self.text[..line_start].matches('\n').count() + 1,
                text: line_text.to_owned(),
                first_column: 1,
                span: at..end,
                label: label.to_owned(),
            })),
            ..Fault::default()
        }
    }

    /// Where a part of a string stands; the whole string if it is written with escapes.
    pub(super) fn within(
        &self,
        string: &Range<usize>,
        content: &str,
        part: Range<usize>,
    ) -> Range<usize> {
        let written = self.text.get(string.clone()).unwrap_or_default();
        match written.find(content) {
            Some(at) => string.start + at + part.start..string.start + at + part.end,
            None => string.clone(),
        }
    }
}
