//! What to insert for a trace, and the vertices that it will have.

use super::trace::{Crossing, Piece, Place, Site, Trace, corner_of};
use crate::id::{HalfEdgeId, VertexId};
use crate::insert::{ChordEnd, Plan, PointId};
use crate::mesh::Mesh;

/// Collects the points to insert, and foresees their vertices.
pub(super) struct Planner {
    pub(super) plan: Plan,
    /// By half-edge.
    crossings: Vec<Planned>,
    next: usize,
}

/// A crossing that is to be inserted: the point of the plan, and the vertex it will have.
struct Planned {
    half_edge: HalfEdgeId,
    point: PointId,
    vertex: VertexId,
}

impl Planner {
    pub(super) fn new(mesh: &Mesh) -> Planner {
        Planner {
            plan: Plan::new(),
            crossings: Vec::new(),
            next: mesh.vertex_count(),
        }
    }

    fn new_vertices(&mut self, count: usize) -> VertexId {
        let first = VertexId::new(self.next).expect(COUNTED);
        self.next += count;
        first
    }

    /// Plans the points where the slit crosses edges.
    pub(super) fn crossings(&mut self, trace: &Trace, mesh: &Mesh) {
        for &Crossing {
            half_edge: h,
            t,
            forward,
            ..
        } in trace.crossings.iter().filter(|crossing| crossing.used)
        {
            let ghost = mesh.ghost_pair(h);
            let twin = ghost.and_then(|g| self.planned(g).filter(|_| trace.is_one_place(h, g)));
            let planned = if let Some(twin) = twin {
                Planned {
                    half_edge: h,
                    point: twin.point,
                    vertex: VertexId::new(twin.vertex.index() + 1).expect(COUNTED),
                }
            } else {
                Planned {
                    half_edge: h,
                    point: self.plan.edge(h, t, forward),
                    vertex: self.new_vertices(if ghost.is_some() { 2 } else { 1 }),
                }
            };
            self.crossings.push(planned);
        }
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
    pub(super) fn piece(&mut self, trace: &Trace, mesh: &Mesh, piece: &Piece) -> Vec<VertexId> {
        // The middle comes first: the first point in a face is joined to all of its outline.
        let middle = piece
            .middle
            .then(|| self.point(trace, mesh, piece, (piece.from + piece.to) / 2.0));
        let from = self.end(trace, mesh, piece, 0);
        let to = self.end(trace, mesh, piece, 1);
        if let (Place::Face(f), None, [true, true]) = (piece.place, middle, piece.ends_at_nodes()) {
            let end = |site| match site {
                Site::Vertex(v) => ChordEnd::Corner(corner_of(mesh, f, v)),
                Site::Edge(h) => ChordEnd::Point(self.planned(h).expect(PLANNED).point),
            };
            let chord = piece.nodes.map(end);
            self.plan.chord(f, chord);
        }
        [Some(from), middle, Some(to)]
            .into_iter()
            .flatten()
            .collect()
    }

    fn end(&mut self, trace: &Trace, mesh: &Mesh, piece: &Piece, end: usize) -> VertexId {
        if piece.ends_at_nodes()[end] {
            self.vertex(piece.nodes[end]).expect(PLANNED)
        } else {
            self.point(trace, mesh, piece, [piece.from, piece.to][end])
        }
    }

    /// Plans a point at a parameter of a piece, and returns the vertex that it will have.
    fn point(&mut self, trace: &Trace, mesh: &Mesh, piece: &Piece, at: f64) -> VertexId {
        match piece.place {
            Place::Face(f) => self.plan.in_face(f, trace.weights(mesh, f, piece, at)),
            Place::Edge { h, forward } => self.plan.edge(h, at, forward),
        };
        self.new_vertices(1)
    }
}

const COUNTED: &str = "I1: there are fewer vertices than half-edges";
const PLANNED: &str = "every crossing at the end of a piece was planned";
