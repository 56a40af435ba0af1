//! The merge, which is the inverse of the split, and the sewing of seams.
//!
//! Two vertices that were split from the same vertex become one again, and ghost pairs whose ends
//! agree again become pairs. This is the only code that sews a link. Undoing splits in reverse
//! order restores the mesh bit for bit. In any other order, the last vertex takes the id that
//! becomes free, and the record reports it. Any two vertices with the same root may be merged, so a
//! seam may be sewn in part. The result is a torn mesh like any other: the corners of a vertex
//! still lie in one orbit (I8).
//!
//! Souza et al. 2014 has no merge. It is simple because a split only relabels corners.

use std::collections::BinaryHeap;
use std::fmt;

use crate::edit::{Edit, Edits, Merge, Renumbered, TornLink};
use crate::geometry::length;
use crate::id::VertexId;
use crate::mesh::Mesh;
use crate::place::Place;

/// Merges two vertices that have the same root: the one with the lower id gets the corners of the other.
///
/// ```text
///   o-----o-----o            o-----o-----o
///   | \   |   / |            | \   |   / |
///   |   \ | /   |            |   \ | /   |
///   p----gone---q            p---kept----q    Ghost pairs whose ends agree again are pairs.
///                      ->    |   / | \   |    The last vertex of the mesh takes the id of the one
///   p----kept---q            | /   |   \ |    that is gone.
///   |   / | \   |            o-----o-----o
///   | /   |   \ |
///   o-----o-----o
/// ```
///
/// `weights` are those of `one` and `other`, usually their masses. Followers set positions,
/// velocities and other values to the weighted mean. If both weights are zero, they count as equal.
///
/// The cost is linear in the number of faces that the vertex had before it was first split. Nothing
/// is allocated if the log has free capacity.
///
/// # Errors
///
/// [`MergeRefusal`] gives the reason for a refusal. Nothing has changed then.
///
/// # Panics
///
/// If a vertex is not in this mesh (I2).
///
/// ```
/// use tearmesh::{mend, shapes, split, Edits};
///
/// let (mut mesh, _) = shapes::grid(1, 1);
/// let uncut = mesh.clone();
/// let mut edits = Edits::new();
/// let (v, face) = (mesh.vertex(0), mesh.face(0));
/// let new = split::vertex(&mut mesh, v, &[face], &mut edits)?.new;
/// let merge = mend::merge(&mut mesh, v, new, [1.0, 1.0], &mut edits)?;
/// assert_eq!((merge.kept, merge.sewn.len()), (v, 1));
/// assert_eq!(mesh, uncut);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn merge<'e>(
    mesh: &mut Mesh,
    one: VertexId,
    other: VertexId,
    weights: [f64; 2],
    edits: &'e mut Edits,
) -> Result<Merge<'e>, MergeRefusal> {
    let corners = [one.min(other), one.max(other)].map(|v| mesh.half_edge_of(v));
    let share = share_of_first(weights).ok_or(MergeRefusal::Weights { given: weights })?;
    if one == other {
        return Err(MergeRefusal::Same { vertex: one });
    }
    let (kept, gone, share) = if one < other {
        (one, other, share)
    } else {
        (other, one, 1.0 - share)
    };
    let [Some(_), Some(first)] = corners else {
        return Err(MergeRefusal::Roots { one, other });
    };
    let mut of_kept = false;
    for h in mesh.orbit(first) {
        match mesh.origin(h) {
            v if v == gone => edits.note_corner(h),
            v => of_kept |= v == kept,
        }
    }
    if !of_kept {
        edits.discard_noted();
        return Err(MergeRefusal::Roots { one, other });
    }
    let note_corners = |mesh: &Mesh, v, edits: &mut Edits| {
        mesh.corners_of(v).for_each(|h| edits.note_corner(h));
    };
    Ok(commit(mesh, [kept, gone], share, edits, note_corners))
}

/// The part of the first of two weights in their sum.
fn share_of_first([one, other]: [f64; 2]) -> Option<f64> {
    let sum = one + other;
    if !(one >= 0.0 && other >= 0.0 && sum.is_finite()) {
        return None;
    }
    Some(if sum > 0.0 { one / sum } else { 0.5 })
}

/// Carries out the merge whose corners were noted. `note_corners` notes those of another vertex.
fn commit<'e>(
    mesh: &mut Mesh,
    [kept, gone]: [VertexId; 2],
    share: f64,
    edits: &'e mut Edits,
    note_corners: impl FnOnce(&Mesh, VertexId, &mut Edits),
) -> Merge<'e> {
    let (size, noted) = (mesh.size(), edits.noted());
    for i in noted.clone() {
        mesh.set_origin(edits.corner(i), kept);
    }
    let first = [kept, gone].map(|v| mesh.half_edge_of(v));
    if let [Some(one), Some(other)] = first {
        mesh.set_half_edge_of(kept, one.min(other));
    }
    for i in noted {
        let corner = edits.corner(i);
        for moved in [corner.prev(), corner] {
            let Some(stayed) = mesh.ghost_pair(moved) else {
                continue;
            };
            let agree = mesh.origin(moved) == mesh.target(stayed)
                && mesh.target(moved) == mesh.origin(stayed);
            if agree {
                mesh.sew(moved, stayed);
                edits.note_link(TornLink { stayed, moved });
            }
        }
    }
    let moved = edits.noted().end;
    // The last vertex gets the id of the one that goes.
    let last = VertexId::from_u32(mesh.next_vertex().to_u32() - 1);
    if gone != last {
        note_corners(mesh, last, edits);
        for i in moved..edits.noted().end {
            mesh.set_origin(edits.corner(i), gone);
        }
    }
    mesh.swap_remove_vertex(gone);
    let merge = Merge {
        before: edits.cursor(),
        kept,
        gone,
        share,
        corners: &[],
        renumbered: (gone != last).then_some(Renumbered {
            from: last,
            to: gone,
            corners: &[],
        }),
        sewn: &[],
    };
    let Edit::Merge(merge) = edits.finish(Edit::Merge(merge), moved, size) else {
        unreachable!("a merge was finished");
    };
    merge
}

/// A request to merge two vertices that have the same root.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stitch {
    /// The vertex that goes: the higher id.
    gone: VertexId,
    /// The vertex that stays.
    kept: VertexId,
}

impl Stitch {
    /// Creates the stitch that joins two different vertices, in either order. Returns `None` if
    /// both are the same vertex.
    #[must_use]
    pub fn new(one: VertexId, other: VertexId) -> Option<Stitch> {
        (one != other).then(|| Stitch {
            gone: one.max(other),
            kept: one.min(other),
        })
    }

    /// Returns the vertex that the merge removes: the one with the higher id.
    #[must_use]
    pub fn gone(&self) -> VertexId {
        self.gone
    }

    /// Returns the vertex that the merge keeps: the one with the lower id.
    #[must_use]
    pub fn kept(&self) -> VertexId {
        self.kept
    }
}

/// Returns the stitches that join all vertices for which `chosen` returns true and that have the
/// same root. Each is joined to the lowest of them. Linear in the size of the mesh.
///
/// ```
/// use tearmesh::{mend, shapes, split, Edits};
///
/// let (mut mesh, mut positions) = shapes::grid(4, 4);
/// let uncut = mesh.clone();
/// let mut edits = Edits::new();
/// for v in uncut.vertices().skip(6).take(9) {
///     let first = mesh.faces_of(v).next().unwrap();
///     split::vertex(&mut mesh, v, &[first], &mut edits)?;
/// }
/// edits.replay(&mut positions);
///
/// let stitches = mend::stitches(&mesh, |_| true);
/// mend::sew(&mut mesh, &positions, &stitches, |_| 1.0, f64::INFINITY, &mut edits)?;
/// assert_eq!(mesh, uncut);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn stitches(mesh: &Mesh, chosen: impl Fn(VertexId) -> bool) -> Vec<Stitch> {
    let roots = mesh.all_roots();
    let mut lowest = vec![None; mesh.vertex_count()];
    let mut stitches = Vec::new();
    for v in mesh.vertices().filter(|&v| chosen(v)) {
        match &mut lowest[roots[v.index()].index()] {
            Some(kept) => stitches.extend(Stitch::new(*kept, v)),
            none => *none = Some(v),
        }
    }
    stitches
}

/// Carries out many stitches, those with the highest ids first, and returns the number of merges.
/// If a vertex is removed by two stitches, all three vertices become one.
///
/// `place` is read before anything is changed. `weight` returns the weight of each vertex, usually
/// its mass, as for [`merge`]. If all splits of a mesh are undone, all ids are the same as before
/// the splits. Linear in the size of the mesh if the faces of each copy are contiguous.
///
/// # Errors
///
/// [`SewError`] lists every stitch whose vertices have different roots, have no usable weight, or
/// are farther apart than `max_distance`. Nothing has changed then.
///
/// # Panics
///
/// If a vertex is not in this mesh (I2), or its position is not stored in `place`.
pub fn sew(
    mesh: &mut Mesh,
    place: &(impl Place + ?Sized),
    stitches: &[Stitch],
    weight: impl Fn(VertexId) -> f64,
    max_distance: f64,
    edits: &mut Edits,
) -> Result<usize, SewError> {
    let roots = mesh.all_roots();
    let mut refused = Vec::new();
    for &stitch in stitches {
        let Stitch { gone, kept } = stitch;
        let [one, other] = [gone, kept].map(|v| v.of(&roots));
        let distance = length(place.at(gone) - place.at(kept));
        if one != other {
            refused.push((stitch, StitchError::Roots));
        } else if share_of_first([weight(gone), weight(kept)]).is_none() {
            refused.push((stitch, StitchError::Weights));
        } else if distance.is_nan() || distance > max_distance {
            refused.push((stitch, StitchError::Distance { distance }));
        }
    }
    if !refused.is_empty() {
        return Err(SewError { refused });
    }
    let copies = copies(mesh, &roots, weight);
    Ok(sew_checked(mesh, stitches, copies, edits))
}

/// Carries out stitches that are not refused, with what is known of each vertex.
fn sew_checked(
    mesh: &mut Mesh,
    stitches: &[Stitch],
    mut copies: Vec<Copied>,
    edits: &mut Edits,
) -> usize {
    // Highest first: what is renumbered on the way is above all that is still to go, and so
    // is in no stitch.
    let mut rest: BinaryHeap<Stitch> = stitches.iter().copied().collect();
    let mut merges = 0;
    while let Some(Stitch { gone, kept }) = rest.pop() {
        let [one, other] = [kept, gone].map(|v| copies[v.index()]);
        let share = share_of_first([one.weight, other.weight]).expect("stitches were checked");
        other.note_corners(mesh, gone, edits);
        commit(mesh, [kept, gone], share, edits, |mesh, v, edits| {
            copies[v.index()].note_corners(mesh, v, edits);
        });
        let joined = &mut copies[kept.index()];
        joined.weight += other.weight;
        joined.corners += other.corners;
        copies.swap_remove(gone.index());
        merges += 1;
        // `gone` is now `kept`: stitches that name it too are those of `kept`.
        while rest.peek().is_some_and(|stitch| stitch.gone == gone) {
            let also = rest.pop().and_then(|stitch| Stitch::new(stitch.kept, kept));
            rest.extend(also);
        }
    }
    merges
}

/// What sewing knows of each vertex, so that it need not walk round a whole hub for each copy.
#[derive(Clone, Copy)]
struct Copied {
    weight: f64,
    corners: usize,
    /// Whether the boundary of the mesh as it was built passes through it.
    open: bool,
}

fn copies(mesh: &Mesh, roots: &[VertexId], weight: impl Fn(VertexId) -> f64) -> Vec<Copied> {
    let whole = |v| Copied {
        weight: weight(v),
        corners: 0,
        open: false,
    };
    let mut of: Vec<Copied> = mesh.vertices().map(whole).collect();
    for h in mesh.half_edges() {
        let v = mesh.origin(h);
        of[v.index()].corners += 1;
        of[roots[v.index()].index()].open |= mesh.ahead(h).is_none();
    }
    for v in mesh.vertices() {
        of[v.index()].open = of[roots[v.index()].index()].open;
    }
    of
}

impl Copied {
    /// Notes the corners of a vertex as a walk meets them. It goes both ways in turn, so that it
    /// ends with the last of them and not with the last of all copies.
    fn note_corners(self, mesh: &Mesh, v: VertexId, edits: &mut Edits) {
        let mut ahead = mesh.half_edge_of(v);
        let mut behind = ahead.and_then(|h| mesh.behind(h));
        let mut left = self.corners;
        let mut on_other_side = Vec::new();
        while left > 0 {
            if let Some(h) = ahead {
                if mesh.origin(h) == v {
                    edits.note_corner(h);
                    left -= 1;
                }
                ahead = mesh.ahead(h);
            }
            if let (true, Some(h)) = (left > 0, behind) {
                if mesh.origin(h) == v {
                    on_other_side.push(h);
                    left -= 1;
                }
                behind = mesh.behind(h);
            }
        }
        if !self.open {
            on_other_side.reverse(); // A walk comes to them from the other side.
        }
        on_other_side.iter().for_each(|&h| edits.note_corner(h));
    }
}

/// The reason why a merge was refused. A refused merge changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MergeRefusal {
    /// The two vertices are the same.
    Same {
        /// The vertex given as both.
        vertex: VertexId,
    },
    /// The vertices have different roots: they were not split from the same vertex.
    Roots {
        /// The first vertex given.
        one: VertexId,
        /// The second vertex given.
        other: VertexId,
    },
    /// A weight is negative or not finite, or the sum of both weights is not finite.
    Weights {
        /// The weights given, in the order of the vertices.
        given: [f64; 2],
    },
}

impl fmt::Display for MergeRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MergeRefusal::Same { vertex } => write!(f, "{vertex} was not merged with itself"),
            MergeRefusal::Roots { one, other } => {
                write!(
                    f,
                    "{one} and {other} were not merged: they were not split from the same vertex"
                )
            }
            MergeRefusal::Weights {
                given: [one, other],
            } => {
                write!(
                    f,
                    "nothing was merged: the weights {one} and {other} must be finite and not negative"
                )
            }
        }
    }
}

impl std::error::Error for MergeRefusal {}

/// The reasons why stitches were refused. Nothing has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct SewError {
    refused: Vec<(Stitch, StitchError)>,
}

impl SewError {
    /// Returns each refused stitch with the reason. The list is never empty.
    #[must_use]
    pub fn refused(&self) -> &[(Stitch, StitchError)] {
        &self.refused
    }
}

/// The reason why a stitch was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StitchError {
    /// The vertices have different roots: they were not split from the same vertex.
    Roots,
    /// A weight is negative or not finite, or the sum of both weights is not finite.
    Weights,
    /// The vertices are farther apart than the limit, or their distance is NaN.
    Distance {
        /// The distance between the vertices.
        distance: f64,
    },
}

impl fmt::Display for SewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some((Stitch { gone, kept }, why)) = self.refused.first() else {
            return f.write_str("nothing was refused");
        };
        write!(f, "{kept} and {gone} cannot be sewn: ")?;
        match why {
            StitchError::Roots => f.write_str("they were not split from the same vertex")?,
            StitchError::Weights => f.write_str("their weights must be finite and not negative")?,
            StitchError::Distance { distance } => write!(f, "they are {distance} apart")?,
        }
        match self.refused.len() {
            1 => Ok(()),
            more => write!(f, " (and {} more)", more - 1),
        }
    }
}

impl std::error::Error for SewError {}
