//! Where the slit runs: from node to node, face by face, before anything is inserted.
//!
//! A *node* is a vertex on the plane, or a place where the plane crosses an edge. In a face the
//! slit is a straight piece between two nodes, clipped by the side planes. A snapped vertex stands
//! for the crossing that snapped it, not for its own position: otherwise a slit would break in
//! the middle wherever a vertex beside it lies outside the strip.
//!
//! Everything here is worked out from the mesh as it was before the cut.

use crate::edit::Mix;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;

/// Where a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Site {
    /// At a vertex on the plane.
    Vertex(VertexId),
    /// On an edge that the plane crosses: the smaller half-edge of a pair, and on a torn edge
    /// that of the side in question.
    Edge(HalfEdgeId),
}

/// Where a piece of the slit runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Across a face.
    Face(FaceId),
    /// Along an edge on the plane; the first node is the origin of `h` if `forward`.
    Edge { h: HalfEdgeId, forward: bool },
}

/// A straight piece of the slit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) place: Place,
    pub(super) nodes: [Site; 2],
    /// Where the piece starts and ends, from 0 at the first node to 1 at the second.
    pub(super) from: f64,
    pub(super) to: f64,
    /// For each end the side plane that ends the slit there, if one does.
    pub(super) tips: [Option<usize>; 2],
    /// Whether the piece needs a vertex in its middle to open.
    pub(super) middle: bool,
    /// The least weight that a corner of its face has at a point of the piece: what is nearer to the
    /// opposite edge is inserted a little off the plane.
    pub(super) inset: f64,
}

impl Piece {
    /// For each end, whether it is a node and not a point between them.
    pub(super) fn ends_at_nodes(&self) -> [bool; 2] {
        [self.from == 0.0, self.to == 1.0]
    }

    /// Whether a side plane ends the slit at one of its ends.
    pub(super) fn has_tip(&self) -> bool {
        self.tips != [None; 2]
    }

    /// Whether it runs from node to node, and needs no point between them.
    pub(super) fn is_crossing(&self) -> bool {
        self.ends_at_nodes() == [true; 2] && !self.middle
    }

    /// The nodes at which it ends, as far as it ends at nodes.
    pub(super) fn end_nodes(&self) -> [Option<Site>; 2] {
        let at_nodes = self.ends_at_nodes();
        [0, 1].map(|end| at_nodes[end].then_some(self.nodes[end]))
    }
}

/// Where the plane crosses an edge: at the part `t` from the origin of the half-edge, or if not
/// `forward`, from its target. It is counted from the end with the smaller position, so that both
/// faces of the edge, and both sides of a torn edge, have the same bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) half_edge: HalfEdgeId,
    pub(super) t: f64,
    pub(super) forward: bool,
    /// Whether a piece ends there.
    pub(super) used: bool,
}

/// A vertex that counts as on the plane because a crossing is near it.
#[derive(Clone, Copy)]
pub(super) struct Snapped {
    pub(super) vertex: VertexId,
    /// How near the crossing is, as a part of its edge.
    pub(super) t: f64,
    /// The other end of that edge.
    pub(super) toward: VertexId,
    /// The depths of the crossing.
    pub(super) depths: [f64; 2],
}

/// The slit on a mesh.
pub(in crate::scissor) struct Trace {
    pub(super) pieces: Vec<Piece>,
    /// The crossings that are nodes of pieces, by half-edge.
    pub(super) crossings: Vec<Crossing>,
    /// Nodes at which a side plane ends the slit, though no piece ends there in the face beyond.
    pub(super) lone_tips: Vec<(usize, Site)>,
    /// The vertices that count as on the plane because a crossing is near, ascending.
    pub(super) snapped: Vec<Snapped>,
    /// Crossings nearer than this part of their edge are one.
    pub(super) near: f64,
}

impl Trace {
    pub(super) fn crossing(&self, h: HalfEdgeId) -> Option<&Crossing> {
        let at = self.crossings.binary_search_by_key(&h, |one| one.half_edge);
        at.ok().map(|at| &self.crossings[at])
    }

    /// Whether the crossings on both sides of a torn edge are at one place of it.
    pub(super) fn is_one_place(&self, h: HalfEdgeId, g: HalfEdgeId) -> bool {
        let (Some(one), Some(other)) = (self.crossing(h), self.crossing(g)) else {
            return false;
        };
        // Half-edges of one edge run in opposite directions.
        let along = if one.forward { one.t } else { 1.0 - one.t };
        let across = if other.forward {
            1.0 - other.t
        } else {
            other.t
        };
        (along - across).abs() <= self.near
    }

    /// The weights of the corners of a face at a parameter of a piece in it.
    pub(super) fn weights(&self, mesh: &Mesh, f: FaceId, piece: &Piece, at: f64) -> [f64; 3] {
        let [one, other] = piece.nodes.map(|site| {
            let place = match site {
                Site::Vertex(v) => Mix::Copy(corner_of(mesh, f, v)),
                Site::Edge(h) => self.crossing_in(mesh, f, h),
            };
            place.weights()
        });
        std::array::from_fn(|i| (one[i] + at * (other[i] - one[i])).max(piece.inset))
    }

    /// A crossing between two corners of this face.
    fn crossing_in(&self, mesh: &Mesh, f: FaceId, h: HalfEdgeId) -> Mix<HalfEdgeId> {
        let &Crossing { t, forward, .. } = self.crossing(h).expect("the nodes of pieces are known");
        let ends = if h.face() == f {
            h.ends(forward)
        } else {
            let pair = mesh.pair(h).expect("a crossing has one half-edge a side");
            pair.ends(!forward)
        };
        Mix::Between { ends, t }
    }

    /// Puts a piece in the place of the one that is there, or gives that up: the slit then ends at
    /// the node from which it came.
    pub(super) fn replace(&mut self, place: Place, better: Option<Piece>) {
        let at = self.pieces.iter().position(|piece| piece.place == place);
        let at = at.expect("a piece that is replaced is in the trace");
        if let Some(better) = better {
            self.pieces[at] = better;
            return;
        }
        let gone = self.pieces.remove(at);
        let [from, to] = gone.end_nodes();
        let [begins, ends] = gone.tips;
        let lone = [(ends, from), (begins, to)];
        let lone = lone
            .into_iter()
            .filter_map(|(side, site)| Some((side?, site?)));
        self.lone_tips.extend(lone);
    }

    /// The nodes at which pieces end, ascending, each as often as pieces end there.
    pub(super) fn nodes(&self) -> Vec<Site> {
        let ends = self.pieces.iter().flat_map(Piece::end_nodes);
        let mut sites: Vec<Site> = ends.flatten().collect();
        sites.sort_unstable();
        sites
    }

    /// Notes which crossings are used, and which pieces need a vertex in the middle: those of one
    /// edge between vertices that both stay joined.
    pub(super) fn finish(&mut self, mesh: &Mesh) {
        let sites = self.nodes();
        for crossing in &mut self.crossings {
            crossing.used = sites.binary_search(&Site::Edge(crossing.half_edge)).is_ok();
        }
        let opens = |site: Site| {
            let first = sites.partition_point(|&other| other < site);
            sites.get(first + 1) == Some(&site) || !is_closed(mesh, site)
        };
        for piece in &mut self.pieces {
            piece.middle = !piece.end_nodes().into_iter().flatten().any(opens);
        }
    }
}

/// Whether faces go all the way round a node, so that one edge of the slit does not divide them.
pub(super) fn is_closed(mesh: &Mesh, site: Site) -> bool {
    match site {
        Site::Vertex(v) => mesh.corners_of(v).all(|h| mesh.pair(h).is_some()),
        Site::Edge(h) => mesh.pair(h).is_some(),
    }
}

/// The corner of a face at a vertex.
pub(super) fn corner_of(mesh: &Mesh, f: FaceId, v: VertexId) -> HalfEdgeId {
    let corner = f.half_edges().into_iter().find(|&h| mesh.origin(h) == v);
    corner.expect("a node of a piece is on the outline of its face")
}
