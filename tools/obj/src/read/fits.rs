//! Whether a record fits its document, and what of it does.

use super::fault::quoted;
use super::items::Items;
use crate::diagnostic::{Diagnostic, Location};
use crate::document::Document;
use crate::families::{Families, Family};
use crate::record::{Exchange, Hash, Slid, are_last, runs};
use crate::store::push;

/// Why a record, whose faces have this hash, is not one of this document.
pub(super) fn misfit(items: &mut Items, hash: u64, document: &Document) -> Option<String> {
    let counts = &items.counts;
    let changed = |what: String| {
        Some(format!(
            "this record is not used, since another program changed the file: {what}"
        ))
    };
    let (vertices, faces) = (document.positions.len(), document.polygons.len());
    if vertices != counts.vertices as usize {
        return changed(format!(
            "it had {} `v`, and has {vertices}",
            counts.vertices
        ));
    }
    if faces != counts.faces as usize {
        return changed(format!("it had {} `f`, and has {faces}", counts.faces));
    }
    let mut of_faces = Hash::of_faces(vertices);
    for &vertex in &document.polygons.vertices {
        of_faces.add_corner(vertex);
    }
    if of_faces.0 != hash || !document.polygons.all_triangles() {
        return changed("its faces are others".to_owned());
    }
    if let Some(keyword) = document.statement_with_indices()
        && !what_may_go_is_last(items)
    {
        return changed(format!(
            "{} may name a vertex by its number, which undoing the cuts would change",
            quoted(keyword)
        ));
    }
    // What a record says that was made by no one who knew the faces.
    let mut of: Vec<u32> = (0..counts.vertices).collect();
    for &[copy, vertex] in &items.fans {
        of[copy as usize] = vertex;
    }
    let mut has_face = vec![false; vertices];
    let roots = items.record.roots(vertices);
    for corners in document.triangles() {
        let [a, b, c] = corners.map(|v| roots[of[v as usize] as usize]);
        if a == b || b == c || c == a {
            return Some("this record is not used: it joins corners of a face".to_owned());
        }
        for &vertex in corners {
            has_face[vertex as usize] = true;
        }
    }
    let Some(families) = families(items) else {
        return Some("this record is not used: it divides a face of two parents".to_owned());
    };
    items.record.families = families;
    let splits = &items.record.splits;
    if splits.iter().any(|split| items.is_copy(split.from)) {
        return Some("this record is not used: it splits a copy".to_owned());
    }
    let mut split = splits.iter().flat_map(|split| [split.vertex, split.from]);
    if split.any(|vertex| !has_face[vertex as usize]) {
        return Some("this record is not used: it splits vertices without faces".to_owned());
    }
    None
}

/// The divided faces, `None` if a part that was divided again is not of one parent.
fn families(items: &Items) -> Option<Families> {
    let mut families = Families::default();
    for (number, (faces, corners)) in items.parents.iter().enumerate() {
        let (corners, above) = (*corners, None);
        families.add(Family { corners, above });
        faces
            .clone()
            .for_each(|face| families.give(face as usize, number as u32));
    }
    let parents = families.all().len() as u32;
    for &Family { corners, above } in &items.again {
        let above = above.map(|above| parents + above);
        families.add(Family { corners, above });
    }
    for (&face, &again) in &items.again_of {
        let parent = families.of(face as usize)?;
        let outermost = families.outermost(parents + again);
        if outermost >= parents {
            families.put_within(outermost, parent);
        } else if outermost != parent {
            return None;
        }
        families.give(face as usize, parents + again);
    }
    let mut again = families.all()[parents as usize..].iter();
    again.all(|again| again.above.is_some()).then_some(families)
}

/// Whether all that can be taken out again, or is a copy, comes behind all that cannot.
fn what_may_go_is_last(items: &Items) -> bool {
    let Items { counts, record, .. } = items;
    let split = record.splits.iter().map(|split| split.vertex);
    let inserted = record.inserted.iter().map(|inserted| inserted.vertex);
    let copies = items.fans.iter().map(|&[copy, _]| copy);
    let mut may_go: Vec<u32> = split.chain(inserted).chain(copies).collect();
    may_go.sort_unstable();
    may_go.dedup();
    are_last(&runs(may_go.into_iter()), counts.vertices)
        && are_last(&record.new_indices[0], counts.indices[0][1])
        && are_last(&record.new_indices[1], counts.indices[1][1])
}

/// Where the record does not say which elements were inserted, they are the last ones. If the file
/// has not as many as it had, nobody knows.
pub(super) fn settle(items: &mut Items, document: &Document) {
    let known = [document.texture.len(), document.normals.len()];
    let runs = items.record.new_indices.iter_mut();
    for ((runs, [before, all]), known) in runs.zip(items.counts.indices).zip(known) {
        if all as usize != known {
            runs.clear();
        } else if runs.is_empty() && before < all {
            push(runs, [before, all]);
        }
    }
}

/// Forgets slides whose corners got indices that may be others now: where the file has not as many
/// texture coordinates or normals as it had.
pub(super) fn forget_corners(document: &mut Document, items: &mut Items, place: Location) {
    let Items { counts, record, .. } = items;
    let all = document.counts();
    let is_known = [0, 1].map(|which| counts.indices[which][1] as usize == all[1 + which]);
    let is_lost = |exchange: &Exchange| !is_known[exchange.which];
    let forgotten = record
        .slides
        .iter()
        .filter(|slid| slid.exchanges.iter().any(is_lost));
    let mut vertices: Vec<u32> = forgotten.map(|slid| slid.vertex).collect();
    vertices.sort_unstable();
    vertices.dedup();
    if vertices.is_empty() {
        return;
    }
    // What was before is no use without what came later.
    let stays = |slid: &Slid| vertices.binary_search(&slid.vertex).is_err();
    record.slides.retain(stays);
    let stay = match vertices.len() {
        1 => "1 vertex that slid stays where it is".to_owned(),
        many => format!("{many} vertices that slid stay where they are"),
    };
    let which = if is_known[0] { "vn" } else { "vt" };
    let message = format!("{stay}: another program changed the number of `{which}`");
    document.diagnostics.push(Diagnostic {
        location: Some(place),
        ..Diagnostic::warning("W-OBJ-RECORD-SLID", place.line, message)
    });
}
