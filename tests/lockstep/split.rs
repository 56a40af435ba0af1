//! What a split must leave as it was.

use tearmesh::split::SplitRefusal;
use tearmesh::{HalfEdgeId, Masses, Mesh, Split, VertexId};

use super::mesh::{ends_differ, euler, only_these_marks_change};
use crate::oracle::Refused;

/// A refusal, in the words of the oracle.
pub(super) fn plain(refusal: SplitRefusal) -> Refused {
    match refusal {
        SplitRefusal::Empty { .. } => Refused::Empty,
        SplitRefusal::Everything { .. } => Refused::Everything,
        SplitRefusal::Foreign { face, .. } => Refused::Foreign(face.index()),
        SplitRefusal::Repeated { face, .. } => Refused::Repeated(face.index()),
        _ => unreachable!("there is no other kind"),
    }
}

/// I15 to I17: the frame of a split.
pub(super) fn changes_nothing_else(before: &Mesh, after: &Mesh, split: &Split<'_>) {
    let Split {
        old,
        new,
        corners,
        torn,
        ..
    } = *split;
    assert_eq!(
        before.vertex_count(),
        new.index(),
        "the new vertex is the last one"
    );
    assert_eq!(after.vertex_count(), new.index() + 1, "one vertex more");
    assert_eq!(after.face_count(), before.face_count(), "no face more");
    assert!(!corners.is_empty(), "a face moves");
    assert!(after.indices().contains(&old.into()), "a face stays");
    let mut moved = vec![false; before.half_edge_count()];
    for &h in corners {
        assert_eq!(before.origin(h), old, "{h} was a corner of {old}");
        assert!(!moved[h.index()], "{h} moves once");
        moved[h.index()] = true;
    }
    let walk = before.corners_of(old).filter(|h| moved[h.index()]);
    assert!(
        walk.eq(corners.iter().copied()),
        "corners in the order of a walk"
    );

    for h in before.half_edges() {
        let origin = match moved[h.index()] {
            true => new,
            false => before.origin(h),
        };
        assert_eq!(after.origin(h), origin, "origin of {h}");
    }
    let is_torn = |h| before.ghost_pair(h).is_some() || ends_differ(after, h);
    only_these_marks_change(before, after, is_torn, torn);
    let moves = |h: HalfEdgeId| h.face().half_edges().iter().any(|h| moved[h.index()]);
    for link in torn {
        assert!(moves(link.moved), "{} is of a face that moved", link.moved);
        assert!(!moves(link.stayed), "{} stayed", link.stayed);
    }
    let change = euler(after) - euler(before);
    assert_eq!(change, 1 - torn.len() as isize, "the Euler characteristic");
}

/// I20: the two halves weigh what the vertex weighed, bit for bit, and nothing else changed.
///
/// `weighs` says whether a vertex has a mass after the split.
pub(super) fn conserves_mass(
    before: &Masses,
    after: &Masses,
    split: &Split<'_>,
    weighs: impl Fn(VertexId) -> bool,
) {
    let (old, new) = (split.old, split.new);
    assert_eq!(
        after.at(old) + after.at(new),
        before.at(old),
        "m_old + m_new"
    );
    for half in [old, new] {
        assert_eq!(after.at(half) > 0.0, weighs(half), "whether {half} weighs");
    }
    for v in (0..before.vertex_count())
        .filter_map(VertexId::new)
        .filter(|&v| v != old)
    {
        assert_eq!(
            after.at(v).to_bits(),
            before.at(v).to_bits(),
            "the mass of {v}"
        );
    }
}
