//! What to insert for a trace, and the vertices that it will have.

use super::trace::{Crossing, Piece, Place, Site, Trace, corner_of};
use crate::id::{HalfEdgeId, VertexId};
use crate::insert::{ChordEnd, Plan, PointId};
use crate::mesh::Mesh;

/// Collects the points to insert, and foresees their vertices.
pub(super) struct Planner<'t> {
    trace: &'t Trace,
    mesh: &'t Mesh,
    pub(super) plan: Plan,
    /// By half-edge.
    crossings: Vec<Planned>,
    next: u32,
}

/// A crossing that is to be inserted: the point of the plan, and the vertex it will have.
struct Planned {
    half_edge: HalfEdgeId,
    point: PointId,
    vertex: VertexId,
}

impl<'t> Planner<'t> {
    /// Plans the points where the slit crosses edges.
    pub(super) fn new(trace: &'t Trace, mesh: &'t Mesh) -> Planner<'t> {
        let mut planner = Planner {
            trace,
            mesh,
            plan: Plan::new(),
            crossings: Vec::new(),
            next: mesh.next_vertex().to_u32(),
        };
        for crossing in trace.crossings.iter().filter(|crossing| crossing.used) {
            let planned = planner.crossing(crossing);
            planner.crossings.push(planned);
        }
        planner
    }

    fn crossing(&mut self, crossing: &Crossing) -> Planned {
        let half_edge = crossing.half_edge;
        let ghost = self.mesh.ghost_pair(half_edge);
        let twin = ghost.and_then(|g| self.planned(g));
        match twin.filter(|twin| self.trace.is_one_place(half_edge, twin.half_edge)) {
            Some(twin) => Planned {
                half_edge,
                point: twin.point,
                vertex: VertexId::from_u32(twin.vertex.to_u32() + 1),
            },
            None => Planned {
                half_edge,
                point: self.plan.edge(half_edge, crossing.t, crossing.forward),
                vertex: self.new_vertices(if ghost.is_some() { 2 } else { 1 }),
            },
        }
    }

    fn new_vertices(&mut self, count: u32) -> VertexId {
        self.next += count;
        VertexId::from_u32(self.next - count)
    }

    fn planned(&self, h: HalfEdgeId) -> Option<&Planned> {
        let at = self.crossings.binary_search_by_key(&h, |one| one.half_edge);
        at.ok().map(|at| &self.crossings[at])
    }

    /// The vertex that a node has or will have.
    pub(super) fn vertex(&self, site: Site) -> Option<VertexId> {
        match site {
            Site::Vertex(v) => Some(v),
            Site::Edge(h) => self.planned(h).map(|planned| planned.vertex),
        }
    }

    /// Plans the tips and the middle of a piece, and returns the two or three vertices along it.
    pub(super) fn piece(&mut self, piece: &Piece) -> Vec<VertexId> {
        // The middle comes first: the first point in a face is joined to all of its outline.
        let middle = (piece.from + piece.to) / 2.0;
        let middle = piece.middle.then(|| self.point(piece, middle));
        let ends = [0, 1].map(|end| self.end(piece, end));
        if let (Place::Face(f), None, [true, true]) = (piece.place, middle, piece.ends_at_nodes()) {
            let end = |site| match site {
                Site::Vertex(v) => ChordEnd::Corner(corner_of(self.mesh, f, v)),
                Site::Edge(h) => ChordEnd::Point(self.planned(h).expect(PLANNED).point),
            };
            let chord = piece.nodes.map(end);
            self.plan.chord(f, chord);
        }
        let mut chain = ends.to_vec();
        if let Some(middle) = middle {
            chain.insert(1, middle);
        }
        chain
    }

    fn end(&mut self, piece: &Piece, end: usize) -> VertexId {
        if piece.ends_at_nodes()[end] {
            self.vertex(piece.nodes[end]).expect(PLANNED)
        } else {
            self.point(piece, [piece.from, piece.to][end])
        }
    }

    /// Plans a point at a parameter of a piece, and returns the vertex that it will have.
    fn point(&mut self, piece: &Piece, at: f64) -> VertexId {
        match piece.place {
            Place::Face(f) => {
                let weights = self.trace.weights(self.mesh, f, piece, at);
                self.plan.in_face(f, weights)
            }
            Place::Edge { h, forward } => self.plan.edge(h, at, forward),
        };
        self.new_vertices(1)
    }
}

const PLANNED: &str = "every crossing at the end of a piece was planned";
