//! What a merge must do, and what it must leave as it was.

use tearmesh::mend::{self, MergeRefusal, Stitch};
use tearmesh::{Cursor, Edit, Edits, HalfEdgeId, Merge, Mesh, Split, VertexId};

use super::mesh::{ends_differ, euler, only_these_marks_change};
use crate::oracle::{Soup, Unmerged};

fn merge_of<'e>(edit: &Edit<'e>) -> Merge<'e> {
    match *edit {
        Edit::Merge(merge) => merge,
        ref other => panic!("not a merge: {other:?}"),
    }
}

/// Merges what a record says; the soup must agree on which of the two stays.
pub(super) fn is_carried_out(soup: &mut Soup, edit: &Edit<'_>) {
    let merge = merge_of(edit);
    let [kept, gone] = [merge.kept, merge.gone].map(VertexId::index);
    let merged = soup.merge(gone, kept, merge.share);
    assert_eq!(merged, Ok([kept, gone]), "kept and gone");
}

pub(super) fn is_refused_where_it_should(
    soup: &Soup,
    one: VertexId,
    other: VertexId,
    weights: [f64; 2],
    outcome: Result<Cursor, MergeRefusal>,
) {
    let expected = soup.clone().merge(one.index(), other.index(), 0.5);
    match outcome {
        Err(MergeRefusal::Weights { given }) => {
            assert_eq!(given, weights);
            let has_negative = weights.iter().any(|&weight| weight < 0.0);
            assert!(has_negative, "{weights:?} are weights");
        }
        Err(refusal) => {
            let refused = match refusal {
                MergeRefusal::Same { .. } => Unmerged::Same,
                _ => Unmerged::Apart,
            };
            assert_eq!(expected, Err(refused));
        }
        Ok(_) => {
            assert!(expected.is_ok(), "{expected:?} was not refused");
            assert!(weights.iter().all(|&weight| weight >= 0.0));
        }
    }
}

/// The share is that of the vertex that stays, whichever was named first.
pub(super) fn has_the_weights(edit: &Edit<'_>, one: VertexId, weights: [f64; 2]) {
    let merge = merge_of(edit);
    let kept = weights[usize::from(merge.kept != one)];
    let sum = weights[0] + weights[1];
    let share = if sum == 0.0 { 0.5 } else { kept / sum };
    let is = merge.share;
    assert!((is - share).abs() < 1e-15, "{is} instead of {share}");
}

/// Makes the merge of a record again; it must come out the same.
pub(super) fn is_a_merge(before: &Mesh, edit: &Edit<'_>) -> Mesh {
    let merge = merge_of(edit);
    let mut mesh = before.clone();
    let mut edits = Edits::starting_at(edit.before());
    let again = mend::merge(&mut mesh, merge.kept, merge.gone, [1.0, 1.0], &mut edits);
    let again = again.map(|again| Merge {
        share: merge.share,
        ..again
    });
    assert_eq!(again, Ok(merge), "a merge of sewing is a merge");
    mesh
}

/// I15 to I17: the frame of a merge.
pub(super) fn changes_nothing_else(before: &Mesh, after: &Mesh, edit: &Edit<'_>) {
    let Merge {
        kept,
        gone,
        corners,
        renumbered,
        sewn,
        ..
    } = merge_of(edit);
    assert!(kept < gone, "the lower id stays");
    let last = before.vertex_count() - 1;
    let counts = (after.vertex_count(), after.face_count());
    assert_eq!(counts, (last, before.face_count()), "one vertex less");
    let sorted = |corners: &[HalfEdgeId]| {
        let mut corners = corners.to_vec();
        corners.sort();
        corners
    };
    let of = |v: VertexId| -> Vec<HalfEdgeId> {
        let is_of = |h: &HalfEdgeId| before.origin(*h) == v;
        before.half_edges().filter(is_of).collect()
    };
    assert_eq!(sorted(corners), of(gone), "the corners of {gone}");
    assert!(renumbered.is_some() == (gone.index() != last), "the last");
    if let Some(it) = renumbered {
        assert_eq!((it.from.index(), it.to), (last, gone));
        assert_eq!(sorted(it.corners), of(it.from), "corners of the last");
    }
    for h in before.half_edges() {
        let origin = match before.origin(h) {
            v if v == gone => kept,
            v if v.index() == last => gone,
            v => v,
        };
        assert_eq!(after.origin(h), origin, "origin of {h}");
    }
    let is_torn = |h| before.ghost_pair(h).is_some() && ends_differ(after, h);
    only_these_marks_change(before, after, is_torn, sewn);
    for link in sewn {
        let had = |h: HalfEdgeId, v| [before.origin(h), before.target(h)].contains(&v);
        assert!(had(link.stayed, kept), "{} is of {kept}", link.stayed);
        assert!(had(link.moved, gone), "{} came over", link.moved);
    }
    let change = euler(after) - euler(before);
    assert_eq!(change, sewn.len() as isize - 1, "the Euler characteristic");
}

/// I21: a merge of the last split undoes it, bit for bit.
pub(super) fn undoes_the_last_split(before: &Mesh, after: &Mesh, split: &Split<'_>) {
    let mut mesh = after.clone();
    let mut edits = Edits::new();
    let (old, new) = (split.old, split.new);
    let merge = mend::merge(&mut mesh, new, old, [1.0, 3.0], &mut edits).expect("just split");
    assert_eq!(merge.corners.len(), split.corners.len());
    let goes_back = |h| merge.corners.contains(h);
    assert!(split.corners.iter().all(goes_back), "the corners go back");
    let (torn, sewn) = (split.torn, merge.sewn);
    let is_sewn = torn.len() == sewn.len() && torn.iter().all(|link| sewn.contains(link));
    assert!(is_sewn, "what was torn is sewn: {torn:?}, {sewn:?}");
    assert_eq!((merge.kept, merge.renumbered), (old, None));
    assert_eq!(mesh, *before, "a merge undoes the split");
}

/// All copies that were in a stitch are one, and where all copies were chosen, no edge between
/// them is torn.
pub(super) fn copies_are_sewn(before: &Mesh, after: &Mesh, stitches: &[Stitch]) {
    assert_eq!(after.vertex_count() + stitches.len(), before.vertex_count());
    let copies = |mesh: &Mesh| {
        let roots = mesh.roots();
        let is_copy = |&(v, &root): &(usize, &u32)| root as usize != v;
        roots.iter().enumerate().filter(is_copy).count()
    };
    let left = copies(before) - stitches.len();
    assert_eq!(copies(after), left, "copies that are left");
    if copies(after) == 0 {
        let torn = after.half_edges().find(|&h| after.ghost_pair(h).is_some());
        assert_eq!(torn, None, "nothing is torn where there are no copies");
    }
}
