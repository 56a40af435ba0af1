//! Vertices as they were before a file was written: those that stand apart are put where they are, and those
//! that were written several times, once a fan, are one again.

use tearmesh::Point;

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::record::{Apart, Record, SplitOff, are_same, is_same_point};
use crate::store::Kind;

/// Puts the vertices that stand apart where they are, by the numbers of the file, and their copies
/// with them. One whose `v` says anything else than it did was edited since: it stays, and is said.
pub(super) fn put_in_place(document: &mut Document, record: &mut Record, fans: &[[u32; 2]]) {
    let stands = |document: &Document, v: u32, apart: &Apart| {
        is_same_point(document.positions[v as usize], apart.shown)
    };
    for &[copy, of] in fans {
        let place = record.apart.binary_search_by_key(&of, |apart| apart.vertex);
        let apart = place.ok().map(|place| record.apart[place]);
        if let Some(apart) = apart.filter(|apart| stands(document, copy, apart)) {
            document.positions[copy as usize] = apart.is;
        }
    }
    let mut edited = Vec::new();
    record.apart.retain(|apart| {
        let is_intact = stands(document, apart.vertex, apart);
        if is_intact {
            document.positions[apart.vertex as usize] = apart.is;
        } else {
            edited.push(apart.vertex);
        }
        is_intact
    });
    let first = edited.first().map_or(0, |&vertex| u64::from(vertex) + 1);
    let message = format!(
        "`v` {first} was written apart from the other side of its cut and was edited since: it stays where it is now"
    );
    let help = Some("its part of the record will not be written again".to_owned());
    if let Some(warning) = warning(
        document,
        "W-OBJ-RECORD-APART",
        &edited,
        message,
        ", and so do",
    ) {
        document.diagnostics.push(Diagnostic { help, ..warning });
    }
}

/// Makes each vertex and its copies one, but for copies that were moved away: these become
/// vertices that the last cut split off. From then on a record is in terms of the document.
pub(super) fn join(document: &mut Document, record: &mut Record, fans: &[[u32; 2]]) {
    if fans.is_empty() {
        return;
    }
    let cut = record.last_cut().max(1);
    let is_moved = |fan: &&[u32; 2]| {
        let [copy, of] = fan.map(|v| document.numbers(v as usize));
        !are_same(&copy, &of)
    };
    let (moved, copies): (Vec<[u32; 2]>, Vec<[u32; 2]>) = fans.iter().partition(is_moved);
    let numbers = moved
        .first()
        .map_or([0; 2], |moved| moved.map(|v| u64::from(v) + 1));
    let message = format!(
        "`v` {} was a copy of {} and has moved away from it: it is now a separate vertex",
        numbers[0], numbers[1]
    );
    let vertices: Vec<u32> = moved.iter().map(|&[copy, _]| copy).collect();
    let warning = warning(document, "W-OBJ-RECORD-MOVED", &vertices, message, ", and");
    document.diagnostics.extend(warning);
    let stays = |v: usize| {
        let copy = copies.binary_search_by_key(&(v as u32), |&[copy, _]| copy);
        copy.is_err()
    };
    let count = document.positions.len();
    document.extras = document.extras.staying(count, stays);
    let mut vertices = 0..count;
    let is_next = |_: &Point| vertices.next().is_some_and(stays);
    document.positions.retain(is_next);
    document.replace_statements(|kind, number| usize::from(kind != Kind::Vertex || stays(number)));
    let mut known = Record {
        copies,
        ..Record::default()
    };
    for copy in 0..known.copies.len() {
        let [_, of] = known.copies[copy];
        known.copies[copy][1] = known.vertex(of as usize) as u32;
    }
    let id = |number: u32| known.vertex(number as usize) as u32;
    for vertex in &mut document.polygons.vertices {
        *vertex = id(*vertex);
    }
    let moved = moved
        .iter()
        .map(|&[vertex, from]| SplitOff { vertex, from, cut });
    record.splits.extend(moved);
    record.splits.sort_unstable_by_key(|split| split.vertex);
    record.renumber(id);
    record.copies = known.copies;
}

/// A warning at the first of some vertices, if there are any, that says how many more there are.
fn warning(
    document: &Document,
    code: &'static str,
    vertices: &[u32],
    message: String,
    and: &str,
) -> Option<Diagnostic> {
    let line = document.line_of_vertex(*vertices.first()? as usize);
    let more = match vertices.len() {
        1 => String::new(),
        many => format!("{and} {} more such", many - 1),
    };
    Some(Diagnostic::warning(code, line, message + &more))
}
