//! A vertex for each fan, so that no bow-tie is in the file.

use std::borrow::Cow;

use tearmesh::{FaceId, HalfEdgeId, Mesh, VertexId};

/// The faces of a mesh in which no vertex has several fans.
#[derive(Debug)]
pub(super) struct Separated<'m> {
    /// The vertex of each corner, three a face.
    pub(super) indices: Cow<'m, [u32]>,
    /// The vertices beyond those of the mesh, by the vertex that each is a copy of.
    pub(super) copies: Vec<VertexId>,
}

impl<'m> Separated<'m> {
    /// All fans stay together.
    pub(super) fn none(mesh: &'m Mesh) -> Separated<'m> {
        Separated {
            indices: Cow::Borrowed(mesh.indices()),
            copies: Vec::new(),
        }
    }

    /// The fans of a vertex are told apart by their first corner in the file, where faces have these ranks.
    ///
    /// Linear in the half-edges; copies nothing where no vertex has several fans.
    pub(super) fn new(mesh: &'m Mesh, rank: impl Fn(FaceId) -> u32) -> Separated<'m> {
        let place = |h: &HalfEdgeId| (rank(h.face()), h.corner());
        let mut indices = Cow::Borrowed(mesh.indices());
        let mut copies = Vec::new();
        for vertex in starts_of_tears(mesh) {
            let fans = mesh.fans(vertex);
            let first = fans.filter_map(|h| mesh.fan(h).min_by_key(place));
            let mut fans: Vec<HalfEdgeId> = first.collect();
            fans.sort_by_key(place);
            for &fan in fans.iter().skip(1) {
                let copy = mesh.vertex_count() + copies.len();
                let copy = u32::try_from(copy).expect("I1: there are fewer fans than half-edges");
                copies.push(vertex);
                for h in mesh.fan(fan) {
                    indices.to_mut()[h.index()] = copy;
                }
            }
        }
        Separated { indices, copies }
    }
}

/// The vertices at which a torn half-edge starts, ascending. No other can have several fans:
/// the first corner of an open fan has no pair, and at most one of them lies on the boundary
/// that the mesh was built with.
fn starts_of_tears(mesh: &Mesh) -> Vec<VertexId> {
    let torn = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
    let mut starts: Vec<VertexId> = torn.map(|h| mesh.origin(h)).collect();
    starts.sort();
    starts.dedup();
    starts
}
