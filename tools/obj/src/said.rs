//! What statements say of the vertex before them: those of `ARCSim`.
//!
//! `ARCSim` reads `nl` (a label, which pins or drives the vertex), `ny` (its plastic embedding),
//! `nv` and, in older files, `vv` (its velocity) into the last `v` before them, and where a vertex
//! has none, into label 0, no velocity and an embedding at rest. So a copy of a vertex has to
//! say what the vertex says: half a pinned seam would fall, and half a moving one stand still.
//! Other foreign statements are never copied: an `e` is an edge, and a `vw` names its vertex.

use std::collections::BTreeMap;

use crate::document::Document;
use crate::keyword::is_said_of_vertex;
use crate::read::text::{attached_length, statements};
use crate::store::{Kind, Run};

/// What is said of vertices.
#[derive(Debug, Default)]
pub(crate) struct Said {
    /// By vertex, all that is said of those that are copied.
    of: BTreeMap<usize, Vec<u8>>,
    /// By the number of vertices before them, the statements that are not directly behind their
    /// vertex.
    late: BTreeMap<usize, Late>,
}

/// Statements about a vertex with others between: a `v` that moved in between would take them.
#[derive(Debug)]
struct Late {
    /// The last run of text that has one of them.
    run: usize,
    statements: Vec<u8>,
}

impl Said {
    /// Goes through the text once.
    pub(crate) fn in_document(document: &Document, copied: &[usize]) -> Said {
        let mut said = Said {
            of: copied.iter().map(|&vertex| (vertex, Vec::new())).collect(),
            late: BTreeMap::new(),
        };
        let runs = document.layout.runs();
        let mut text = &document.text[..];
        let mut vertices = 0;
        for (run, &Run { kind, count, .. }) in runs.iter().enumerate() {
            match kind {
                Kind::Vertex => vertices += count as usize,
                Kind::Text => {
                    let (lines, rest) = text.split_at(count as usize);
                    text = rest;
                    let behind = run > 0 && runs[run - 1].kind == Kind::Vertex;
                    let attached = if behind { attached_length(lines) } else { 0 };
                    said.read(run, vertices, lines, attached);
                }
                _ => {}
            }
        }
        said
    }

    /// Takes in a run of text behind that many vertices, of which some bytes are attached to
    /// the last one.
    fn read(&mut self, run: usize, vertices: usize, lines: &[u8], attached: usize) {
        let mut at = 0;
        for (keyword, statement) in statements(lines) {
            if is_said_of_vertex(keyword) {
                let of = vertices.checked_sub(1);
                if let Some(all) = of.and_then(|vertex| self.of.get_mut(&vertex)) {
                    all.extend_from_slice(statement);
                }
                if at >= attached {
                    let none = || Late {
                        run,
                        statements: Vec::new(),
                    };
                    let late = self.late.entry(vertices).or_insert_with(none);
                    late.run = run;
                    late.statements.extend_from_slice(statement);
                }
            }
            at += statement.len();
        }
    }

    /// The statements about a vertex that is copied, as bytes of whole lines.
    pub(crate) fn of(&self, vertex: usize) -> &[u8] {
        self.of
            .get(&vertex)
            .map_or(&[], |statements| &statements[..])
    }

    pub(crate) fn has_late(&self) -> bool {
        !self.late.is_empty()
    }

    /// The statements about the last of some vertices that are not directly behind it.
    pub(crate) fn late(&self, vertices: usize) -> &[u8] {
        self.late
            .get(&vertices)
            .map_or(&[], |late| &late.statements[..])
    }

    /// The last run of text that has one of these.
    pub(crate) fn late_run(&self, vertices: usize) -> Option<usize> {
        self.late.get(&vertices).map(|late| late.run)
    }
}

/// Lines without those that say something of a vertex.
pub(crate) fn left_without_vertex(lines: &[u8]) -> Vec<u8> {
    let others = statements(lines).filter(|&(keyword, _)| !is_said_of_vertex(keyword));
    let others = others.flat_map(|(_, statement)| statement);
    others.copied().collect()
}
