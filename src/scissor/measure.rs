//! Measures what a cut should do, and what it did.
//!
//! A [`CutMeasurer`] looks at the mesh before a cut: where the slit (the part of the plane
//! between the side planes) meets it, how long it is there, and into how many pieces an ideal
//! cut would divide it. The [`CutReport`] compares that with the mesh after the cut.
//! Nothing is denied: loose crumbs, pieces that stayed together and vertices that both sides
//! still share are counted.

use super::aim::{Aim, Aims, CutAim};
use super::cut_context::CutContext;
use super::cut_result::{CutResult, side_of};
use super::exact::{self, Trace, with_copies};
use super::neck::{self, CutNeck};
use super::pieces::{PieceCounts, Pinch};
use super::seam::Nodes;
use super::survey::Survey;
use crate::edit::{ChildFace, Cursor, Edit, Edits};
use crate::geometry::{Point, Side, length};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// The measurements of a cut.
///
/// A *component* is a set of faces joined by shared edges. The *seam* is the set of edges that this cut
/// tore. The *slit* is the part of the plane between the side planes. Lengths are in units of the model.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CutReport {
    /// The number of faces that the slit crosses.
    pub faces_crossed: usize,
    /// The number of vertex splits. A vertex that was split twice counts twice.
    pub splits: usize,
    /// The number of splits that were refused because all faces of the vertex were on one side.
    pub refused: usize,
    /// The number of half-edges whose pair became a ghost pair: two for each edge of the seam.
    pub ghost_pairs: usize,
    /// Whether the two sides are separate where the slit meets the mesh. If true, no vertex strictly
    /// between the side planes belongs to faces of both sides, and no edge there joins both.
    pub separated: bool,
    /// The number of components before the cut.
    pub pieces_before: usize,
    /// The number of components after the cut.
    pub pieces: usize,
    /// The number of components that a cut exactly along the slit would leave. It may be larger if
    /// the method `exact` snaps an end of the slit to the boundary. A face on the plane counts as
    /// front, except for the method `exact`, which does not cut faces that the plane merely touches.
    pub pieces_expected: usize,
    /// The number of pieces in excess of `pieces_expected`, which is 0 for a perfect cut.
    pub crumbs: usize,
    /// The pieces that came off because the neck on which each hung is narrower than the snap.
    pub necks: Vec<CutNeck>,
    /// The number of pieces missing from `pieces_expected`, which is 0 for a perfect cut.
    pub lost: usize,
    /// The sum of the lengths of all edges of the seam, each counted once.
    pub seam_length: f64,
    /// The length of the seam divided by the length of the slit on the mesh. It is 0 if there is no
    /// slit, or if the slit is too short to divide by.
    pub seam_length_ratio: f64,
    /// The largest distance of a vertex of the seam from the plane.
    pub seam_deviation_max: f64,
    /// The largest distance of a vertex of the seam from the plane, divided by the mean edge length
    /// of the mesh before the cut.
    pub seam_deviation_max_edges: f64,
    /// The number of vertices inserted on edges and in faces.
    pub vertices_inserted: usize,
    /// The smallest altitude of any face after the cut, or 0 for a mesh without faces.
    pub altitude_min: f64,
    /// Whether the slit meets no face.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub missed: bool,
    /// The distance of the vertex closest to the slit before the cut: √(p² + s²), where p is the
    /// distance from the plane and s is the distance by which the vertex lies outside the side planes.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub nearest_vertex: f64,
    /// The distance of each tip of the seam beyond the nearer side plane. It is negative for a tip
    /// that stops short of that plane. A tip is an end of the seam inside the mesh. The list is in
    /// ascending order of the tips' vertices, and empty for a cut along the whole plane.
    pub tip_overshoots: Vec<f64>,
    /// How near the seam comes to the points at which the two rays are aimed. An entry is `None` if its
    /// ray does not meet the mesh, or if nothing was split. `None` for a cut along the whole plane.
    pub aims: Option<[Option<CutAim>; 2]>,
}

/// The mesh before a cut, as the slit sees it.
pub(super) struct CutMeasurer<'w> {
    context: &'w CutContext<'w>,
    aims: Aims,
    counts: PieceCounts,
    /// The faces that the slit meets, ascending.
    slit: Vec<FaceId>,
    slit_length: f64,
    pinches: Vec<Pinch>,
    survey: Survey,
    /// What is known before the cut.
    report: CutReport,
}

impl<'w> CutMeasurer<'w> {
    /// `trace` is that of a method that decides where the slit runs before it cuts.
    pub(super) fn new(
        context: &'w CutContext<'w>,
        aims: Aims,
        mesh: &Mesh,
        positions: &Positions,
        trace: Option<&Trace>,
    ) -> CutMeasurer<'w> {
        let mut touched = context.offsets.touched().to_vec();
        let joints = context.joints.iter().flatten();
        touched.extend(joints.flat_map(|&v| mesh.faces_of(v)));
        let counts = PieceCounts::new(mesh, &touched);
        let mut measurer = CutMeasurer {
            context,
            aims,
            slit: Vec::new(),
            slit_length: 0.0,
            pinches: Vec::new(),
            survey: Survey::new(mesh, positions, |f| counts.is_far(f)),
            report: CutReport {
                pieces_before: counts.count(mesh),
                nearest_vertex: nearest_vertex(context, mesh, positions),
                ..CutReport::default()
            },
            counts,
        };
        measurer.follow_slit(mesh, positions);
        (measurer.report.pieces_expected, measurer.pinches) = match trace {
            Some(trace) => {
                exact::pieces_expected(context, trace, &measurer.counts, mesh, positions)
            }
            None => (measurer.pieces_expected(mesh, positions), Vec::new()),
        };
        measurer
    }

    /// Measures the slit: where the plane runs between the side planes.
    fn follow_slit(&mut self, mesh: &Mesh, positions: &Positions) {
        let among = self.context.among;
        for &f in among {
            let crossing = self.crossing(mesh, positions, f);
            if let Some(length) = crossing.and_then(|ends| self.length_inside(ends)) {
                self.report.faces_crossed += 1;
                self.slit.push(f);
                self.slit_length += length;
            }
        }
        for h in among.iter().flat_map(|f| f.half_edges()) {
            if mesh.pair(h).is_some_and(|pair| h < pair)
                && let Some(faces) = self.faces_apart(mesh, h)
                && let Some(length) = self.length_inside(ends_of(mesh, positions, h))
            {
                self.slit.extend(faces);
                self.slit_length += length;
            }
        }
        self.slit.sort_unstable();
        self.slit.dedup();
    }

    /// The length of a segment inside the strip; `None` if it lies outside.
    fn length_inside(&self, [p, q]: [Point; 2]) -> Option<f64> {
        let (from, to) = self
            .context
            .strip
            .clip(p, q, self.context.offsets.bound())?;
        Some((to - from) * length(q - p))
    }

    /// The faces of an edge on the plane that lie on different sides, and are slit apart there.
    fn faces_apart(&self, mesh: &Mesh, h: HalfEdgeId) -> Option<[FaceId; 2]> {
        let faces = [h, mesh.pair(h)?].map(HalfEdgeId::face);
        let ends = [mesh.origin(h), mesh.target(h)];
        let on_plane = ends.map(|v| self.context.offsets.of(v)) == [0.0; 2];
        let [one, other] = faces.map(|f| self.lone_side(mesh, f));
        (on_plane && one != other).then_some(faces)
    }

    /// The pieces that a cut leaves which divides every face that the slit crosses.
    fn pieces_expected(&self, mesh: &Mesh, positions: &Positions) -> usize {
        let is_met = |f: FaceId| self.slit.binary_search(&f).is_ok();
        let bound = self.context.offsets.bound();
        let is_whole =
            |[p, q]: [Point; 2]| self.context.strip.clip(p, q, bound) == Some((0.0, 1.0));
        let is_slit =
            |f: FaceId| is_met(f) && self.crossing(mesh, positions, f).is_some_and(is_whole);
        let is_slit_along = |h: HalfEdgeId| {
            self.faces_apart(mesh, h)
                .is_some_and(|faces| faces.into_iter().all(is_met))
                && is_whole(ends_of(mesh, positions, h))
        };
        let sign = |v| self.context.offsets.of(v);
        let counts = &self.counts;
        let (pieces, _) = counts.expected(mesh, sign, is_slit, is_slit_along, |_| 0.0);
        pieces
    }

    /// The faces that the slit meets and the children of those, once they are inserted; ascending.
    fn slit_now(&self, edits: &Edits, first_edit: Cursor) -> Vec<FaceId> {
        let mut slit = self.slit.clone();
        for edit in edits.since(first_edit) {
            if let Edit::Insert(insert) = edit {
                let is_new = |child: &&ChildFace| {
                    child.face != child.parent && self.slit.binary_search(&child.parent).is_ok()
                };
                slit.extend(
                    insert
                        .children
                        .iter()
                        .filter(is_new)
                        .map(|child| child.face),
                );
            }
        }
        slit.sort_unstable();
        slit
    }

    /// The faces whose sides a report asks for.
    pub(super) fn judged(&self, mesh: &Mesh, edits: &Edits, first_edit: Cursor) -> Vec<FaceId> {
        self.counts.round(mesh, &self.slit_now(edits, first_edit))
    }

    /// The side of a face that is not crossed; one that lies on the plane is in front.
    fn lone_side(&self, mesh: &Mesh, f: FaceId) -> Side {
        let offsets = mesh.face_vertices(f).map(|v| self.context.offsets.of(v));
        Side::of(offsets.into_iter().fold(0.0, f64::min))
    }

    /// Where the plane enters and leaves a crossed face: at a vertex, or on an edge.
    fn crossing(&self, mesh: &Mesh, positions: &Positions, f: FaceId) -> Option<[Point; 2]> {
        if !self.context.offsets.cross(mesh, f) {
            return None;
        }
        let point = |h: HalfEdgeId| {
            let (a, b) = (mesh.origin(h), mesh.target(h));
            if self.context.offsets.of(a) == 0.0 {
                return Some(positions.at(a));
            }
            // From the smaller vertex, so that both faces of the edge agree on the point.
            let [a, b] = [a.min(b), a.max(b)];
            let [p, q] = [a, b].map(|v| positions.at(v));
            let [a, b] = [a, b].map(|v| self.context.offsets.of(v));
            let is_between = (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0);
            is_between.then(|| p + (q - p) * (a.abs() / (a.abs() + b.abs())))
        };
        let mut ends = f.half_edges().into_iter().filter_map(point);
        Some([ends.next()?, ends.next()?])
    }

    /// Compares with the mesh after the cut. `outcome` is the method's, and the
    /// records from `first_edit` on are those of the cut.
    pub(super) fn report(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        outcome: &CutResult,
        edits: &Edits,
        first_edit: Cursor,
    ) -> CutReport {
        let nodes = Nodes::new(edits, first_edit, self.context.offsets.len());
        let (mut ends, mut torn): (Vec<VertexId>, Vec<HalfEdgeId>) = Default::default();
        let (pieces, expected) = (self.counts.count(mesh), self.report.pieces_expected);
        let mut splits = 0;
        let mut vertices_inserted = 0;
        let mut seam_length = 0.0;
        let mut seam_deviation_max = 0.0f64;
        for edit in edits.since(first_edit) {
            match edit {
                Edit::Split(split) => {
                    splits += 1;
                    for link in split.torn {
                        let at = ends_of(mesh, positions, link.stayed);
                        seam_length += length(at[1] - at[0]);
                        for end in at {
                            let deviation = self.context.strip.plane.distance(end).abs();
                            seam_deviation_max = seam_deviation_max.max(deviation);
                        }
                        ends.extend(nodes.of_edge(mesh, link.stayed));
                        torn.push(link.stayed);
                    }
                }
                Edit::Insert(insert) => vertices_inserted += insert.points.len(),
                Edit::Merge(_) | Edit::Slide(_) => {}
            }
        }
        torn.sort_unstable();
        // A slit that only grazes a corner may be so short that the quotient is infinite.
        let ratio = |a: f64, b: f64| match a / b {
            ratio if ratio.is_finite() => ratio,
            _ => 0.0,
        };
        CutReport {
            splits,
            refused: outcome.refused,
            ghost_pairs: ends.len(),
            pieces,
            crumbs: pieces.saturating_sub(expected),
            lost: expected.saturating_sub(pieces),
            necks: {
                let copies = |of: &[VertexId]| with_copies(of.to_vec(), edits, first_edit);
                neck::severed(
                    &self.pinches,
                    copies,
                    self.context,
                    (mesh, positions),
                    outcome,
                )
            },
            separated: {
                let slit = self.slit_now(edits, first_edit);
                self.separated(mesh, positions, &slit, outcome)
            },
            seam_length,
            seam_length_ratio: ratio(seam_length, self.slit_length),
            seam_deviation_max,
            seam_deviation_max_edges: ratio(seam_deviation_max, self.survey.mean_edge),
            vertices_inserted,
            altitude_min: {
                let near = self.counts.near_now(mesh);
                self.survey.altitude_min(mesh, positions, near)
            },
            missed: self.slit.is_empty(),
            tip_overshoots: self.overshoots(mesh, positions, ends),
            aims: {
                let plane = &self.context.strip.plane;
                let compare = |aim: Aim| {
                    aim.compare(plane, &torn, mesh, positions)
                        .filter(|_| !torn.is_empty())
                };
                self.aims.map(|aims| aims.map(|aim| aim.and_then(compare)))
            },
            ..self.report.clone()
        }
    }

    /// Of each vertex with one edge of the seam that has not been split: how far beyond the
    /// nearer side plane it is. `ends` are those of all edges of the seam, as before any was split.
    fn overshoots(&self, mesh: &Mesh, positions: &Positions, mut ends: Vec<VertexId>) -> Vec<f64> {
        let Some(sides) = self.context.strip.bounds() else {
            return Vec::new();
        };
        ends.sort_unstable();
        let ends = ends.chunk_by(|a, b| a == b);
        let tips = ends
            .filter(|of_vertex| of_vertex.len() == 1)
            .map(|one| one[0]);
        let joined = |&v: &VertexId| mesh.copies(v).all(|copy| copy == v);
        let depth = |v: VertexId| {
            let depths = sides.map(|side| side.distance(positions.at(v)));
            depths[0].min(depths[1])
        };
        tips.filter(joined).map(|v| -depth(v)).collect()
    }

    /// Whether both sides share no vertex and no edge where the slit was; see
    /// [`CutReport::separated`].
    fn separated(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        slit: &[FaceId],
        outcome: &CutResult,
    ) -> bool {
        let (strip, bound) = (self.context.strip, self.context.offsets.bound());
        // `tip_overshoots` tells of tips.
        // Beside what leaves the plane, its sides are not those of the seam.
        let mut unjudged: Vec<VertexId> = outcome.ends.concat();
        unjudged.extend(&outcome.off_plane);
        unjudged.sort_unstable();
        let is_tip = |v: VertexId| unjudged.binary_search(&v).is_ok();
        let label = |h: HalfEdgeId| side_of(&outcome.judged, h.face());
        // By vertex, a bit for each side on which it has a face: a walk round each vertex would cost a
        // hub the square of its faces.
        let mut sides_of = vec![0u8; mesh.vertex_count()];
        for &(f, side) in &outcome.judged {
            let bit = side.map_or(0, |side| 1 << side as u8);
            for v in mesh.face_vertices(f) {
                sides_of[v.index()] |= bit;
            }
        }
        let shared_vertex = |v: VertexId| {
            sides_of[v.index()] == 0b11 && !is_tip(v) && strip.depth(positions.at(v), bound) > 0.0
        };
        let shared_edge = |h: HalfEdgeId| {
            let Some(pair) = mesh.pair(h) else {
                return false;
            };
            let sides = label(h).zip(label(pair));
            let differ = sides.is_some_and(|(one, other)| one != other);
            // From the smaller, so that it does not matter which of the two was asked.
            let [p, q] = ends_of(mesh, positions, h.min(pair));
            let inside = |(from, to): (f64, f64)| {
                let middle = (from + to) / 2.0;
                from < to && strip.depth(p + (q - p) * middle, bound) > 0.0
            };
            differ
                && !is_tip(mesh.origin(h))
                && !is_tip(mesh.target(h))
                && strip.clip(p, q, bound).is_some_and(inside)
        };
        let mut corners = slit.iter().flat_map(|f| f.half_edges());
        !corners.any(|h| shared_vertex(mesh.origin(h)) || shared_edge(h))
    }
}

fn ends_of(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> [Point; 2] {
    [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v))
}

/// How far the vertex nearest to the slit is from it.
fn nearest_vertex(context: &CutContext<'_>, mesh: &Mesh, positions: &Positions) -> f64 {
    let (plane, bounds) = (&context.strip.plane, context.strip.bounds());
    let mut least = f64::INFINITY;
    for (v, offset) in mesh.vertices().zip(context.offsets.all()) {
        let off = offset / plane.offset_of_unit();
        // What is added to a square makes it no smaller, and the root keeps their order.
        if off * off >= least || mesh.half_edge_of(v).is_none() {
            continue;
        }
        let outside = bounds.map_or(0.0, |sides| {
            let [a, b] = sides.map(|side| -side.distance(positions.at(v)));
            a.max(b).max(0.0)
        });
        least = least.min(off * off + outside * outside);
    }
    least.sqrt()
}
