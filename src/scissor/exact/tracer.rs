//! Finding where the slit runs: signs, snapping, and the pieces between nodes.

use super::label::Patches;
use super::trace::{Crossing, Piece, Place, Site, Snapped, Trace};
use crate::geometry::{Point, between};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::cut_context::CutContext;

/// Tips nearer to a node than this part of the way between nodes are the node, also where
/// snapping is off: the faces round them could not be told from nothing.
pub(super) const TIP_MIN: f64 = 1.0 / (1u64 << 40) as f64;

/// Traces the slit. `snap` is how near an end of its edge a crossing is taken for that end; `met` are
/// nodes beyond the side planes that are snapped like those between them, ascending.
pub(in crate::scissor) fn trace(
    context: &CutContext<'_>,
    snap: f64,
    met: &[Site],
    mesh: &Mesh,
    positions: &Positions,
) -> Trace {
    let mut tracer = Tracer {
        context,
        mesh,
        positions,
        snap,
        near: snap.max(TIP_MIN),
        round_joints: Default::default(),
        snapped: Vec::new(),
        passed: Vec::new(),
    };
    let mut touched = context.among.to_vec();
    touched.extend(
        context
            .joints
            .iter()
            .flatten()
            .flat_map(|&v| mesh.faces_of(v)),
    );
    touched.sort_unstable();
    touched.dedup();
    tracer.look_round_joints();
    tracer.snap(&touched, met);
    tracer.look_round_joints();
    tracer.look_beside_joints();
    tracer.trace(&touched)
}

/// Whether a place comes before another. Edges and pieces are measured from the end that does, so that two
/// sides of a seam, and those of double-sided cloth, come to the same numbers.
fn is_before(p: Point, q: Point) -> bool {
    let first = (0..3).find(|&axis| p[axis] != q[axis]);
    first.is_some_and(|axis| p[axis] < q[axis])
}

/// A node and its depths inside the two side planes.
#[derive(Clone, Copy, Debug)]
struct Node {
    site: Site,
    at: Point,
    depths: [f64; 2],
}

/// A trace in the making.
struct Tracer<'t> {
    context: &'t CutContext<'t>,
    mesh: &'t Mesh,
    positions: &'t Positions,
    snap: f64,
    near: f64,
    /// For each side plane, nodes in the faces of its joints, and the depth of the joint inside it.
    /// By site.
    round_joints: [Vec<(Site, f64)>; 2],
    /// By vertex.
    snapped: Vec<Snapped>,
    /// Edges along which the slit comes to a joint: see [`Tracer::look_beside_joints`].
    passed: Vec<HalfEdgeId>,
}

impl Tracer<'_> {
    /// Zero on the plane, else the sign of the side.
    fn sign(&self, v: VertexId) -> f64 {
        let is_on = self.snap_of(v).is_some() || self.is_joint(v);
        if is_on {
            0.0
        } else {
            self.context.offsets.of(v)
        }
    }

    fn is_joint(&self, v: VertexId) -> bool {
        self.context
            .joints
            .iter()
            .any(|of_side| of_side.contains(&v))
    }

    fn snap_of(&self, v: VertexId) -> Option<&Snapped> {
        let at = self.snapped.binary_search_by_key(&v, |one| one.vertex);
        at.ok().map(|at| &self.snapped[at])
    }

    /// How far a point is inside each side plane.
    fn depths(&self, p: Point) -> [f64; 2] {
        self.context.strip.depths(p, self.context.offsets.bound())
    }

    /// The side plane passes through one joint, and by the others, on other sheets, as far
    /// as they were snapped. Each cut begins at its joint: what is nearest to one is measured
    /// from there.
    fn look_round_joints(&mut self) {
        self.round_joints = Default::default();
        let round = [0, 1].map(|side| {
            let mut round = Vec::new();
            for &v in &self.context.joints[side] {
                let sides = self.context.strip.sides.expect("what has a joint has rays");
                let depth = sides[side].offset(self.positions.at(v));
                let faces = self.mesh.faces_of(v).filter_map(|f| self.nodes(f));
                round.extend(faces.flatten().map(|node| (node.site, depth)));
            }
            round.sort_by(|a, b| a.partial_cmp(b).expect("depths are finite"));
            round.dedup_by_key(|&mut (site, _)| site);
            round
        });
        self.round_joints = round;
    }

    /// A neighbour of a joint may have been snapped, by a crossing on one of its other edges, and be
    /// the only one on its side: then the plane touches the faces of the joint, and the slit passes
    /// it by. It goes along the edge between them, and that neighbour counts as where the joint is.
    fn look_beside_joints(&mut self) {
        for side in 0..2 {
            for &joint in &self.context.joints[side] {
                let is_node = |f: FaceId| {
                    let mut nodes = self.nodes(f).into_iter().flatten();
                    nodes.any(|node| node.site == Site::Vertex(joint))
                };
                if self.mesh.faces_of(joint).any(is_node) {
                    continue;
                }
                let is_snapped = |h: &HalfEdgeId| {
                    self.mesh.pair(*h).is_some() && self.snap_of(self.mesh.target(*h)).is_some()
                };
                let Some(h) = self.mesh.corners_of(joint).find(is_snapped) else {
                    continue;
                };
                let beside = self.mesh.target(h);
                let depth = self.depths_of(beside)[side];
                let round = &mut self.round_joints[side];
                let at = round.partition_point(|&(site, _)| site < Site::Vertex(beside));
                round.insert(at, (Site::Vertex(beside), depth));
                self.passed.push(h);
            }
        }
    }

    fn joint_depths(&self, site: Site) -> [Option<f64>; 2] {
        let key = |&(site, _): &(Site, f64)| site;
        self.round_joints.each_ref().map(|round| {
            let at = round.binary_search_by_key(&site, key);
            at.ok().map(|at| round[at].1)
        })
    }

    /// The depths of a node that has these by its place.
    fn node(&self, site: Site, at: Point, mut depths: [f64; 2]) -> Node {
        for (depth, of_joint) in depths.iter_mut().zip(self.joint_depths(site)) {
            *depth -= of_joint.unwrap_or(0.0);
        }
        Node { site, at, depths }
    }

    /// Whether places along an edge are counted from its origin.
    fn is_forward(&self, h: HalfEdgeId) -> bool {
        let [p, q] = h.ends(true).map(|h| self.positions.at(self.mesh.origin(h)));
        is_before(p, q)
    }

    fn crossing(&self, h: HalfEdgeId) -> Crossing {
        let half_edge = self.mesh.pair(h).map_or(h, |pair| pair.min(h));
        let forward = self.is_forward(half_edge);
        let ends = half_edge.ends(forward).map(|h| self.mesh.origin(h));
        let [near, far] = ends.map(|v| self.context.offsets.of(v).abs());
        Crossing {
            half_edge,
            t: near / (near + far),
            forward,
            used: false,
        }
    }

    /// The vertices between which a crossing is, in the order in which it is counted.
    fn ends(&self, crossing: &Crossing) -> [VertexId; 2] {
        let ends = crossing.half_edge.ends(crossing.forward);
        ends.map(|h| self.mesh.origin(h))
    }

    fn crossing_node(&self, h: HalfEdgeId) -> Node {
        let crossing = self.crossing(h);
        let [p, q] = self.ends(&crossing).map(|v| self.positions.at(v));
        let at = between(p, q, crossing.t);
        self.node(Site::Edge(crossing.half_edge), at, self.depths(at))
    }

    fn vertex_node(&self, v: VertexId) -> Node {
        self.node(Site::Vertex(v), self.positions.at(v), self.depths_of(v))
    }

    /// The depths of a vertex, or of the crossing for which it stands.
    fn depths_of(&self, v: VertexId) -> [f64; 2] {
        match self.snap_of(v) {
            Some(snapped) => snapped.depths,
            None => self.depths(self.positions.at(v)),
        }
    }

    /// The nodes of a face with vertices on both sides of the plane, in the order of their places.
    fn nodes(&self, f: FaceId) -> Option<[Node; 2]> {
        let mut nodes = f.half_edges().into_iter().filter_map(|h| {
            let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
            let (da, db) = (self.sign(a), self.sign(b));
            if da == 0.0 {
                let across = self.sign(self.mesh.target(h.next()));
                let divides = (db < 0.0 && across > 0.0) || (db > 0.0 && across < 0.0);
                divides.then(|| self.vertex_node(a))
            } else {
                let crosses = (da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0);
                crosses.then(|| self.crossing_node(h))
            }
        });
        let (one, other) = (nodes.next()?, nodes.next()?);
        Some(match is_before(other.at, one.at) {
            true => [other, one],
            false => [one, other],
        })
    }

    /// The piece from one node to the other, as far as it is between the side planes.
    ///
    /// An end so near to a node that it is the node counts as one. Where nothing is left, the node
    /// at which a side plane ends the slit is returned with that plane.
    fn piece(&self, place: Place, [one, other]: [Node; 2]) -> Result<Piece, Option<(usize, Site)>> {
        let mut piece = Piece {
            place,
            nodes: [one.site, other.site],
            from: 0.0,
            to: 1.0,
            tips: [None; 2],
            middle: false,
            inset: 0.0,
        };
        for side in 0..2 {
            let (start, end) = (one.depths[side], other.depths[side]);
            if start < 0.0 && end < 0.0 {
                return Err(None);
            }
            if start < 0.0 && start / (start - end) > piece.from {
                piece.from = start / (start - end);
                piece.tips[0] = Some(side);
            } else if end < 0.0 && start / (start - end) < piece.to {
                piece.to = start / (start - end);
                piece.tips[1] = Some(side);
            }
        }
        if piece.to - piece.from <= self.near {
            // Where no side plane ends the slit, the node is inside both.
            return Err(match piece.tips {
                [None, Some(side)] => Some((side, one.site)),
                [Some(side), None] => Some((side, other.site)),
                _ => None,
            });
        }
        if piece.from <= self.near {
            piece.from = 0.0;
        }
        if 1.0 - piece.to <= self.near {
            piece.to = 1.0;
        }
        Ok(piece)
    }

    /// Puts vertices on the plane that are near a crossing that the slit meets: nearer than
    /// the snap, as a part of the edge.
    fn snap(&mut self, touched: &[FaceId], met: &[Site]) {
        if self.snap == 0.0 {
            return;
        }
        let mut snapped = Vec::new();
        for &f in touched {
            let Some(nodes) = self.nodes(f) else { continue };
            let piece = self.piece(Place::Face(f), nodes);
            let at_node = piece.map_or([false; 2], |piece| piece.ends_at_nodes());
            for (node, at_node) in nodes.into_iter().zip(at_node) {
                let inside = node.depths.into_iter().all(|depth| depth >= 0.0);
                let is_met = at_node || inside || met.contains(&node.site);
                let Site::Edge(h) = node.site else { continue };
                if self.joint_depths(node.site) != [None; 2] {
                    continue;
                }
                let crossing = self.crossing(h);
                let near = [crossing.t, 1.0 - crossing.t];
                let [a, b] = self.ends(&crossing);
                for ([vertex, toward], t) in [[a, b], [b, a]].into_iter().zip(near) {
                    if is_met && t < self.snap {
                        snapped.push(Snapped {
                            vertex,
                            t,
                            toward,
                            depths: node.depths,
                        });
                    }
                }
            }
        }
        self.snap_copies(&mut snapped);
        // The nearest crossing speaks for the vertex. Equal ones are two faces' view of one, or
        // decided by the place of the other end, so that both sides of double-sided cloth agree.
        let order = |one: &Snapped| {
            let toward = self.positions.at(one.toward);
            (one.vertex, one.t, toward.x, toward.y, toward.z)
        };
        snapped.sort_by(|a, b| order(a).partial_cmp(&order(b)).expect("numbers are finite"));
        snapped.dedup_by_key(|one| one.vertex);
        self.snapped = snapped;
    }

    /// Copies of one vertex that are at one place decide together.
    fn snap_copies(&self, snapped: &mut Vec<Snapped>) {
        let torn = |v: VertexId| {
            self.mesh.corners_of(v).any(|h| {
                self.mesh.ghost_pair(h).is_some() || self.mesh.ghost_pair(h.prev()).is_some()
            })
        };
        // The nearest first: whoever heard of it has nothing to tell, and a hub with many
        // crossings or copies is walked round once.
        let mut order: Vec<usize> = (0..snapped.len()).collect();
        order.sort_by(|&i, &j| snapped[i].t.total_cmp(&snapped[j].t));
        let mut told = vec![false; self.mesh.vertex_count()];
        for i in order {
            let one = snapped[i];
            if std::mem::replace(&mut told[one.vertex.index()], true) || !torn(one.vertex) {
                continue;
            }
            let place = self.positions.at(one.vertex);
            let copies = self.mesh.copies(one.vertex);
            for v in copies.filter(|&v| v != one.vertex && self.positions.at(v) == place) {
                told[v.index()] = true;
                snapped.push(Snapped { vertex: v, ..one });
            }
        }
    }

    fn trace(&self, touched: &[FaceId]) -> Trace {
        let mut trace = Trace {
            pieces: Vec::new(),
            crossings: Vec::new(),
            lone_tips: Vec::new(),
            snapped: self.snapped.clone(),
            near: self.near,
        };
        let mut on_plane = Vec::new();
        for &f in touched {
            if let Some(nodes) = self.nodes(f) {
                self.add(&mut trace, Place::Face(f), nodes);
            }
            for h in f.half_edges() {
                let ends = [self.mesh.origin(h), self.mesh.target(h)];
                if let Some(pair) = self.mesh.pair(h)
                    && ends.into_iter().all(|v| self.sign(v) == 0.0)
                {
                    on_plane.push(h.min(pair));
                }
            }
        }
        on_plane.sort_unstable();
        on_plane.dedup();
        self.along_edges(&mut trace, &on_plane);
        let nodes = trace.pieces.iter().flat_map(|piece| piece.nodes);
        let crossings = nodes.filter_map(|site| match site {
            Site::Edge(h) => Some(self.crossing(h)),
            Site::Vertex(_) => None,
        });
        trace.crossings = crossings.collect();
        trace.crossings.sort_by_key(|crossing| crossing.half_edge);
        trace.crossings.dedup_by_key(|crossing| crossing.half_edge);
        trace.finish(self.mesh);
        trace
    }

    /// Adds the edges on the plane whose faces lie on different sides of it.
    fn along_edges(&self, trace: &mut Trace, edges: &[HalfEdgeId]) {
        let sign = |v: VertexId| self.sign(v);
        let offset = |v: VertexId| self.context.offsets.of(v);
        let faces = edges.iter().flat_map(|&h| {
            let pair = self.mesh.pair(h);
            std::iter::once(h).chain(pair).map(HalfEdgeId::face)
        });
        let patches = Patches::new(self.mesh, faces, &sign, &offset);
        for &h in edges {
            let pair = self.mesh.pair(h).expect("only pairs were taken");
            let [one, other] = [h, pair].map(|h| patches.side(self.mesh, h.face(), &sign));
            let comes_to_joint = self.passed.contains(&h) || self.passed.contains(&pair);
            if one == other && !comes_to_joint {
                continue;
            }
            let forward = self.is_forward(h);
            let ends = h.ends(forward).map(|h| self.mesh.origin(h));
            let nodes = ends.map(|v| self.vertex_node(v));
            self.add(trace, Place::Edge { h, forward }, nodes);
        }
    }

    fn add(&self, trace: &mut Trace, place: Place, nodes: [Node; 2]) {
        match self.piece(place, nodes) {
            Ok(piece) => trace.pieces.push(piece),
            Err(tip) => trace.lone_tips.extend(tip),
        }
    }
}
