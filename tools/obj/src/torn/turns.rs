//! When the vertices, texture coordinates and normals of a torn document are written.
//!
//! What the document has is written in its order. What was added is written behind the section
//! (`sections.rs`) that it comes from: a vertex that was split off behind that of its root, one that
//! was inserted behind the last of those that it was put between, and a texture coordinate or
//! normal likewise. Any face that has it has these too, or had them, and so comes later. Where a
//! vertex comes from no later split and no merge changes, so undoing a cut moves no line.

use tearmesh::VertexId;

use super::TornDocument;
use crate::order::{Order, Turn};
use crate::sections::Sections;
use crate::store::Kind;

/// Behind all ranks of vertices: those of copies for fans.
const COPIES: u64 = 1 << 32;

impl TornDocument<'_> {
    /// Returns the vertices of the mesh in the order in which they are written. Vertex `i` of a mesh
    /// that is read from the written file is the vertex at index `i` of this list.
    ///
    /// The vertices of the document keep their order. A split-off vertex follows the last vertex of the
    /// object of its root. An inserted vertex follows the last vertex of the object of the vertices that
    /// it was inserted between. So if several objects have vertices of their own, the new vertices of the
    /// first object precede all vertices of the second. New vertices of the same object are in the order
    /// of their creation.
    #[must_use]
    pub fn vertices_in_order(&self) -> Vec<VertexId> {
        let order = Turns::in_sections(self).vertices().in_order();
        let vertices = order.into_iter();
        vertices.filter_map(|v| VertexId::new(v as usize)).collect()
    }
}

/// When everything is written.
pub(crate) struct Turns<'t> {
    torn: &'t TornDocument<'t>,
    /// `None` if vertices are written in the order of their ids.
    sections: Option<Sections>,
    /// For each class that the document has not, the statement in whose section it belongs.
    anchors: Vec<u32>,
}

impl<'t> Turns<'t> {
    /// In sections. Linear in the document.
    pub(crate) fn in_sections(torn: &'t TornDocument<'t>) -> Turns<'t> {
        let known = torn.document.positions.len();
        let mut anchors = Vec::with_capacity(torn.ancestry.class_count() - known);
        for inserted in &torn.inserted {
            let Some(new) = (inserted.vertex as usize).checked_sub(known) else {
                continue; // It is on record, and a vertex of the document.
            };
            assert_eq!(new, anchors.len(), "each new class was inserted");
            let roots = inserted.at.roots().iter();
            let last = roots.map(|&class| anchor(&anchors, known, class)).max();
            anchors.push(last.expect("an edge has ends"));
        }
        Turns {
            torn,
            sections: Some(Sections::of(torn.document)),
            anchors,
        }
    }

    /// Vertices by id, and all that was added behind what the document has.
    pub(crate) fn by_id(torn: &'t TornDocument<'t>) -> Turns<'t> {
        Turns {
            torn,
            sections: None,
            anchors: Vec::new(),
        }
    }

    fn behind(&self, kind: Kind, statement: impl FnOnce() -> u32) -> u32 {
        match &self.sections {
            Some(sections) => sections.end(kind, statement()),
            None => self.torn.document.counts()[kind as usize] as u32,
        }
    }

    /// The turn of a vertex of the mesh.
    pub(crate) fn vertex(&self, v: usize) -> Turn {
        let home = match self.sections {
            Some(_) => self.torn.ancestry.node(v),
            None => v as u32,
        };
        if (home as usize) < self.torn.document.positions.len() {
            return Turn::Own(home);
        }
        Turn::Added {
            behind: self.behind(Kind::Vertex, || self.anchor(v)),
            rank: u64::from(home),
        }
    }

    /// The turn of a copy of a vertex, which is written for another fan.
    pub(crate) fn copy(&self, v: usize) -> Turn {
        let home = self.torn.ancestry.node(v);
        Turn::Added {
            behind: self.behind(Kind::Vertex, || {
                let is_own = (home as usize) < self.torn.document.positions.len();
                if is_own { home } else { self.anchor(v) }
            }),
            rank: COPIES + u64::from(home),
        }
    }

    /// The statement in whose section a vertex belongs that the document has not.
    fn anchor(&self, v: usize) -> u32 {
        let known = self.torn.document.positions.len();
        anchor(&self.anchors, known, self.torn.ancestry.class(v))
    }

    /// The turn of a texture coordinate or a normal.
    pub(crate) fn index(&self, kind: Kind, index: usize) -> Turn {
        match index.checked_sub(self.torn.document.counts()[kind as usize]) {
            None => Turn::Own(index as u32),
            Some(new) => Turn::Added {
                behind: self.behind(kind, || {
                    let corners = self.torn.corners.as_ref();
                    corners.map_or(0, |corners| corners.anchors[kind as usize - 1][new])
                }),
                rank: new as u64,
            },
        }
    }

    /// The order of the vertices alone.
    pub(crate) fn vertices(&self) -> Order {
        let count = self.torn.vertex_count();
        let turns = (0..count).map(|v| self.vertex(v));
        Order::new(self.torn.document.positions.len(), turns)
    }
}

/// The statement in whose section a class belongs: its own, if the document has that one.
fn anchor(anchors: &[u32], known: usize, class: u32) -> u32 {
    match (class as usize).checked_sub(known) {
        None => class,
        Some(new) => anchors[new],
    }
}
