//! The method `exact`: insert vertices where the plane crosses edges, and unshare by fan.
//!
//! 1. **Signs**, once a vertex. A sign that rounding cannot vouch for is zero: *on* the plane.
//! 2. **Snap**, as a fraction of the edge: where the slit crosses an edge nearer to an end than
//!    that, the end counts as on the plane, for all its edges. It is not moved, so the seam
//!    deviates by as much, unless that is asked for (`exact/slip.rs`). What is left are crossings
//!    well inside their edges, and so no child has an altitude below r (1 − r) of its parent's.
//! 3. **Trace** (`exact/trace.rs`, found by `exact/tracer.rs`): in each face the slit runs from
//!    node to node (a vertex on the plane, or a crossing) as far as the strip between the side
//!    planes goes. Where that ends inside the face there is a *tip*.
//! 4. **Insert** all crossings and tips at once, each computed once from the same end, so both sides
//!    of the seam have the same bits, and a flat sheet stays flat. An opening needs an end
//!    that differs: a slit of one edge between vertices that both stay joined gets one in the
//!    middle.
//! 5. **Unshare by fan** along the slit (`unshare.rs`). Tips, ends on the boundary, joints and
//!    crossings need no further rule.
//!
//! An edge on the plane is slit only where its faces lie on different sides: touching is not
//! cutting. Faces that lie on the plane as a whole get the side of what is round them
//! (`exact/label.rs`).
//!
//! On an edge that is torn already each side is crossed on its own. Where both sides are at one
//! place that is one crossing; where they moved apart, each crossing is inserted on
//! both sides, and the passive twin is not on the plane.

mod label;
mod slip;
mod trace;
mod tracer;

use super::offsets::Offsets;
use super::outcome::{Ends, Outcome};
use super::strip::Strip;
use super::unshare;
use crate::edit::{Edit, Edits};
use crate::geometry::{Point, Side, between};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::subdivide::{ChordEnd, Plan, PointId, Refusal};
use trace::{Crossing, Piece, Place, Site, Trace};

/// What the method is told beyond the strip.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Settings {
    /// How near an end of its edge a crossing is taken for that end: 0 … 0.49 of the edge.
    pub(super) snap: f64,
    /// Whether what was taken for a crossing slides onto the plane.
    pub(super) snap_move: bool,
    /// Where this cut goes on from another: vertices on the plane and on the first side plane.
    pub(super) joints: Vec<VertexId>,
}

/// Cuts. `label` asks for the side of every face, for the report.
pub(super) fn cut(
    strip: &Strip,
    settings: &Settings,
    mesh: &mut Mesh,
    positions: &mut Positions,
    offsets: &Offsets,
    label: bool,
    edits: &mut Edits,
) -> Outcome {
    let Settings { snap, joints, .. } = settings;
    let mut trace = tracer::trace(strip, *snap, joints, mesh, positions, offsets);
    if settings.snap_move {
        slip::onto_plane(&trace.snapped, mesh, positions, edits);
    }
    let slit = loop {
        match Slit::insert(&trace, mesh, edits) {
            Ok(slit) => break slit,
            Err(Refusal::Crowded { face }) => trace.leave_out(mesh, face),
            Err(refusal) => panic!("a trace makes a plan that can be carried out: {refusal}"),
        }
    };
    edits.replay(positions);
    let labels = if label {
        labels(strip, mesh, positions, offsets, &trace, &slit)
    } else {
        Vec::new()
    };
    let before = edits.next_number();
    let mut is_cut = vec![false; mesh.half_edge_count()];
    for &h in &slit.half_edges {
        is_cut[h.index()] = true;
    }
    unshare::by_fan(mesh, &slit.nodes, |h| is_cut[h.index()], edits);
    Outcome {
        labels,
        refused: 0,
        ends: slit.ends(edits, before),
    }
}

/// The side of every face, once all vertices are inserted. A face that still lies on both sides
/// has none: it is round a tip, or outside the strip.
fn labels(
    strip: &Strip,
    mesh: &Mesh,
    positions: &Positions,
    offsets: &Offsets,
    trace: &Trace,
    slit: &Slit,
) -> Vec<Option<Side>> {
    // Only the passive twin of a crossing is new and not on the plane.
    let offset = |v: VertexId| match v.index() < offsets.len() {
        true => offsets.of(v),
        false => strip.plane.offset(positions.at(v)),
    };
    // Asked for at every corner, so looked up and not searched for.
    let mut signs: Vec<f64> = mesh.vertices().map(offset).collect();
    let snapped = trace.snapped.iter().map(|one| one.vertex);
    for v in snapped.chain(slit.nodes.iter().copied()) {
        signs[v.index()] = 0.0;
    }
    let sign = |v: VertexId| signs[v.index()];
    let goes_on = |f: FaceId| {
        let corners = mesh.corners(f);
        let on_both =
            corners.iter().any(|&v| sign(v) < 0.0) && corners.iter().any(|&v| sign(v) > 0.0);
        let is_tip = |v: &VertexId| slit.tips.iter().any(|of_side| of_side.contains(v));
        on_both
            && (corners.iter().any(is_tip) || !meets_strip(strip, corners.map(|v| positions.at(v))))
    };
    let sides = label::all(mesh, sign, offset);
    let sides = mesh.faces().zip(sides);
    sides
        .map(|(f, side)| (!goes_on(f)).then_some(side))
        .collect()
}

/// Whether the plane crosses a triangle between the side planes.
fn meets_strip(strip: &Strip, corners: [Point; 3]) -> bool {
    let crossing = |i: usize| {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        let (from, to) = (strip.plane.offset(p), strip.plane.offset(q));
        ((from < 0.0) != (to < 0.0)).then(|| between(p, q, from / (from - to)))
    };
    let mut ends = (0..3).filter_map(crossing);
    match (ends.next(), ends.next()) {
        (Some(p), Some(q)) => strip.clip(p, q).is_some(),
        _ => false,
    }
}

/// The edges of the mesh that are to be torn, once they are there.
struct Slit {
    /// Both half-edges of each.
    half_edges: Vec<HalfEdgeId>,
    /// The vertices at their ends, ascending.
    nodes: Vec<VertexId>,
    /// The vertices at which each side plane ends the slit.
    tips: [Vec<VertexId>; 2],
}

/// A crossing that is to be inserted: the point of the plan, and the vertex it will have.
struct Planned {
    half_edge: HalfEdgeId,
    point: PointId,
    vertex: VertexId,
}

impl Slit {
    /// Inserts what the trace needs, and finds the slit in the mesh that results.
    fn insert(trace: &Trace, mesh: &mut Mesh, edits: &mut Edits) -> Result<Slit, Refusal> {
        let mut planner = Planner::new(mesh);
        planner.crossings(trace, mesh);
        let mut edges: Vec<[VertexId; 2]> = Vec::new();
        let mut tips: [Vec<VertexId>; 2] = Default::default();
        for piece in &trace.pieces {
            let Chain { from, middle, to } = planner.piece(trace, mesh, piece);
            match middle {
                Some(middle) => edges.extend([[from, middle], [middle, to]]),
                None => edges.push([from, to]),
            }
            for (end, v) in piece.tips.into_iter().zip([from, to]) {
                if let Some(side) = end {
                    tips[side].push(v);
                }
            }
        }
        for &(side, site) in &trace.lone_tips {
            tips[side].extend(planner.vertex(site));
        }
        if !planner.plan.is_empty() {
            planner.plan.apply(mesh, edits)?;
        }
        for of_side in &mut tips {
            of_side.sort_unstable();
            of_side.dedup();
        }
        let mut nodes: Vec<VertexId> = edges.as_flattened().to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        let half_edges = edges.iter().flat_map(|&ends| pair_between(mesh, ends));
        Ok(Slit {
            half_edges: half_edges.collect(),
            nodes,
            tips,
        })
    }

    /// The tips, those included that a tip on the boundary was split into by the edits from
    /// `first` on.
    fn ends(&self, edits: &Edits, first: u64) -> Ends {
        let mut ends = self.tips.clone();
        for edit in edits.since(first) {
            let Edit::Split(split) = edit else { continue };
            for of_side in &mut ends {
                if of_side.contains(&split.old) {
                    of_side.push(split.new);
                }
            }
        }
        Ends(ends)
    }
}

/// The half-edges of the edge between two vertices.
fn pair_between(mesh: &Mesh, [from, to]: [VertexId; 2]) -> [HalfEdgeId; 2] {
    // From both ends at once, since one may be a hub.
    let mut corners = mesh.corners_of(from).zip(mesh.corners_of(to));
    let found = corners.find_map(|(h, g)| {
        if mesh.target(h) == to {
            return mesh.pair(h).map(|pair| [h, pair]);
        }
        let pair = mesh.pair(g).filter(|_| mesh.target(g) == from);
        pair.map(|pair| [pair, g])
    });
    found.expect("an edge of the slit has a face on each side")
}

/// Collects the points to insert, and foresees their vertices.
struct Planner {
    plan: Plan,
    /// By half-edge.
    crossings: Vec<Planned>,
    next: usize,
}

impl Planner {
    fn new(mesh: &Mesh) -> Planner {
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
    fn crossings(&mut self, trace: &Trace, mesh: &Mesh) {
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
                let point = if forward {
                    self.plan.on_edge(h, t)
                } else {
                    self.plan.on_edge_backward(h, t)
                };
                Planned {
                    half_edge: h,
                    point,
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
    fn vertex(&self, site: Site) -> Option<VertexId> {
        match site {
            Site::Vertex(v) => Some(v),
            Site::Edge(h) => self.planned(h).map(|planned| planned.vertex),
        }
    }

    /// Plans the tips and the middle of a piece, and returns the vertices along it.
    fn piece(&mut self, trace: &Trace, mesh: &Mesh, piece: &Piece) -> Chain {
        // The middle comes first: the first point in a face is joined to all of its outline.
        let middle = piece
            .middle
            .then(|| self.point(trace, mesh, piece, (piece.from + piece.to) / 2.0));
        let from = self.end(trace, mesh, piece, 0);
        let to = self.end(trace, mesh, piece, 1);
        if let (Place::Face(f), None, [true, true]) = (piece.place, middle, piece.ends_at_nodes()) {
            let end = |site| match site {
                Site::Vertex(v) => ChordEnd::Corner(trace::corner_of(mesh, f, v)),
                Site::Edge(h) => ChordEnd::Point(self.planned(h).expect(PLANNED).point),
            };
            let chord = piece.nodes.map(end);
            self.plan.chord(f, chord);
        }
        Chain { from, middle, to }
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
            Place::Face(f) => {
                self.plan
                    .in_face(f, trace.weights(mesh, f, piece.nodes, at));
            }
            Place::Edge { h, forward: true } => {
                self.plan.on_edge(h, at);
            }
            Place::Edge { h, forward: false } => {
                self.plan.on_edge_backward(h, at);
            }
        }
        self.new_vertices(1)
    }
}

/// The vertices along a piece of the slit: two, or three.
struct Chain {
    from: VertexId,
    middle: Option<VertexId>,
    to: VertexId,
}

const COUNTED: &str = "I1: there are fewer vertices than half-edges";
const PLANNED: &str = "every crossing at the end of a piece was planned";
