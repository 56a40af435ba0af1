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
use crate::read::{attached_length, statements};
use crate::store::Kind;

/// What is said of some vertices.
#[derive(Debug, Default)]
pub(crate) struct Said {
    of: BTreeMap<usize, Vec<u8>>,
    /// The last run of text that says something of the last vertex, where that is not directly
    /// behind it: a new `v` before it would take it away.
    pub(crate) late: Option<usize>,
}

impl Said {
    /// Goes through the text once, if there are any `copied` vertices.
    pub(crate) fn in_document(document: &Document, copied: &[usize]) -> Said {
        let mut said = Said::default();
        if copied.is_empty() {
            return said;
        }
        said.of = copied.iter().map(|&vertex| (vertex, Vec::new())).collect();
        let runs = document.layout.runs();
        let mut text = &document.text[..];
        let mut vertices = 0;
        for (i, run) in runs.iter().enumerate() {
            match run.kind {
                Kind::Vertex => vertices += run.count as usize,
                Kind::Text => {
                    let (lines, rest) = text.split_at(run.count as usize);
                    text = rest;
                    let behind = i > 0 && runs[i - 1].kind == Kind::Vertex;
                    let attached = if behind { attached_length(lines) } else { 0 };
                    let mut at = 0;
                    for (keyword, statement) in statements(lines) {
                        if vertices > 0 && is_said_of_vertex(keyword) {
                            if let Some(all) = said.of.get_mut(&(vertices - 1)) {
                                all.extend_from_slice(statement);
                            }
                            if vertices == document.positions.len() && at >= attached {
                                said.late = Some(i);
                            }
                        }
                        at += statement.len();
                    }
                }
                _ => {}
            }
        }
        said
    }

    /// The statements about a vertex that was asked for, as bytes of whole lines.
    pub(crate) fn of(&self, vertex: usize) -> &[u8] {
        self.of
            .get(&vertex)
            .map_or(&[], |statements| &statements[..])
    }
}

/// Lines behind a vertex that is dropped, without those that say something of it.
pub(crate) fn left_without_vertex(lines: &[u8]) -> Vec<u8> {
    let others = statements(lines).filter(|&(keyword, _)| !is_said_of_vertex(keyword));
    let others = others.flat_map(|(_, statement)| statement);
    others.copied().collect()
}
