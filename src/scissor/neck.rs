//! Necks narrower than the snap, and the pieces that hung on them.
//!
//! A vertex that counts as on the plane is an end of what is on its side:
//!
//! ```text
//!   o-----o         o-----o     The plane passes below v, nearer than the snap. What is on its left
//!    \     \       /     /      and on its right hangs together below v. As the slit runs through v
//!     \ A   \     /   B /       it would be apart from both, and A from B.
//!      \     \   /     /
//!       \      v      /
//!   - - -o- - - - - -o- - -
//! ```
//!
//! Vertices are snapped all the same, since a face as thin as that neck is what a snap keeps away.

use super::cut_context::CutContext;
use super::cut_result::{CutResult, side_of};
use super::pieces::Pinch;
use crate::geometry::{Point, Side};
use crate::id::VertexId;
use crate::mesh::Mesh;
use crate::place::Positions;

/// A piece that a cut of the method `exact` took off although the slit does not, because it hung on a
/// neck narrower than the snap.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CutNeck {
    /// The vertex between the slit and which the neck was.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub vertex: VertexId,
    /// The position of that vertex after the cut.
    pub at: Point,
    /// The distance from the vertex to the plane before the cut.
    pub width: f64,
    /// The number of faces of the piece that came off: the smaller of the two that the neck joined.
    pub faces: usize,
}

/// What hung on necks, after the cut. `copies` returns vertices and what the cut split off them.
pub(super) fn severed(
    pinches: &[Pinch],
    copies: impl Fn(&[VertexId]) -> Vec<VertexId>,
    context: &CutContext<'_>,
    (mesh, positions): (&Mesh, &Positions),
    outcome: &CutResult,
) -> Vec<CutNeck> {
    if pinches.is_empty() {
        return Vec::new();
    }
    let components = mesh.components();
    let mut faces = vec![0; components.count()];
    mesh.faces().for_each(|f| faces[components.of(f)] += 1);
    let mut severed = Vec::new();
    for pinch in pinches {
        let mut chain = pinch.chain.clone();
        chain.sort_unstable();
        chain.dedup();
        let side = Side::of(context.offsets.of(chain[0]));
        let chain = copies(&chain);
        let around = chain.iter().flat_map(|&v| mesh.faces_of(v));
        let on_side = around.filter(|&f| side_of(&outcome.touched, f) == Some(side));
        let mut pieces: Vec<usize> = on_side.map(|f| components.of(f)).collect();
        pieces.sort_by_key(|&piece| (faces[piece], piece));
        pieces.dedup();
        severed.extend(pinch.at.iter().zip(pieces).map(|(&vertex, piece)| CutNeck {
            vertex,
            at: positions.at(vertex),
            width: (context.offsets.of(vertex) / context.strip.plane.offset_of_unit()).abs(),
            faces: faces[piece],
        }));
    }
    severed
}
