//! The paper's two methods, `uniform` and `alternating` (Souza et al. 2014 §V), as they stand.
//!
//! "We iterate through all triangles on the target cloth to gather only the triangles that
//! intersects the plane P." Of each, the vertices on the positive side of P that are also
//! on the positive side of both side planes are split. *Uniform* splits them by a plane with the
//! normal N of P. *Alternating* does so too where one vertex is positive; where two are, C and
//! D, the normal is `N_tri × (D − C)`, so that the faces beyond the edge CD come off.
//!
//! How the paper is read where it leaves a choice: a vertex on P is positive. The crossed faces
//! are gathered first, ascending; their corners are read again at each split, since
//! a split before may have given the face another vertex. C and D are in the cyclic order of
//! the face, and `N_tri` is its normal by that order.
//!
//! Neither method promises to divide. On irregular meshes `uniform` leaves bridges ("the mesh not
//! being completely divided"); `alternating` mostly divides, and leaves crumbs and a longer seam,
//! because it may split the same vertex several times: at a vertex with very many faces by way of a
//! tree of them (`scissor/hub.rs`). They are offered for comparison. Use
//! [`CutMethod::Exact`](super::CutMethod::Exact), or
//! [`CutMethod::Partition`](super::CutMethod::Partition) for a cut that adds no faces.

use super::cut_context::CutContext;
use super::cut_result::{CrumbFilter, CutResult, faces_at};
use super::hub::Hubs;
use crate::edit::Edits;
use crate::geometry::{Plane, Side, Vector, cross};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

pub(super) fn cut(
    context: &CutContext<'_>,
    is_alternating: bool,
    mesh: &mut Mesh,
    positions: &mut Positions,
    judged: CrumbFilter<'_>,
    edits: &mut Edits,
) -> CutResult {
    let is_positive = |mesh: &Mesh, positions: &Positions, h: HalfEdgeId| {
        Side::of(context.strip.plane.offset(positions.at(mesh.origin(h)))) == Side::Front
    };
    let positive = |mesh: &Mesh, positions: &Positions, f: FaceId| {
        f.half_edges()
            .into_iter()
            .filter(|&h| is_positive(mesh, positions, h))
            .count()
    };
    let among = context.among.iter().copied();
    let crossed: Vec<FaceId> = among
        .filter(|&f| matches!(positive(mesh, positions, f), 1 | 2))
        .collect();
    // The crossed faces go with the negative side: the splits are on the positive one.
    let labelled = |faces: Vec<FaceId>| {
        let side = |f: FaceId| match positive(mesh, positions, f) {
            3 => Side::Front,
            _ => Side::Back,
        };
        faces.into_iter().map(|f| (f, Some(side(f)))).collect()
    };
    let corners = crossed.iter().flat_map(|&f| mesh.face_vertices(f));
    let mut vertices: Vec<VertexId> = corners.collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut outcome = CutResult {
        touched: labelled(faces_at(mesh, &vertices)),
        judged: labelled(judged(mesh, edits)),
        ..CutResult::default()
    };
    let mut hubs = Hubs::default();
    for f in crossed {
        let corners = f.half_edges();
        let mut negative = corners
            .into_iter()
            .filter(|&h| !is_positive(mesh, positions, h));
        let along_edge = match (negative.next(), negative.next()) {
            (Some(h), None) if is_alternating => Some(beyond_edge(mesh, positions, h.next())),
            _ => None,
        };
        for h in corners {
            let v = mesh.origin(h);
            let at = positions.at(v);
            if !is_positive(mesh, positions, h) || context.strip.depth(at, 0.0) < 0.0 {
                continue;
            }
            let plane = match along_edge {
                Some(normal) => Plane::new(at, normal).ok(),
                None => Some(context.strip.plane.through(at)),
            };
            let is_split = plane.is_some_and(|plane| {
                let plane = (&plane, along_edge.is_none());
                hubs.split(mesh, v, plane, positions, edits)
            });
            match is_split {
                true => edits.replay(positions),
                false => outcome.refused += 1,
            }
        }
    }
    outcome
}

/// `N_tri × (D − C)` for the half-edge from C to D: in the plane of the face, pointing away from
/// what lies beyond the edge. Zero for a face without area: there is no such direction.
fn beyond_edge(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> Vector {
    let [c, d, e] = [h, h.next(), h.prev()].map(|h| positions.at(mesh.origin(h)));
    cross(cross(d - c, e - c), d - c)
}
