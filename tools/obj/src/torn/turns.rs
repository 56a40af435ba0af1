//! When the vertices, texture coordinates and normals of a torn document are written.
//!
//! What the document has is written in its order. What was added is written behind the section
//! (`sections.rs`) that it comes from: a vertex that was split off behind that of its root, one that
//! was inserted behind the last of those that it was put between, and a texture coordinate or
//! normal likewise. Any face that has it has these too, or had them, and so comes later. Where a
//! vertex comes from no later split and no merge changes, so undoing a cut moves no line.

use super::TornDocument;
use crate::order::Turn;
use crate::sections::Sections;
use crate::store::Kind;

/// Behind all ranks of vertices: those of copies for fans.
const COPIES: u64 = 1 << 32;

/// When everything is written.
pub(crate) struct Turns<'t> {
    torn: &'t TornDocument<'t>,
    sections: Sections,
    /// Whether vertices are written in the order of their ids.
    by_id: bool,
    /// For each class that the document has not, the statement in whose section it belongs.
    anchors: Vec<u32>,
}

impl<'t> Turns<'t> {
    /// In sections, or vertices by id and all that was added behind what the document has. Linear in the
    /// document.
    pub(crate) fn new(torn: &'t TornDocument<'t>, by_id: bool) -> Turns<'t> {
        let known = torn.document.positions.len();
        let mut anchors = Vec::with_capacity(torn.ancestry.class_count() - known);
        for inserted in &torn.inserted {
            let Some(new) = (inserted.vertex as usize).checked_sub(known) else {
                continue; // It is on record, and a vertex of the document.
            };
            assert_eq!(new, anchors.len(), "each new class was inserted");
            let behind = inserted.between.map(|class| anchor(&anchors, known, class));
            anchors.push(behind.into_iter().fold(0, u32::max));
        }
        let sections = match by_id {
            false => Sections::of(torn.document),
            true => Sections::one(torn.document),
        };
        Turns {
            torn,
            sections,
            by_id,
            anchors,
        }
    }

    /// The turn of a vertex of the mesh, or of a copy of it, which is written for another fan.
    pub(crate) fn vertex(&self, v: usize, is_copy: bool) -> Turn {
        let home = match self.by_id {
            false => self.torn.ancestry.node(v),
            true => v as u32,
        };
        let known = self.torn.document.positions.len();
        let is_own = (home as usize) < known;
        if is_own && !is_copy {
            return Turn::Own(home);
        }
        let anchor = match is_own {
            true => home,
            false => anchor(&self.anchors, known, self.torn.ancestry.class(v)),
        };
        Turn::Added {
            behind: self.sections.end(Kind::Vertex, anchor),
            rank: if is_copy { COPIES } else { 0 } + u64::from(home),
        }
    }

    /// The turn of a texture coordinate or a normal.
    pub(crate) fn index(&self, kind: Kind, index: usize) -> Turn {
        match index.checked_sub(self.torn.document.counts()[kind as usize]) {
            None => Turn::Own(index as u32),
            Some(new) => {
                let anchor = self.torn.corners.anchors[kind as usize - 1][new];
                Turn::Added {
                    behind: self.sections.end(kind, anchor),
                    rank: new as u64,
                }
            }
        }
    }
}

/// The statement in whose section a class belongs: its own, if the document has that one.
fn anchor(anchors: &[u32], known: usize, class: u32) -> u32 {
    match (class as usize).checked_sub(known) {
        None => class,
        Some(new) => anchors[new],
    }
}
