//! Vertices that were written several times, once a fan, and are one again.

use tearmesh::Point;

use super::text::without_statements_of_vertex;
use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::record::{Record, SplitOff};
use crate::store::Kind;

/// Makes each vertex and its copies one, but for copies that were moved away: these become
/// vertices that the last cut split off. From then on a record is in terms of the document.
pub(super) fn join(document: &mut Document, record: &mut Record, fans: &[[u32; 2]]) {
    if fans.is_empty() {
        return;
    }
    let cut = record.last_cut().max(1);
    let bits = |v: u32| {
        let at = document.positions[v as usize];
        let extras = document.extras.row(v as usize).iter().copied();
        [at.x, at.y, at.z]
            .into_iter()
            .chain(extras)
            .map(f64::to_bits)
    };
    let is_moved = |&&[copy, of]: &&[u32; 2]| !bits(copy).eq(bits(of));
    let moved: Vec<[u32; 2]> = fans.iter().filter(is_moved).copied().collect();
    let copies = fans.iter().filter(|fan| !is_moved(fan));
    let copies: Vec<[u32; 2]> = copies.copied().collect();
    tell_moved(document, &moved);
    document.drop_vertices(&copies.iter().map(|&[copy, _]| copy).collect::<Vec<_>>());
    let mut ids = Vec::with_capacity(document.positions.len() + copies.len());
    let mut gone = copies.iter().peekable();
    let mut next = 0;
    for v in 0..(document.positions.len() + copies.len()) as u32 {
        match gone.next_if(|[copy, _]| *copy == v) {
            Some(&[_, of]) => ids.push(ids[of as usize]),
            None => {
                ids.push(next);
                next += 1;
            }
        }
    }
    let id = |v: u32| ids[v as usize];
    for vertex in &mut document.polygons.vertices {
        *vertex = id(*vertex);
    }
    let moved = moved
        .iter()
        .map(|&[vertex, from]| SplitOff { vertex, from, cut });
    record.splits.extend(moved);
    record.splits.sort_unstable_by_key(|split| split.vertex);
    record.renumber(id);
    record.copies = copies.iter().map(|&[copy, of]| [copy, id(of)]).collect();
}

/// Says that copies are vertices of their own.
fn tell_moved(document: &mut Document, moved: &[[u32; 2]]) {
    let Some(&[copy, of]) = moved.first() else {
        return;
    };
    let more = match moved.len() {
        1 => String::new(),
        many => format!(", and {} more such", many - 1),
    };
    let line = document.line_of_vertex(copy as usize);
    let message = format!(
        "`v` {} was a copy of {} and has moved away from it: it is now a separate vertex{more}",
        copy + 1,
        of + 1
    );
    let warning = Diagnostic::warning("W-OBJ-RECORD-MOVED", line, message);
    document.diagnostics.push(warning);
}

impl Document {
    /// Drops these vertices, which are ascending and no face names any more, with what is said
    /// of them.
    fn drop_vertices(&mut self, dropped: &[u32]) {
        let is_dropped = |vertex: usize| dropped.binary_search(&(vertex as u32)).is_ok();
        let count = self.positions.len();
        self.extras = self.extras.staying(count, |vertex| !is_dropped(vertex));
        let mut vertices = 0..count;
        let stays = |_: &Point| vertices.next().is_some_and(|vertex| !is_dropped(vertex));
        self.positions.retain(stays);
        let count =
            |kind: Kind, number: usize| usize::from(kind != Kind::Vertex || !is_dropped(number));
        let passes = without_statements_of_vertex;
        self.layout.replace(&mut self.text, count, passes);
    }
}
