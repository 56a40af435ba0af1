//! Text that was carried through, taken apart again into its statements.

use super::fault::Line;
use super::scan::Scan;
use super::source::first_line;
use crate::document::Document;
use crate::keyword::{Class, is_said_of_vertex};
use crate::store::{Kind, Layout};

/// How many bytes at the start of a text are foreign statements, which belong to the
/// statement before it: whole lines, each with `\n` at its end.
pub(crate) fn attached_length(text: &[u8]) -> usize {
    let is_foreign = |keyword: &[u8]| !keyword.is_empty() && Class::of(keyword) == Class::Foreign;
    let attached = statements(text).take_while(|&(keyword, _)| is_foreign(keyword));
    attached.map(|(_, statement)| statement.len()).sum()
}

/// The statements of a text, each with its keyword (empty for a comment or a blank line) and its
/// whole lines, each with `\n` at its end.
pub(crate) fn statements(mut text: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    std::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let (_, length, _) = first_line(text);
        let (bytes, rest) = text.split_at(length);
        text = rest;
        let mut scan = Scan::new(Line { bytes, number: 1 });
        scan.find_token();
        Some((scan.token(), bytes))
    })
}

impl Document {
    /// The vertex that each statement is about which is about the last one before it, and whether
    /// nothing but foreign statements stands between the two.
    pub(crate) fn statements_about_vertices(&self) -> Vec<(usize, bool)> {
        let (mut vertices, mut is_behind) = (0, false);
        let mut found = Vec::new();
        for (run, lines) in self.runs() {
            if run.kind == Kind::Vertex {
                vertices += run.count as usize;
            }
            let attached = if is_behind { attached_length(lines) } else { 0 };
            let mut at = 0;
            for (keyword, statement) in statements(lines) {
                if let (true, Some(vertex)) = (is_said_of_vertex(keyword), vertices.checked_sub(1))
                {
                    found.push((vertex, at < attached));
                }
                at += statement.len();
            }
            is_behind = run.kind == Kind::Vertex;
        }
        found
    }

    /// Puts as many statements as `count` says in the place of each, given its kind and its number. What is
    /// said of a vertex that is gone goes with it.
    pub(crate) fn replace_statements(&mut self, count: impl Fn(Kind, usize) -> usize) {
        let mut layout = Layout::default();
        // What stays of the text moves up to where the rest was.
        let (mut seen, mut at, mut kept) = ([0; 4], 0, 0);
        let mut is_gone = false;
        for &run in self.layout.runs() {
            if run.kind == Kind::Text {
                let lines = at..at + run.count as usize;
                at = lines.end;
                let before = kept;
                if is_gone {
                    let rest = without_statements_of_vertex(&self.text[lines]);
                    kept += rest.len();
                    self.text[before..kept].copy_from_slice(&rest);
                } else {
                    kept += lines.len();
                    self.text.copy_within(lines, before);
                }
                if kept > before {
                    layout.push_text(kept - before, run.line(0));
                }
                is_gone = false;
                continue;
            }
            for line in (0..run.count).map(|before| run.line(before)) {
                let number = &mut seen[run.kind as usize];
                let count = count(run.kind, *number);
                *number += 1;
                is_gone = count == 0 && run.kind == Kind::Vertex;
                (0..count).for_each(|_| layout.push(run.kind, line));
            }
        }
        self.text.truncate(kept);
        self.layout = layout;
    }
}

/// The lines behind a vertex that is gone, without those that are about it.
pub(crate) fn without_statements_of_vertex(lines: &[u8]) -> Vec<u8> {
    let (attached, rest) = lines.split_at(attached_length(lines));
    let others = statements(attached).filter(|&(keyword, _)| !is_said_of_vertex(keyword));
    let others = others.map(|(_, statement)| statement).chain([rest]);
    others.flatten().copied().collect()
}
