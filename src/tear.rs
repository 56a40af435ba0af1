//! The tearing rule, which selects the vertex of an overstretched edge to split and the plane to split it by.
//!
//! "Whenever the stretching of an edge reaches a specified threshold value, we select one of the
//! edge's adjacent vertices to be split. If both vertices can be split, we choose the one with the
//! highest mass value. If the overstretched edge is formed by the vertices A and B and A is the
//! vertex chosen to be split, the splitting plane is given by the vertex A and its normal is the
//! vector B − A" (Souza et al. 2014 §III-A). If both masses are equal, the lower id is chosen, so
//! the result does not depend on which half-edge is given.
//!
//! The rule is independent of any cloth model. It reads the positions ([`Place`]) and masses of
//! vertices, and writes each split to the log. The simulation decides which edge is overstretched, and
//! applies a split to its particles and constraints. This is a complete simulation that uses the rule:
//!
//! ```
//! use tearmesh::{shapes, tear, Blend, Cursor, Edits, Masses, Vector, VertexId};
//!
//! let (mut mesh, positions) = shapes::grid(4, 4);
//! let rest = |a: VertexId, b: VertexId| (positions.at(b) - positions.at(a)).norm();
//! let mut edits = Edits::new();
//!
//! // Particles: where they are, and how heavy. Masses are shared out by a split, not copied, so
//! // they follow by a rule of their own.
//! let mut x: Vec<[f64; 3]> = positions.as_slice().iter().map(|&p| p.into()).collect();
//! let mut seen = Cursor::START;
//! let mut masses = Masses::area(&mesh, &positions, 1.0)?;
//!
//! x[12][2] = 1.0; // Something pulls at the middle.
//! let length = |x: &[[f64; 3]], [a, b]: [VertexId; 2]| {
//!     (Vector::from(x[b.index()]) - Vector::from(x[a.index()])).norm()
//! };
//! let overstretched: Vec<_> = mesh
//!     .edges()
//!     .filter(|&h| {
//!         let ends = [mesh.origin(h), mesh.target(h)];
//!         length(&x, ends) > 1.5 * rest(ends[0], ends[1])
//!     })
//!     .collect();
//! for edge in overstretched {
//!     tear::edge(&mut mesh, edge, &x[..], |v| Some(masses.at(v)), &mut edits);
//!     edits.replay_vertices(&mut seen, &mut x, Blend::blend);
//!     edits.replay(&mut masses);
//! }
//! assert!(x.len() > 25 && x.len() == mesh.vertex_count());
//! assert!(masses.ledger().is_balanced());
//! # Ok::<(), tearmesh::MassError>(())
//! ```

use crate::classify;
use crate::edit::{Edits, Split};
use crate::geometry::{Plane, Side};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;
use crate::split;

/// Tears an overstretched edge, given as either of its half-edges. One end of the edge is split by
/// the plane through it whose normal points toward the other end.
///
/// `mass` returns the mass of a vertex, or `None` for a vertex that must not be split, such as a
/// pinned one. The heavier end that can be split is split. Faces whose centres are behind the
/// plane, away from the other end, go to the new vertex. Returns `None` if neither end can be
/// split: there must be a face on each side of the plane.
///
/// The cost is a walk around both ends. Nothing is allocated if the mesh and the log have free capacity.
///
/// # Panics
///
/// If `edge` is not in this mesh (I2), or `place` does not store the position of a vertex near it.
pub fn edge<'e>(
    mesh: &mut Mesh,
    edge: HalfEdgeId,
    place: &(impl Place + ?Sized),
    mass: impl Fn(VertexId) -> Option<f64>,
    edits: &'e mut Edits,
) -> Option<Split<'e>> {
    let (vertex, plane) = candidate(mesh, edge, place, mass)?;
    split::by_plane(mesh, vertex, &plane, place, edits)
}

/// Returns the vertex that [`edge`] would split and the plane by which it would split it. Returns
/// `None` if it would split neither end. Changes nothing.
///
/// # Panics
///
/// For the same reasons as [`edge`].
#[must_use]
pub fn candidate(
    mesh: &Mesh,
    edge: HalfEdgeId,
    place: &(impl Place + ?Sized),
    mass: impl Fn(VertexId) -> Option<f64>,
) -> Option<(VertexId, Plane)> {
    let [a, b] = [mesh.origin(edge), mesh.target(edge)];
    let heavier_first = match (mass(a), mass(b)) {
        (Some(of_a), Some(of_b)) if of_b > of_a || (of_b == of_a && b < a) => [(b, a), (a, b)],
        _ => [(a, b), (b, a)],
    };
    heavier_first.into_iter().find_map(|(v, other)| {
        mass(v)?;
        let at = place.at(v);
        let plane = Plane::new(at, place.at(other) - at).ok()?;
        has_both_sides(mesh, v, &plane, place).then_some((v, plane))
    })
}

/// Whether a plane leaves faces of a vertex on each side.
fn has_both_sides(mesh: &Mesh, v: VertexId, plane: &Plane, place: &(impl Place + ?Sized)) -> bool {
    let mut found = [false; 2];
    for f in mesh.faces_of(v) {
        found[usize::from(classify::face(mesh, f, plane, place) == Side::Back)] = true;
        if found == [true; 2] {
            return true;
        }
    }
    false
}
