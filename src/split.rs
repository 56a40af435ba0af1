//! The vertex split, the primitive of cutting and tearing.
//!
//! A vertex is replaced by two at the same place, and each of its faces goes to one of them (Souza
//! et al. 2014 §IV, Fig. 1). The pairs between the two sets of faces become ghost pairs (§IV-B,
//! Fig. 3). This is the only code that tears a link.
//!
//! "There must be at least one face on each side of the splitting plane. If this is not the case,
//! the routine of vertex splitting simply does nothing" (§IV-A): a refused split leaves the mesh
//! and the log bit-identical, and returns a [`SplitRefusal`] or `None`.
//!
//! The cost is at most linear in the number of faces that the vertex had when the mesh was built.
//! Nothing is allocated if [`Mesh::reserve`] and [`Edits::reserve`] reserved the memory.

use std::fmt;

use crate::classify;
use crate::edit::{Edit, Edits, Split, TornLink};
use crate::geometry::{Plane, Side};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// Splits the vertex `v`: the faces in `moving` move to a new vertex at the same place.
///
/// The new vertex gets the highest id, and the old one keeps the other faces. In this example the
/// upper faces move:
///
/// ```text
///   o-----o-----o            o-----o-----o
///   | \   |   / |            | \   |   / |
///   |   \ | /   |            |   \ | /   |
///   p-----v-----q            p----new----q    p and q are drawn twice, and are one vertex each.
///   |   / | \   |     ->                      The pairs along p v and v q are ghost pairs now:
///   | /   |   \ |            p-----v-----q    a walk round v or the new vertex goes on through
///   o-----o-----o            |   / | \   |    them, and so finds all faces of either.
///                            | /   |   \ |
///                            o-----o-----o
/// ```
///
/// # Errors
///
/// [`SplitRefusal`] gives the reason for a refusal. Nothing has changed then.
///
/// # Panics
///
/// If `v` or a face is not in this mesh (I2).
///
/// ```
/// use tearmesh::{split, Edits, Mesh};
///
/// let mut mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
/// let mut edits = Edits::new();
/// let (v, face) = (mesh.vertex(1), mesh.face(1));
/// let split = split::vertex(&mut mesh, v, &[face], &mut edits)?;
/// assert_eq!((split.new.index(), split.corners.len(), split.torn.len()), (4, 1, 1));
/// assert_eq!(mesh.indices(), [0, 1, 2, 2, 4, 3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn vertex<'e>(
    mesh: &mut Mesh,
    v: VertexId,
    moving: &[FaceId],
    edits: &'e mut Edits,
) -> Result<Split<'e>, SplitRefusal> {
    // A foreign id is found before anything is changed.
    let start = mesh.half_edge_of(v);
    for &face in moving {
        mesh.half_edges_of(face);
    }
    let new = mesh.next_vertex();
    for (i, &face) in moving.iter().enumerate() {
        if let Some(h) = corner_at(mesh, face, v) {
            mesh.set_origin(h, new);
        } else {
            let repeated = corner_at(mesh, face, new).is_some();
            give_back(mesh, v, &moving[..i]);
            return Err(if repeated {
                SplitRefusal::Repeated { vertex: v, face }
            } else {
                SplitRefusal::Foreign { vertex: v, face }
            });
        }
    }
    if moving.is_empty() {
        return Err(SplitRefusal::Empty { vertex: v });
    }
    let start = start.expect("I9: a vertex with a face has a half-edge");
    // Corners are noted in the order of a walk from the start; one alone is in order.
    let from = match moving {
        &[face] => corner_at(mesh, face, new).unwrap_or(start),
        _ => start,
    };
    let moved = mesh.orbit(from).filter(|&h| mesh.origin(h) == new);
    for h in moved.take(moving.len()) {
        edits.note_corner(h);
    }
    let Some(stays) = smallest_from(mesh, v, start) else {
        edits.discard_noted();
        give_back(mesh, v, moving);
        return Err(SplitRefusal::Everything { vertex: v });
    };
    Ok(commit(mesh, v, stays, edits))
}

/// Splits these corners off a vertex: some of its own in the order of a walk. `stays` is the smallest
/// of the others. Linear in those that move.
pub(crate) fn into(
    mesh: &mut Mesh,
    v: VertexId,
    moving: &[HalfEdgeId],
    stays: HalfEdgeId,
    edits: &mut Edits,
) {
    debug_assert!(moving.iter().all(|&h| mesh.origin(h) == v && h != stays));
    moving.iter().for_each(|&h| edits.note_corner(h));
    commit(mesh, v, stays, edits);
}

/// Splits a vertex by a plane: the faces whose centres are strictly behind the plane move to a new
/// vertex (Souza et al. 2014 §IV). Returns `None`, and changes nothing, if all faces are on one
/// side.
///
/// ```text
///          front                 front
///   o-----o-----o            o-----o-----o
///   | \   |   / |            | \   |   / |
///   |   \ | /   |            |   \ | /   |    A face goes to the side on which its centre lies.
///  -p-----v-----q- plane     p-----v-----q
///   |   / | \   |     ->
///   | /   |   \ |            p----new----q
///   o-----o-----o            |   / | \   |
///           back             | /   |   \ |
///                            o-----o-----o
///                                back
/// ```
///
/// In the paper the plane passes through the vertex, but any plane is allowed. A centre on the
/// plane counts as in front of it (see [`classify::face`]).
///
/// # Panics
///
/// If `v` is not in this mesh (I2), or `place` does not store the position of one of its neighbours.
pub fn by_plane<'e>(
    mesh: &mut Mesh,
    v: VertexId,
    plane: &Plane,
    place: &(impl Place + ?Sized),
    edits: &'e mut Edits,
) -> Option<Split<'e>> {
    let noting = Noting(&mut *edits);
    let mut stays = None;
    for h in mesh.corners_of(v) {
        if classify::face(mesh, h.face(), plane, place) == Side::Back {
            noting.0.note_corner(h);
        } else {
            stays = Some(stays.map_or(h, |least: HalfEdgeId| least.min(h)));
        }
    }
    let stays = stays.filter(|_| !noting.0.noted().is_empty())?;
    std::mem::forget(noting);
    Some(commit(mesh, v, stays, edits))
}

/// Drops what was noted, unless it is forgotten: `place` is the caller's, and may panic.
struct Noting<'e>(&'e mut Edits);

impl Drop for Noting<'_> {
    fn drop(&mut self) {
        self.0.discard_noted();
    }
}

/// The smallest corner of a vertex, given one that none of them is below; `None` if there is none.
///
/// A walk round the vertex and a search upwards take turns, and the shorter one ends it. No later
/// split needs to search again what was searched, since the smallest corner only grows: so a vertex
/// is torn into all its faces in time linear in the mesh, and not in the square of its faces.
fn smallest_from(mesh: &Mesh, v: VertexId, start: HalfEdgeId) -> Option<HalfEdgeId> {
    let mut walk = mesh.orbit(start);
    let mut least: Option<HalfEdgeId> = None;
    for h in (start.to_u32()..mesh.half_edge_count() as u32).map(HalfEdgeId::from_u32) {
        if mesh.origin(h) == v {
            return Some(h);
        }
        let Some(g) = walk.next() else {
            return least;
        };
        if mesh.origin(g) == v {
            least = Some(least.map_or(g, |least| least.min(g)));
        }
    }
    None
}

/// Carries out the split that was noted. `stays` is the smallest corner that stays.
fn commit<'e>(mesh: &mut Mesh, v: VertexId, stays: HalfEdgeId, edits: &'e mut Edits) -> Split<'e> {
    let (new, size) = (mesh.next_vertex(), mesh.size());
    let noted = edits.noted();
    let corners = noted.clone().map(|i| edits.corner(i));
    let first = corners.min().expect("a split moves a corner");
    for i in noted.clone() {
        mesh.set_origin(edits.corner(i), new);
    }
    mesh.set_half_edge_of(v, stays);
    mesh.push_vertex(first);
    for i in noted {
        let corner = edits.corner(i);
        // The two edges of the corner's face at the vertex, and the corner across each.
        for (moved, turn) in [(corner.prev(), false), (corner, true)] {
            let Some(stayed) = mesh.pair(moved) else {
                continue;
            };
            let across = if turn { stayed.next() } else { stayed };
            if mesh.origin(across) != new {
                debug_assert_eq!(mesh.origin(across), v, "I6: both ends of a pair agree");
                mesh.tear(moved, stayed);
                edits.note_link(TornLink { stayed, moved });
            }
        }
    }
    let split = Split {
        before: edits.cursor(),
        old: v,
        new,
        corners: &[],
        torn: &[],
    };
    let Edit::Split(split) = edits.finish(Edit::Split(split), 0, size) else {
        unreachable!("a split was finished");
    };
    split
}

/// Undoes the relabelling of faces that turned out not to move.
fn give_back(mesh: &mut Mesh, v: VertexId, moving: &[FaceId]) {
    let new = mesh.next_vertex();
    for &face in moving {
        if let Some(h) = corner_at(mesh, face, new) {
            mesh.set_origin(h, v);
        }
    }
}

fn corner_at(mesh: &Mesh, face: FaceId, v: VertexId) -> Option<HalfEdgeId> {
    face.half_edges().into_iter().find(|&h| mesh.origin(h) == v)
}

/// The reason why a split was refused. A refused split changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SplitRefusal {
    /// The set of faces to move was empty.
    Empty {
        /// The vertex that was not split.
        vertex: VertexId,
    },
    /// The set contained all faces of the vertex, which would leave it without a face.
    Everything {
        /// The vertex that was not split.
        vertex: VertexId,
    },
    /// A face of the set was not a face of the vertex.
    Foreign {
        /// The vertex that was not split.
        vertex: VertexId,
        /// The face that is not a face of the vertex.
        face: FaceId,
    },
    /// The set contained a face twice.
    Repeated {
        /// The vertex that was not split.
        vertex: VertexId,
        /// The face that the set contained twice.
        face: FaceId,
    },
}

impl fmt::Display for SplitRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SplitRefusal::Empty { vertex } => {
                write!(f, "{vertex} was not split: no face was to move")
            }
            SplitRefusal::Everything { vertex } => {
                write!(f, "{vertex} was not split: all its faces were to move")
            }
            SplitRefusal::Foreign { vertex, face } => {
                write!(f, "{vertex} was not split: {face} does not have it")
            }
            SplitRefusal::Repeated { vertex, face } => {
                write!(f, "{vertex} was not split: {face} was named twice")
            }
        }
    }
}

impl std::error::Error for SplitRefusal {}
