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
    /// The orders of vertices, of which there are copies for fans, of texture coordinates and of normals: in
    /// sections, or vertices by id and all that was added behind what the document has. Linear in the
    /// document.
    pub(crate) fn orders(&self, copies: &[VertexId], by_id: bool) -> [Order; 3] {
        let sections = match by_id {
            false => Sections::of(self.document),
            true => Sections::one(self.document),
        };
        let known = self.document.counts();
        // For each class the statement in whose section it belongs: its own, if the document has that one.
        let mut anchors: Vec<u32> = (0..known[0] as u32).collect();
        for inserted in &self.inserted {
            if inserted.vertex as usize >= known[0] {
                assert_eq!(
                    inserted.vertex as usize,
                    anchors.len(),
                    "each new class was inserted"
                );
                let behind = inserted.between.map(|class| anchors[class as usize]);
                anchors.push(behind.into_iter().fold(0, u32::max));
            }
        }
        let vertex = |v: usize, copy_rank: u64| {
            let home = match by_id {
                false => self.ancestry.node(v),
                true => v as u32,
            };
            let is_own = (home as usize) < known[0];
            if is_own && copy_rank == 0 {
                return Turn::Own(home);
            }
            let anchor = match is_own {
                true => home,
                false => anchors[self.ancestry.class(v) as usize],
            };
            Turn::Added {
                behind: sections.end(Kind::Vertex, anchor),
                rank: copy_rank + u64::from(home),
            }
        };
        let index = |kind: Kind, index: usize| {
            let Some(new) = index.checked_sub(known[kind as usize]) else {
                return Turn::Own(index as u32);
            };
            let anchor = self.corners.anchors[kind as usize - 1][new];
            Turn::Added {
                behind: sections.end(kind, anchor),
                rank: new as u64,
            }
        };
        let vertices = (0..self.vertex_count()).map(|v| vertex(v, 0));
        let copies = copies.iter().map(|v| vertex(v.index(), COPIES));
        let [texture, normals] = [Kind::Texture, Kind::Normal].map(|kind| {
            let all = 0..self.corners.counts()[kind as usize - 1];
            Order::new(known[kind as usize], all.map(|at| index(kind, at)))
        });
        [
            Order::new(known[0], vertices.chain(copies)),
            texture,
            normals,
        ]
    }
}
