//! The method `exact`: insert vertices where the plane crosses edges, and unshare by fan.
//!
//! 1. **Signs**, once a vertex. A sign that rounding cannot vouch for is zero: *on* the plane.
//! 2. **Snap**, as a fraction of the edge: where the slit crosses an edge nearer to an end than
//!    that, the end counts as on the plane, for all its edges. It is not moved, so the seam
//!    deviates by as much, unless that is asked for (`exact/snap.rs`). What is left are crossings
//!    well inside their edges, and so no child has an altitude below r (1 − r) of its parent's.
//!    A vertex that would leave such a child if it moved stays.
//! 3. **Trace** (`exact/trace.rs`, found by `exact/tracer.rs`): in each face the slit runs from
//!    node to node (a vertex on the plane, or a crossing) as far as the strip between the side
//!    planes goes. Where that ends inside the face there is a *tip*, which moves along the slit or
//!    away from an edge where it would leave a thin face (`exact/tips.rs`).
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
pub(super) mod layers;
mod planner;
mod snap;
mod tips;
mod trace;
mod tracer;

use super::cut_context::CutContext;
use super::cut_result::{CrumbFilter, CutResult, Sides, faces_at};
use super::pieces::{PieceCounts, Pinch};
use crate::edit::{Cursor, Edit, Edits};
use crate::geometry::Point;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::insert::{InsertRefusal, Plan};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::unshare;
use label::Patches;
use planner::Planner;
pub(super) use trace::Trace;
use trace::{Place, Site};

/// How near a node a tip may be without being that node, as a part of the way through the face.
pub(super) fn nearest_tip(snap: f64) -> f64 {
    snap.max(tracer::TIP_MIN)
}

/// Finds where the slit runs, and where it has to end so that no face gets thin.
pub(super) fn trace(
    context: &CutContext<'_>,
    snap: f64,
    mesh: &Mesh,
    positions: &Positions,
) -> Trace {
    // Nodes that the slit does not meet but has to go on to. Each round adds one that was not
    // there.
    let mut met: Vec<Site> = Vec::new();
    loop {
        let mut trace = tracer::trace(context, snap, &met, mesh, positions);
        let beyond = tips::settle(&mut trace, snap, mesh, positions);
        let known = met.len();
        met.extend(beyond);
        met.sort_unstable();
        met.dedup();
        if met.len() == known {
            return trace;
        }
    }
}

/// The pieces that a cut along a trace should leave: those of the slit as it is, or more where
/// the trace ends nearer than the snap to a boundary, which it opens. And the necks that it
/// severs although the slit does not.
pub(super) fn pieces_expected(
    context: &CutContext<'_>,
    trace: &Trace,
    counts: &PieceCounts,
    mesh: &Mesh,
    positions: &Positions,
) -> (usize, Vec<Pinch>) {
    let unsnapped = tracer::trace(context, 0.0, &[], mesh, positions);
    let (whole, _) = pieces_of(context, &unsnapped, counts, mesh);
    let (pieces, pinches) = pieces_of(context, trace, counts, mesh);
    let more: usize = pinches.iter().map(|pinch| pinch.at.len()).sum();
    (whole.max(pieces - more), pinches)
}

fn pieces_of(
    context: &CutContext<'_>,
    trace: &Trace,
    counts: &PieceCounts,
    mesh: &Mesh,
) -> (usize, Vec<Pinch>) {
    let mut on_plane: Vec<VertexId> = trace.snapped.iter().map(|one| one.vertex).collect();
    on_plane.extend(context.joints.iter().flatten());
    on_plane.sort_unstable();
    let sign = |v: VertexId| match on_plane.binary_search(&v) {
        Ok(_) => 0.0,
        Err(_) => context.offsets.of(v),
    };
    let (mut faces, mut edges) = (Vec::new(), Vec::new());
    let pieces = trace.pieces.iter();
    for piece in pieces.filter(|piece| piece.ends_at_nodes() == [true; 2]) {
        match piece.place {
            Place::Face(f) => faces.push(f),
            Place::Edge { h, .. } => edges.push(h),
        }
    }
    faces.sort_unstable();
    edges.sort_unstable();
    let is_slit = |f: FaceId| faces.binary_search(&f).is_ok();
    let is_slit_along = |h: HalfEdgeId| {
        let pair = mesh.pair(h).unwrap_or(h);
        edges.binary_search(&h).is_ok() || edges.binary_search(&pair).is_ok()
    };
    let passed = |v: VertexId| match on_plane.binary_search(&v) {
        Ok(_) => context.offsets.of(v),
        Err(_) => 0.0,
    };
    counts.expected(mesh, sign, is_slit, is_slit_along, passed)
}

/// Cuts along a trace. Where vertices are to be moved onto the plane, `snap_move` is the snap.
pub(super) fn cut(
    context: &CutContext<'_>,
    mut trace: Trace,
    snap_move: Option<f64>,
    mesh: &mut Mesh,
    positions: &mut Positions,
    judged: CrumbFilter<'_>,
    edits: &mut Edits,
) -> CutResult {
    let faces_before = mesh.face_count();
    let (slit, insertion) = loop {
        let (plan, slit) = Slit::plan(&trace, mesh);
        match plan.prepare(mesh) {
            Ok(insertion) => break (slit, (!plan.points().is_empty()).then_some(insertion)),
            Err(InsertRefusal::Crowded { face }) => {
                trace
                    .pieces
                    .retain(|piece| piece.place != Place::Face(face));
                trace.finish(mesh);
            }
            Err(refusal) => panic!("a trace makes a plan that can be carried out: {refusal}"),
        }
    };
    if let Some(snap) = snap_move {
        let children = insertion.as_ref().map_or(&[][..], |one| &one.children);
        snap::onto_plane(context, &trace, snap, children, mesh, positions, edits);
    }
    if let Some(insertion) = insertion {
        insertion.carry_out(mesh, edits);
    }
    edits.replay(positions);
    let [touched, judged] = [faces_at(mesh, &slit.nodes), judged(mesh, edits)]
        .map(|faces| sides(context, faces, faces_before, mesh, positions, &trace, &slit));
    let before = edits.cursor();
    let edges = slit.edges.iter();
    let torn = edges.flat_map(|&ends| pair_between(mesh, ends));
    let mut torn: Vec<HalfEdgeId> = torn.collect();
    torn.sort_unstable();
    unshare::by_fan(mesh, &slit.nodes, |h| torn.binary_search(&h).is_ok(), edits);
    CutResult {
        touched,
        judged,
        refused: 0,
        ends: slit.tips.map(|tips| with_copies(tips, edits, before)),
        off_plane: with_copies(slit.off_plane, edits, before),
    }
}

/// The sides of faces, once all vertices are inserted. A face that still lies on both sides
/// has none: it is round a tip, beside a piece that leaves the plane, or where nothing was to be
/// cut.
fn sides(
    context: &CutContext<'_>,
    faces: Vec<FaceId>,
    faces_before: usize,
    mesh: &Mesh,
    positions: &Positions,
    trace: &Trace,
    slit: &Slit,
) -> Sides {
    let snapped = trace.snapped.iter().map(|one| one.vertex);
    let mut on_plane: Vec<VertexId> = snapped.chain(slit.nodes.iter().copied()).collect();
    on_plane.sort_unstable();
    // Only the passive twin of a crossing is new and not on the plane.
    let offset = |v: VertexId| match v.index() < context.offsets.len() {
        true => context.offsets.of(v),
        false => context.strip.plane.offset(positions.at(v)),
    };
    let sign = |v: VertexId| match on_plane.binary_search(&v) {
        Ok(_) => 0.0,
        Err(_) => offset(v),
    };
    let is_uncut = |f: FaceId| {
        let corners = mesh.face_vertices(f);
        let mut ends = slit.tips.iter().chain([&slit.off_plane]);
        ends.any(|of_side| corners.iter().any(|v| of_side.contains(v)))
            || !meets(context, corners.map(|v| positions.at(v)))
            || (f.index() < faces_before && context.among.binary_search(&f).is_err())
    };
    let lies_on_both = |f: FaceId| {
        let signs = mesh.face_vertices(f).map(sign);
        signs.iter().any(|&d| d < 0.0) && signs.iter().any(|&d| d > 0.0)
    };
    let patches = Patches::new(mesh, faces.iter().copied(), &sign, &offset);
    let side = |f: FaceId| {
        let goes_on = lies_on_both(f) && is_uncut(f);
        (!goes_on).then(|| patches.side(mesh, f, &sign))
    };
    faces.into_iter().map(|f| (f, side(f))).collect()
}

/// Whether the plane crosses a triangle between the side planes.
fn meets(context: &CutContext<'_>, corners: [Point; 3]) -> bool {
    let is_inside =
        |[p, q]: [Point; 2]| context.strip.clip(p, q, context.offsets.bound()).is_some();
    context.strip.section(corners).is_some_and(is_inside)
}

/// The edges that are to be torn, and that are in the mesh once all points are inserted.
struct Slit {
    edges: Vec<[VertexId; 2]>,
    /// The vertices at their ends, ascending.
    nodes: Vec<VertexId>,
    /// The vertices at which each side plane ends the slit.
    tips: [Vec<VertexId>; 2],
    /// The vertices of pieces that leave the plane, so that no face gets thin.
    off_plane: Vec<VertexId>,
}

impl Slit {
    /// What the trace needs inserted, and the slit that there will be then.
    fn plan(trace: &Trace, mesh: &Mesh) -> (Plan, Slit) {
        let mut planner = Planner::new(trace, mesh);
        let mut edges: Vec<[VertexId; 2]> = Vec::new();
        let mut tips: [Vec<VertexId>; 2] = Default::default();
        let mut off_plane = Vec::new();
        for piece in &trace.pieces {
            let chain = planner.piece(piece);
            if piece.inset > 0.0 {
                off_plane.extend(&chain);
            }
            edges.extend(chain.windows(2).map(|two| [two[0], two[1]]));
            for (end, v) in piece.tips.into_iter().zip([chain.first(), chain.last()]) {
                if let Some(side) = end {
                    tips[side].extend(v);
                }
            }
        }
        for &(side, site) in &trace.lone_tips {
            tips[side].extend(planner.vertex(site));
        }
        for of_side in &mut tips {
            of_side.sort_unstable();
            of_side.dedup();
        }
        let mut nodes: Vec<VertexId> = edges.as_flattened().to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        let slit = Slit {
            edges,
            nodes,
            tips,
            off_plane,
        };
        (planner.plan, slit)
    }
}

/// Vertices of the slit, and those that they were split into by the edits from `first` on.
pub(super) fn with_copies(
    mut vertices: Vec<VertexId>,
    edits: &Edits,
    first: Cursor,
) -> Vec<VertexId> {
    for edit in edits.since(first) {
        if let Edit::Split(split) = edit
            && vertices.contains(&split.old)
        {
            vertices.push(split.new);
        }
    }
    vertices
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
