//! Vertices that stand apart from where they are, and are put there.

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::record::{Apart, Record, is_same_point};

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
    tell_edited(document, &edited);
}

/// Says that vertices stay where another program put them.
fn tell_edited(document: &mut Document, edited: &[u32]) {
    let Some(&first) = edited.first() else {
        return;
    };
    let more = match edited.len() {
        1 => String::new(),
        many => format!(", and so do {} more such", many - 1),
    };
    let line = document.line_of_vertex(first as usize);
    let message = format!(
        "`v` {} was written apart from the other side of its cut and was edited since: it stays where it is now{more}",
        first + 1
    );
    document.diagnostics.push(Diagnostic {
        help: Some("its part of the record will not be written again".to_owned()),
        ..Diagnostic::warning("W-OBJ-RECORD-APART", line, message)
    });
}
