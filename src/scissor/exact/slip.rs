//! Moving vertices onto the plane, along the edges whose crossings they stand for.

use super::trace::{Site, Snapped, Trace};
use crate::edit::Edits;
use crate::geometry::{altitude, between, cross, dot};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::slide;

/// A face may keep as little of its smallest altitude as this.
const ALTITUDE_KEPT: f64 = 0.3;

/// Slides the vertices of the slit that stand for crossings, as far as that does no harm; see
/// [`Scissor::snap_move`](super::super::Scissor::snap_move). A vertex near which the plane merely
/// passes stays: nothing is cut there.
pub(super) fn onto_plane(
    trace: &Trace,
    mesh: &mut Mesh,
    positions: &mut Positions,
    edits: &mut Edits,
) {
    let nodes = trace.nodes();
    for &Snapped {
        vertex, toward, t, ..
    } in &trace.snapped
    {
        if t > 0.0
            && nodes.binary_search(&Site::Vertex(vertex)).is_ok()
            && may_slide(mesh, vertex, toward)
            && is_harmless(mesh, positions, vertex, toward, t)
        {
            slide::toward(mesh, vertex, toward, t, edits).expect("a crossing is on an edge");
            // The next vertex may have a face in common with this one.
            edits.replay(positions);
        }
    }
}

/// Whether a vertex is inside the mesh and untorn, or slides along its boundary.
fn may_slide(mesh: &Mesh, vertex: VertexId, toward: VertexId) -> bool {
    let is_edge = |h: HalfEdgeId| mesh.origin(h) == toward || mesh.target(h) == toward;
    let sides = |h: HalfEdgeId| [h, h.prev()];
    let mut on_boundary = false;
    let mut along_boundary = false;
    for h in mesh.corners_of(vertex).flat_map(sides) {
        if mesh.ghost_pair(h).is_some() {
            return false;
        }
        if mesh.pair_or_ghost(h).is_none() {
            on_boundary = true;
            along_boundary |= is_edge(h);
        }
    }
    !on_boundary || along_boundary
}

/// Whether every face round the vertex keeps its orientation and enough of its altitude.
fn is_harmless(
    mesh: &Mesh,
    positions: &Positions,
    vertex: VertexId,
    toward: VertexId,
    t: f64,
) -> bool {
    let moved = between(positions.at(vertex), positions.at(toward), t);
    mesh.faces_of(vertex).all(|f| {
        let corners = mesh.face_vertices(f);
        let before = corners.map(|v| positions.at(v));
        let after = corners.map(|v| if v == vertex { moved } else { positions.at(v) });
        let [normal, turned] = [before, after].map(|[a, b, c]| cross(b - a, c - a));
        dot(normal, turned) > 0.0 && altitude(after) >= ALTITUDE_KEPT * altitude(before)
    })
}
