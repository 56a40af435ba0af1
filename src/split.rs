//! The vertex split: the primitive on which cutting and tearing stand.
//!
//! A vertex is replaced by two at the same place, and each of its faces goes to one of
//! them (Souza et al. 2014 §IV, Fig. 1). The pairs between the two sets of faces become ghost
//! pairs (§IV-B, Fig. 3). This is the only code that tears a link.
//!
//! "There must be at least one face on each side of the splitting plane. If this
//! is not the case, the routine of vertex splitting simply does nothing" (§IV-A): a
//! refused split leaves mesh and log bit-identical, and is a value rather than an error.
//!
//! Cost: linear in the faces that the vertex had when the mesh was built, and nothing is
//! allocated where [`Mesh::reserve`] and [`Edits::reserve`] made room. The sets are told
//! apart without a table: a corner that moves is relabelled at once, and relabelled back if
//! the split turns out to be none.

use std::fmt;

use crate::classify;
use crate::edit::{Edits, Split, TornLink};
use crate::geometry::{Plane, Side};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// Splits a vertex: these of its faces move to a new vertex at the same place.
///
/// The new vertex is the last one of the mesh; the old one keeps the other faces.
///
/// # Errors
///
/// [`Refusal`] says why nothing was changed.
///
/// # Panics
///
/// If the vertex or a face is none of this mesh.
///
/// ```
/// use tearmesh::{split, Edits, FaceId, Mesh, VertexId};
///
/// let mut mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
/// let mut edits = Edits::new();
/// let v = VertexId::new(1).unwrap();
/// let split = split::faces(&mut mesh, v, &[FaceId::new(1).unwrap()], &mut edits)?;
/// assert_eq!((split.new.index(), split.corners.len(), split.torn.len()), (4, 1, 1));
/// assert_eq!(mesh.indices(), [0, 1, 2, 2, 4, 3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn faces<'e>(
    mesh: &mut Mesh,
    v: VertexId,
    moving: &[FaceId],
    edits: &'e mut Edits,
) -> Result<Split<'e>, Refusal> {
    assert!(
        v.index() < mesh.vertex_count(),
        "{v} is no vertex of this mesh"
    );
    let new = mesh.next_vertex();
    for (i, &face) in moving.iter().enumerate() {
        if let Some(h) = corner_at(mesh, face, v) {
            mesh.set_origin(h, new);
        } else {
            let repeated = corner_at(mesh, face, new).is_some();
            give_back(mesh, v, &moving[..i]);
            return Err(if repeated {
                Refusal::Repeated { vertex: v, face }
            } else {
                Refusal::Foreign { vertex: v, face }
            });
        }
    }
    if moving.is_empty() {
        return Err(Refusal::Empty { vertex: v });
    }
    // A vertex with a face in the set has an orbit to walk; the start is as good a corner
    // as any, whether or not it moves.
    let start = mesh
        .half_edge_of(v)
        .expect("I9: a vertex with a face has a half-edge");
    let mut stays = None;
    for h in mesh.orbit(start) {
        if mesh.origin(h) == new {
            edits.note_corner(h);
        } else if mesh.origin(h) == v {
            stays = Some(stays.map_or(h, |least: HalfEdgeId| least.min(h)));
        }
    }
    let Some(stays) = stays else {
        edits.discard_noted();
        give_back(mesh, v, moving);
        return Err(Refusal::Everything { vertex: v });
    };
    Ok(commit(mesh, v, stays, edits))
}

/// Splits a vertex by a plane: its faces whose centres are strictly behind the plane move
/// to a new vertex (Souza et al. 2014 §IV). `None` if all are on one side: then
/// nothing has changed.
///
/// In the paper the plane passes through the vertex; any plane will do. A centre
/// on the plane is in front of it (see [`classify::face`]).
///
/// # Panics
///
/// If the vertex is none of this mesh, or `place` does not know one of its neighbours.
pub fn by_plane<'e>(
    mesh: &mut Mesh,
    v: VertexId,
    plane: &Plane,
    place: &(impl Place + ?Sized),
    edits: &'e mut Edits,
) -> Option<Split<'e>> {
    let mut stays = None;
    for h in mesh.corners_of(v) {
        if classify::face(mesh, h.face(), plane, place) == Side::Back {
            edits.note_corner(h);
        } else {
            stays = Some(stays.map_or(h, |least: HalfEdgeId| least.min(h)));
        }
    }
    match stays {
        Some(stays) if edits.has_noted() => Some(commit(mesh, v, stays, edits)),
        _ => {
            edits.discard_noted();
            None
        }
    }
}

/// Carries out the split that was noted. `stays` is the smallest corner that stays.
fn commit<'e>(mesh: &mut Mesh, v: VertexId, stays: HalfEdgeId, edits: &'e mut Edits) -> Split<'e> {
    let new = mesh.next_vertex();
    let noted = edits.noted();
    let first = noted
        .clone()
        .map(|i| edits.corner(i))
        .min()
        .expect("a split moves a corner");
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
    edits.finish_split(v, new)
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

/// Why a split was refused. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No face was to move.
    Empty {
        /// The vertex that was to be split.
        vertex: VertexId,
    },
    /// All faces of the vertex were to move.
    Everything {
        /// The vertex that was to be split.
        vertex: VertexId,
    },
    /// A face does not have the vertex.
    Foreign {
        /// The vertex that was to be split.
        vertex: VertexId,
        /// The face.
        face: FaceId,
    },
    /// A face was named twice.
    Repeated {
        /// The vertex that was to be split.
        vertex: VertexId,
        /// The face.
        face: FaceId,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refusal::Empty { vertex } => {
                write!(f, "{vertex} was not split: no face was to move")
            }
            Refusal::Everything { vertex } => {
                write!(f, "{vertex} was not split: all its faces were to move")
            }
            Refusal::Foreign { vertex, face } => {
                write!(f, "{vertex} was not split: {face} does not have it")
            }
            Refusal::Repeated { vertex, face } => {
                write!(f, "{vertex} was not split: {face} was named twice")
            }
        }
    }
}

impl std::error::Error for Refusal {}
