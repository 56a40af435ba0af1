//! Moving vertices onto the plane, along the edges whose crossings they stand for.
//!
//! The slides of a cut are judged together, and with the points that the cut is about to insert. So a face keeps
//! the bound of the snap r whatever its vertices do: none of the faces that it is cut into has an altitude below
//! r (1 − r) times its own before the cut.

use std::collections::BTreeMap;

use super::tips::corners_of;
use super::trace::{Site, Snapped, Trace};
use crate::edit::{ChildFace, Edits};
use crate::exact::ROUNDING;
use crate::geometry::{Point, altitude, between, cross, dot, max_abs};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::cut_context::CutContext;
use crate::slide;

/// The least part of its smallest altitude that a face keeps when its vertices slide.
const ALTITUDE_KEPT: f64 = 0.3;

/// Slides the vertices of the slit that stand for crossings, as far as that does no harm; see
/// [`Scissor::with_snap_move`](super::super::Scissor::with_snap_move). A vertex near which the plane merely
/// passes stays: nothing is cut there. `children` are the faces that the cut will insert.
pub(super) fn onto_plane(
    context: &CutContext<'_>,
    trace: &Trace,
    snap: f64,
    children: &[ChildFace],
    mesh: &mut Mesh,
    positions: &mut Positions,
    edits: &mut Edits,
) {
    let nodes = trace.nodes();
    let is_due = |one: &&Snapped| {
        one.t > 0.0
            && nodes.binary_search(&Site::Vertex(one.vertex)).is_ok()
            && may_slide(mesh, positions, one.vertex, one.toward)
    };
    let mut due: Vec<&Snapped> = trace.snapped.iter().filter(is_due).collect();
    // The other end of the edge is farther from the plane. So it slides later, and a vertex slides along the
    // edge on which the crossing was found.
    let distance = |one: &Snapped| context.offsets.of(one.vertex).abs();
    due.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
    let mut trial = Trial {
        mesh,
        positions,
        children,
        least: snap * (1.0 - snap),
        moved: BTreeMap::new(),
    };
    due.retain(|one| trial.takes(one));
    for one in due {
        slide::toward(mesh, one.vertex, one.toward, one.t, edits)
            .expect("a crossing is on an edge");
    }
    edits.replay(positions);
}

/// Whether a vertex is inside the mesh and untorn, or slides along a boundary that is straight there.
fn may_slide(mesh: &Mesh, positions: &Positions, vertex: VertexId, toward: VertexId) -> bool {
    let edges = |h: HalfEdgeId| [(h, mesh.target(h)), (h.prev(), mesh.origin(h.prev()))];
    let mut on_boundary = Vec::new();
    for (h, end) in mesh.corners_of(vertex).flat_map(edges) {
        if mesh.ghost_pair(h).is_some() {
            return false;
        }
        if mesh.pair(h).is_none() {
            on_boundary.push(end);
        }
    }
    match on_boundary[..] {
        [] => true,
        [one, other] => {
            let ends = [one, other].map(|v| positions.at(v));
            (one == toward || other == toward) && is_between(positions.at(vertex), ends)
        }
        _ => false,
    }
}

/// Whether a point lies on the line from one point to another and between them, as far as the rounding of
/// coordinates can tell: it may be off the line by 32 · 2^-53 of the largest coordinate.
fn is_between(p: Point, [a, b]: [Point; 2]) -> bool {
    let [to_a, to_b] = [a - p, b - p];
    let largest = [p, a, b].map(|p| max_abs(p.coords));
    let largest = largest.into_iter().fold(0.0, f64::max);
    // Without squares, which could be too small for an `f64`.
    let off = max_abs(cross(to_a, to_b));
    dot(to_a, to_b) < 0.0 && off <= ROUNDING * largest * max_abs(b - a)
}

/// Slides vertices on trial.
struct Trial<'t> {
    mesh: &'t Mesh,
    positions: &'t Positions,
    /// By parent.
    children: &'t [ChildFace],
    /// The least part of the altitude of a face that the faces keep that it is cut into.
    least: f64,
    /// Where the vertices are that slide.
    moved: BTreeMap<VertexId, Point>,
}

impl Trial<'_> {
    fn at(&self, v: VertexId) -> Point {
        let moved = self.moved.get(&v).copied();
        moved.unwrap_or_else(|| self.positions.at(v))
    }

    /// Slides a vertex, unless that does harm to a face; whether it did.
    fn takes(&mut self, one: &Snapped) -> bool {
        let to = between(self.at(one.vertex), self.at(one.toward), one.t);
        self.moved.insert(one.vertex, to);
        let is_harmless = self.mesh.faces_of(one.vertex).all(|f| self.keeps(f));
        if !is_harmless {
            self.moved.remove(&one.vertex);
        }
        is_harmless
    }

    /// Whether a face keeps its orientation and enough of its altitude, as do the faces that it is cut into.
    fn keeps(&self, f: FaceId) -> bool {
        let corners = self.mesh.face_vertices(f);
        let before = corners.map(|v| self.positions.at(v));
        let after = corners.map(|v| self.at(v));
        let [normal, turned] = [before, after].map(|[a, b, c]| cross(b - a, c - a));
        let high = altitude(before);
        let first = self.children.partition_point(|child| child.parent < f);
        let children = self.children[first..].iter();
        let mut children = children.take_while(|child| child.parent == f);
        dot(normal, turned) > 0.0
            && altitude(after) >= ALTITUDE_KEPT * high
            && children.all(|child| altitude(corners_of(child, after)) >= self.least * high)
    }
}
