//! The layers of a folded surface that a cut goes through.
//!
//! Plane, mesh and strip have *chains* in common: pieces of the slit that follow one another from face
//! to face. A sheet that the strip passes once gives one, the front and the back of a garment one
//! each. They are those of the plane itself, before any vertex is snapped.

use super::trace::{Piece, Place, Site, Trace};
use super::tracer;
use crate::exact::ROUNDING;
use crate::geometry::{Point, Ray, between, dot, length, max_abs};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::cut_context::CutContext;
use crate::scissor::offsets::Offsets;
use crate::sets::DisjointSets;

/// The layers of the mesh that a cut passes through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CutLayers {
    /// All layers that the plane meets between the rays.
    #[default]
    All,
    /// The layers that the rays meet first. These are the chain of crossed faces that the first ray
    /// hits first, and the chain that the second ray hits first. If the two differ, both are cut. A
    /// chain continues across an earlier cut or tear whose two sides coincide. A ray that misses the
    /// mesh is moved and turned toward the other until it hits. A cut by a plane has no rays and passes
    /// through all layers.
    ///
    /// The cut runs through the faces of these chains. At the ends of a chain, where a snapped seam ends
    /// or a method tears along edges, it also runs through faces in which the plane continues beyond the
    /// rays. A layer is cut as if the others were absent, but a vertex that belongs only to other chains is
    /// never split. A cut that continues another stays in the layer of that one.
    First,
}

/// The place where a ray met a layer that was cut: see [`CutLayers::First`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerHit {
    /// The point at which the ray meets the layer.
    pub at: Point,
    /// The smallest face id of the chain before the cut, which identifies the chain. If both rays
    /// hit the same chain, both hits have the same value here.
    pub chain: FaceId,
}

/// What a cut is to go through.
#[derive(Debug, Default)]
pub(in crate::scissor) struct Choice {
    pub(in crate::scissor) hits: [Option<LayerHit>; 2],
    /// Ascending.
    pub(in crate::scissor) faces: Vec<FaceId>,
    /// Those of the other chains.
    others: Vec<FaceId>,
    /// The joints on these layers.
    pub(in crate::scissor) joints: [Vec<VertexId>; 2],
}

/// Chooses the chains that the rays hit first.
pub(in crate::scissor) fn first(
    context: &CutContext<'_>,
    rays: &[Ray; 2],
    mesh: &Mesh,
    positions: &Positions,
) -> Choice {
    let trace = tracer::trace(context, 0.0, &[], mesh, positions);
    let chains = chains(&trace, mesh, positions);
    let pieces = || trace.pieces.iter().zip(chains.iter().copied());
    let runs =
        pieces().map(|(piece, chain)| (Run::new(context, &trace, piece, mesh, positions), chain));
    let runs: Vec<(Run, u32)> = runs.collect();
    let faces_of = |is_one: &dyn Fn(u32) -> bool| {
        let pieces = pieces().filter(|&(_, chain)| is_one(chain));
        let faces = pieces.flat_map(|(piece, _)| faces_of(piece, mesh));
        faces.collect::<Vec<FaceId>>()
    };
    let mut choice = Choice::default();
    let mut chosen = Vec::new();
    for side in 0..2 {
        let hit = hit(&runs, rays, side, chosen.first().copied());
        let Some((at, chain)) = hit.or_else(|| beside(context, &runs, rays, side)) else {
            continue;
        };
        let faces = faces_of(&|other| other == chain);
        let least = faces.iter().min().copied();
        choice.hits[side] = least.map(|chain| LayerHit { at, chain });
        choice.faces.extend(faces);
        chosen.push(chain);
    }
    choice.others = faces_of(&|chain| !chosen.contains(&chain));
    choice.faces.sort_unstable();
    choice.faces.dedup();
    let faces = &choice.faces;
    let is_chosen = |v: &VertexId| mesh.faces_of(*v).any(|f| faces.binary_search(&f).is_ok());
    choice.joints = context.joints.each_ref().map(|of_side| {
        let of_side = of_side.iter().copied();
        of_side.filter(is_chosen).collect()
    });
    choice
}

impl Choice {
    /// The chosen faces, and those that the plane meets beyond the rays as it goes on from these;
    /// ascending. A method that splits vertices tears edges there too: where the last vertex between the
    /// rays is split, the edges beyond it are the plane's, and not the slit's. And a seam that is snapped to
    /// a vertex may end in a face that the plane itself meets beyond the rays. Faces with a vertex of
    /// another chain are left out, so that this is not split. As a chain does, the plane goes on across a tear
    /// whose sides coincide.
    pub(in crate::scissor) fn beyond_the_rays(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        offsets: &Offsets,
    ) -> Vec<FaceId> {
        let corners = self.others.iter().flat_map(|&f| mesh.face_vertices(f));
        let mut of_others: Vec<VertexId> = corners.collect();
        of_others.sort_unstable();
        of_others.dedup();
        let is_free = |f: FaceId| {
            let mut corners = mesh.face_vertices(f).into_iter();
            corners.all(|v| of_others.binary_search(&v).is_err())
        };
        let touched = offsets.touched();
        let mut is_met = vec![false; touched.len()];
        let mut open = self.faces.clone();
        while let Some(f) = open.pop() {
            let is_chosen = self.faces.binary_search(&f).is_ok();
            match touched.binary_search(&f) {
                Ok(at) if !is_met[at] && (is_chosen || is_free(f)) => is_met[at] = true,
                _ => continue,
            }
            for h in f.half_edges() {
                let [from, to] = [mesh.origin(h), mesh.target(h)].map(|v| offsets.of(v));
                let across = mesh.pair(h).or_else(|| across_tear(h, mesh, positions));
                let across = across.filter(|_| from * to <= 0.0);
                open.extend(across.map(HalfEdgeId::face));
            }
        }
        let met = touched.iter().zip(is_met).filter(|&(_, is_met)| is_met);
        met.map(|(&f, _)| f).collect()
    }
}

/// The number of each piece's chain. A chain continues across a tear whose sides coincide.
fn chains(trace: &Trace, mesh: &Mesh, positions: &Positions) -> Vec<u32> {
    let mut sets = DisjointSets::new(trace.pieces.len() as u32);
    let mut ends: Vec<(Site, u32)> = Vec::new();
    for (piece, i) in trace.pieces.iter().zip(0..) {
        let nodes = piece.end_nodes().into_iter().flatten();
        ends.extend(nodes.map(|site| (of_both_sides(site, mesh, positions), i)));
    }
    ends.sort_unstable();
    for two in ends.windows(2).filter(|two| two[0].0 == two[1].0) {
        sets.join(two[0].1, two[1].1);
    }
    sets.representatives().to_vec()
}

/// A node, or where it lies on a tear that has not opened, the same one of two for both sides.
fn of_both_sides(site: Site, mesh: &Mesh, positions: &Positions) -> Site {
    match site {
        Site::Edge(h) => Site::Edge(across_tear(h, mesh, positions).map_or(h, |g| g.min(h))),
        Site::Vertex(v) => {
            let copies = mesh.copies(v);
            let copies = copies.filter(|&copy| positions.at(copy) == positions.at(v));
            Site::Vertex(copies.min().unwrap_or(v))
        }
    }
}

/// The other side of a torn edge, where both sides coincide.
fn across_tear(h: HalfEdgeId, mesh: &Mesh, positions: &Positions) -> Option<HalfEdgeId> {
    let are_one = |a: VertexId, b: VertexId| positions.at(a) == positions.at(b);
    let coincides = |g: &HalfEdgeId| {
        are_one(mesh.origin(h), mesh.target(*g)) && are_one(mesh.target(h), mesh.origin(*g))
    };
    mesh.ghost_pair(h).filter(coincides)
}

/// The faces of a piece: the one that it crosses, or the two between which it runs.
fn faces_of(piece: &Piece, mesh: &Mesh) -> impl Iterator<Item = FaceId> {
    let h = match piece.place {
        Place::Face(f) => f.half_edges()[0],
        Place::Edge { h, .. } => h,
    };
    let pair = mesh
        .pair(h)
        .filter(|_| matches!(piece.place, Place::Edge { .. }));
    [Some(h), pair].into_iter().flatten().map(HalfEdgeId::face)
}

/// A piece, as a ray sees it.
struct Run {
    nodes: [Point; 2],
    from: f64,
    to: f64,
    /// How far each node is inside each side plane.
    depths: [[f64; 2]; 2],
    /// Whether each node is a joint of each side.
    joints: [[bool; 2]; 2],
}

impl Run {
    fn new(
        context: &CutContext<'_>,
        trace: &Trace,
        piece: &Piece,
        mesh: &Mesh,
        positions: &Positions,
    ) -> Run {
        let bounded = context.strip.bounded();
        let node = |site: Site| {
            let at = match site {
                Site::Vertex(v) => positions.at(v),
                Site::Edge(h) => {
                    let crossing = trace.crossing(h).expect("the nodes of pieces are known");
                    let ends = h.ends(crossing.forward);
                    let [p, q] = ends.map(|h| positions.at(mesh.origin(h)));
                    between(p, q, crossing.t)
                }
            };
            let mut depths = bounded.depths(at, context.offsets.bound());
            let is_joint =
                |joints: &Vec<VertexId>| matches!(site, Site::Vertex(v) if joints.contains(&v));
            let joints = context.joints.each_ref().map(is_joint);
            for (depth, is_joint) in depths.iter_mut().zip(joints) {
                if is_joint {
                    *depth = 0.0;
                }
            }
            (at, depths, joints)
        };
        let [one, other] = piece.nodes.map(node);
        Run {
            nodes: [one.0, other.0],
            from: piece.from,
            to: piece.to,
            depths: [one.1, other.1],
            joints: [one.2, other.2],
        }
    }

    fn at(&self, t: f64) -> Point {
        between(self.nodes[0], self.nodes[1], t)
    }

    /// Whether a joint of a side is at this end.
    fn is_joint(&self, t: f64, side: usize) -> bool {
        (t == 0.0 && self.joints[0][side]) || (t == 1.0 && self.joints[1][side])
    }
}

/// A place where a ray meets a run.
struct Hit {
    far: f64,
    at: Point,
    chain: u32,
    is_joint: bool,
}

/// The first place where a ray meets a run, and its chain. A cut that comes from a joint goes on in the chain that
/// has it. Of layers at one place, up to rounding, the one that was `chosen` for the other ray counts.
fn hit(
    runs: &[(Run, u32)],
    rays: &[Ray; 2],
    side: usize,
    chosen: Option<u32>,
) -> Option<(Point, u32)> {
    let ray = rays[side];
    let mut hits: Vec<Hit> = Vec::new();
    for (run, chain) in runs {
        let [start, end] = run.depths.map(|depths| depths[side]);
        let t = match (start == 0.0, end == 0.0) {
            (true, true) => vec![0.0, 1.0], // The run lies on the ray.
            (true, false) => vec![0.0],
            (false, true) => vec![1.0],
            (false, false) if (start < 0.0) != (end < 0.0) => vec![start / (start - end)],
            (false, false) => continue,
        };
        for t in t.into_iter().filter(|&t| run.from <= t && t <= run.to) {
            let at = run.at(t);
            let far = dot(at - ray.origin(), ray.direction());
            if far >= 0.0 {
                hits.push(Hit {
                    far,
                    at,
                    chain: *chain,
                    is_joint: run.is_joint(t, side),
                });
            }
        }
    }
    let has_joint = hits.iter().any(|hit| hit.is_joint);
    hits.retain(|hit| hit.is_joint == has_joint);
    let nearest = hits.iter().map(|hit| hit.far).min_by(f64::total_cmp)?;
    let size = length(ray.direction());
    let is_first = |hit: &&Hit| {
        let reach = max_abs(hit.at.coords).max(max_abs(ray.origin().coords));
        hit.far - nearest <= ROUNDING * reach * size
    };
    let mut first = hits.iter().filter(is_first);
    let of_chosen = first.clone().find(|hit| Some(hit.chain) == chosen);
    let hit = of_chosen.or_else(|| first.find(|hit| hit.far == nearest))?;
    Some((hit.at, hit.chain))
}

/// Where the first ray from one to the other meets a run, and the chain of that: the place in the
/// strip that is least far from the side plane of the ray as a part of the way to the other's.
fn beside(
    context: &CutContext<'_>,
    runs: &[(Run, u32)],
    rays: &[Ray; 2],
    side: usize,
) -> Option<(Point, u32)> {
    let (bounded, bound) = (context.strip.bounded(), context.offsets.bound());
    let sides = bounded.sides?;
    let [ray, other] = [rays[side], rays[1 - side]];
    let [along, other_along] = [ray, other].map(|ray| ray.direction() / length(ray.direction()));
    let mut first: Option<(f64, Point, u32)> = None;
    for (run, chain) in runs {
        let [p, q] = [run.at(run.from), run.at(run.to)];
        let Some((from, to)) = bounded.clip(p, q, bound) else {
            continue;
        };
        for at in [from, to].map(|t| between(p, q, t)) {
            let depths = [side, 1 - side].map(|side| sides[side].distance(at).max(0.0));
            let whole = depths[0] + depths[1];
            let part = if whole > 0.0 { depths[0] / whole } else { 0.0 };
            let direction = along + (other_along - along) * part;
            let is_ahead = dot(at - between(ray.origin(), other.origin(), part), direction) >= 0.0;
            if is_ahead && first.is_none_or(|first| part < first.0) {
                first = Some((part, at, *chain));
            }
        }
    }
    first.map(|(_, at, chain)| (at, chain))
}
