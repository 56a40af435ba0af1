//! What a cut should do, and what it did.
//!
//! A [`Survey`] looks at the mesh before a cut: where the slit (the part of the plane
//! between the side planes) meets it, how long it is there, and into how many pieces an ideal
//! cut would divide it. The [`CutReport`] compares that with the mesh after the cut.
//! Nothing is denied: loose crumbs, pieces that stayed together and vertices that both sides
//! still share are counted.

use super::offsets::Offsets;
use super::outcome::{Ends, Outcome};
use super::pieces;
use super::strip::Strip;
use crate::edit::{Cursor, Edit, Edits};
use crate::geometry::{Point, Side, altitude, angle, cross, dot, length};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;

/// What a cut did.
///
/// A *component* is a set of faces joined by shared edges. The *seam* is the set of edges
/// that this cut tore. Lengths are in the units of the model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CutReport {
    /// The faces that the slit crosses.
    pub faces_crossed: usize,
    /// The vertices that were split, counted as often as they were.
    pub splits: usize,
    /// The splits that were refused for want of a face on one side.
    pub refused: usize,
    /// The half-edges whose pair became a ghost pair: two for each edge of the seam.
    pub ghost_pairs: usize,
    /// The components before the cut.
    pub pieces_before: usize,
    /// The components after the cut.
    pub pieces: usize,
    /// The components that a cut exactly along the slit would leave, or more where the method
    /// `exact` takes an end of the slit for a point of the boundary. What lies on the plane is in
    /// front, but for the method `exact`, to which touching is not cutting.
    pub pieces_expected: usize,
    /// Pieces beyond those expected.
    pub crumbs: usize,
    /// Pieces short of those expected.
    pub lost: usize,
    /// Whether no vertex strictly between the side planes belongs to faces of both sides, and
    /// no edge that passes there joins both; judged where the slit meets the mesh.
    pub separated: bool,
    /// The length of the seam.
    pub seam_length: f64,
    /// The length of the seam over that of the slit on the mesh; 0 where there is no slit, or
    /// one too short to divide by.
    pub seam_length_ratio: f64,
    /// The largest distance of a seam vertex from the plane.
    pub seam_deviation_max: f64,
    /// The same, over the mean edge length of the mesh before the cut.
    pub seam_deviation_max_edges: f64,
    /// The vertices inserted on edges and in faces.
    pub vertices_inserted: usize,
    /// The smallest angle of any face after the cut, in degrees.
    pub angle_min_deg: f64,
    /// The smallest altitude of any face after the cut.
    pub altitude_min: f64,
    /// Whether the slit meets no face at all.
    pub missed: bool,
    /// How far the vertex nearest to the slit is from it: the distance from the plane and
    /// that by which it lies outside the side planes, as the sides of a right angle.
    pub nearest_vertex: f64,
    /// How far each tip of the seam lies beyond the nearer side plane; negative for one that
    /// falls short. Ascending by vertex. A tip is an end of the seam inside the mesh.
    pub tip_overshoots: Vec<f64>,
    ends: Ends,
}

impl CutReport {
    /// The vertices at which the first side plane ended a cut of the method `exact`: there a
    /// polyline that began with it is closed ([`Scissor::closed`](super::Scissor::closed)).
    #[must_use]
    pub fn ends_at_first_ray(&self) -> &[VertexId] {
        &self.ends.0[0]
    }

    /// The vertices at which the second side plane ended a cut of the method `exact`: there
    /// the next cut of a polyline goes on.
    #[must_use]
    pub fn ends_at_second_ray(&self) -> &[VertexId] {
        &self.ends.0[1]
    }
}

/// The mesh before a cut, as the slit sees it.
pub(super) struct Survey<'o> {
    offsets: &'o Offsets,
    /// Whether the slit meets each face.
    in_slit: Vec<bool>,
    faces_crossed: usize,
    slit_length: f64,
    pieces_before: usize,
    pieces_expected: usize,
    mean_edge: f64,
    nearest_vertex: f64,
}

impl<'o> Survey<'o> {
    /// `pieces_expected` is for a method that decides where the slit runs before it cuts.
    pub(super) fn new(
        strip: &Strip,
        mesh: &Mesh,
        positions: &Positions,
        offsets: &'o Offsets,
        pieces_expected: Option<usize>,
    ) -> Survey<'o> {
        let mut survey = Survey {
            offsets,
            in_slit: vec![false; mesh.face_count()],
            faces_crossed: 0,
            slit_length: 0.0,
            pieces_before: mesh.components().count(),
            pieces_expected: 0,
            mean_edge: mean_edge(mesh, positions),
            nearest_vertex: nearest_vertex(strip, mesh, positions),
        };
        survey.follow_slit(strip, mesh, positions);
        survey.pieces_expected =
            pieces_expected.unwrap_or_else(|| survey.pieces_expected(strip, mesh, positions));
        survey
    }

    /// Measures the slit: where the plane runs between the side planes.
    fn follow_slit(&mut self, strip: &Strip, mesh: &Mesh, positions: &Positions) {
        for f in mesh.faces() {
            let crossing = self.crossing(mesh, positions, f);
            if let Some(length) = crossing.and_then(|ends| self.length_inside(strip, ends)) {
                self.faces_crossed += 1;
                self.in_slit[f.index()] = true;
                self.slit_length += length;
            }
        }
        for h in mesh.edges() {
            if let Some([f, g]) = self.faces_apart(mesh, h)
                && let Some(length) = self.length_inside(strip, ends_of(mesh, positions, h))
            {
                self.in_slit[f.index()] = true;
                self.in_slit[g.index()] = true;
                self.slit_length += length;
            }
        }
    }

    /// The length of a segment inside the strip; `None` if it lies outside.
    fn length_inside(&self, strip: &Strip, [p, q]: [Point; 2]) -> Option<f64> {
        let (from, to) = strip.clip(p, q, self.offsets.bound())?;
        Some((to - from) * length(q - p))
    }

    /// The faces of an edge on the plane that lie on different sides, and are slit apart there.
    fn faces_apart(&self, mesh: &Mesh, h: HalfEdgeId) -> Option<[FaceId; 2]> {
        let faces = [h, mesh.pair(h)?].map(HalfEdgeId::face);
        let on_plane = [mesh.origin(h), mesh.target(h)].map(|v| self.offsets.of(v)) == [0.0; 2];
        let [one, other] = faces.map(|f| self.lone_side(mesh, f));
        (on_plane && one != other).then_some(faces)
    }

    /// The pieces that a cut leaves which divides every face that the slit crosses.
    fn pieces_expected(&self, strip: &Strip, mesh: &Mesh, positions: &Positions) -> usize {
        let is_whole =
            |[p, q]: [Point; 2]| strip.clip(p, q, self.offsets.bound()) == Some((0.0, 1.0));
        pieces::expected(
            mesh,
            |v| self.offsets.of(v),
            |f| self.crossing(mesh, positions, f).is_some_and(is_whole),
            |h| self.faces_apart(mesh, h).is_some() && is_whole(ends_of(mesh, positions, h)),
        )
    }

    /// The side of a face that is not crossed; one that lies on the plane is in front.
    fn lone_side(&self, mesh: &Mesh, f: FaceId) -> Side {
        let offsets = mesh.face_vertices(f).map(|v| self.offsets.of(v));
        Side::of(offsets.into_iter().fold(0.0, f64::min))
    }

    /// Where the plane enters and leaves a crossed face: at a vertex, or on an edge.
    fn crossing(&self, mesh: &Mesh, positions: &Positions, f: FaceId) -> Option<[Point; 2]> {
        if !self.offsets.cross(mesh, f) {
            return None;
        }
        let mut ends = [Point::origin(); 2];
        let mut found = 0;
        for h in f.half_edges() {
            let (a, b) = (mesh.origin(h), mesh.target(h));
            let (da, db) = (self.offsets.of(a), self.offsets.of(b));
            let point = if da == 0.0 {
                positions.at(a)
            } else if (da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0) {
                // From the smaller vertex, so that both faces of the edge agree on the point.
                let (a, b, da, db) = if a < b {
                    (a, b, da, db)
                } else {
                    (b, a, db, da)
                };
                let (p, q) = (positions.at(a), positions.at(b));
                p + (q - p) * (da.abs() / (da.abs() + db.abs()))
            } else {
                continue;
            };
            ends[found] = point;
            found += 1;
        }
        debug_assert_eq!(
            found, 2,
            "a plane that crosses a triangle meets its outline twice"
        );
        Some(ends)
    }

    /// Compares with the mesh after the cut. `outcome` is the method's, and the
    /// records from `first_edit` on are those of the cut.
    pub(super) fn report(
        &self,
        strip: &Strip,
        mesh: &Mesh,
        positions: &Positions,
        outcome: Outcome,
        edits: &Edits,
        first_edit: Cursor,
    ) -> CutReport {
        let mut in_slit = self.in_slit.clone();
        let mut tips = Tips::default();
        let roots = mesh.all_roots();
        let pieces = mesh.components().count();
        let (angle_min_deg, altitude_min) = quality(mesh, positions);
        let mut splits = 0;
        let mut ghost_pairs = 0;
        let mut vertices_inserted = 0;
        let mut seam_length = 0.0;
        let mut seam_deviation_max = 0.0f64;
        for edit in edits.since(first_edit) {
            match edit {
                Edit::Split(split) => {
                    splits += 1;
                    for link in split.torn {
                        let h = link.stayed;
                        let [p, q] = [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
                        ghost_pairs += 2;
                        seam_length += length(q - p);
                        for end in [p, q] {
                            let deviation = strip.plane.distance(end).abs();
                            seam_deviation_max = seam_deviation_max.max(deviation);
                        }
                        tips.add([mesh.origin(h), mesh.target(h)].map(|v| roots[v.index()]));
                    }
                }
                Edit::Insert(insert) => {
                    vertices_inserted += insert.points.len();
                    // A child is where its parent was.
                    let children = insert.children.iter();
                    for child in children.filter(|child| child.face != child.parent) {
                        in_slit.push(in_slit[child.parent.index()]);
                    }
                }
                Edit::Merge(_) | Edit::Slide(_) => {}
            }
        }
        // A slit that only grazes a corner may be so short that the quotient is infinite.
        let ratio = |a: f64, b: f64| match a / b {
            ratio if b > 0.0 && ratio.is_finite() => ratio,
            _ => 0.0,
        };
        CutReport {
            faces_crossed: self.faces_crossed,
            splits,
            refused: outcome.refused,
            ghost_pairs,
            pieces_before: self.pieces_before,
            pieces,
            pieces_expected: self.pieces_expected,
            crumbs: pieces.saturating_sub(self.pieces_expected),
            lost: self.pieces_expected.saturating_sub(pieces),
            separated: separated(
                strip,
                self.offsets.bound(),
                mesh,
                positions,
                &in_slit,
                &outcome,
            ),
            seam_length,
            seam_length_ratio: ratio(seam_length, self.slit_length),
            seam_deviation_max,
            seam_deviation_max_edges: ratio(seam_deviation_max, self.mean_edge),
            vertices_inserted,
            angle_min_deg,
            altitude_min,
            missed: !self.in_slit.contains(&true),
            nearest_vertex: self.nearest_vertex,
            tip_overshoots: tips.overshoots(strip, mesh, positions),
            ends: outcome.ends,
        }
    }
}

/// The ends of a seam.
#[derive(Default)]
struct Tips {
    /// The roots of the ends of each edge of the seam.
    ends: Vec<VertexId>,
}

impl Tips {
    fn add(&mut self, roots: [VertexId; 2]) {
        self.ends.extend(roots);
    }

    /// Of each vertex with one edge of the seam that has not been split: how far beyond the
    /// nearer side plane it is.
    fn overshoots(mut self, strip: &Strip, mesh: &Mesh, positions: &Positions) -> Vec<f64> {
        if strip.through {
            return Vec::new();
        }
        self.ends.sort_unstable();
        let ends = self.ends.chunk_by(|a, b| a == b);
        let tips = ends
            .filter(|of_root| of_root.len() == 1)
            .map(|of_root| of_root[0]);
        let joined = |&root: &VertexId| mesh.copies(root).all(|v| v == root);
        let depth = |root: VertexId| {
            let depths = strip.sides.map(|side| side.distance(positions.at(root)));
            depths[0].min(depths[1])
        };
        tips.filter(joined).map(|root| -depth(root)).collect()
    }
}

fn separated(
    strip: &Strip,
    bound: f64,
    mesh: &Mesh,
    positions: &Positions,
    in_slit: &[bool],
    outcome: &Outcome,
) -> bool {
    let Outcome {
        labels,
        ends: Ends(ends),
        off_plane,
        ..
    } = outcome;
    // `tip_overshoots` tells of tips.
    // Beside what leaves the plane, its sides are not those of the seam.
    let mut unjudged: Vec<VertexId> = ends.concat();
    unjudged.extend(off_plane);
    unjudged.sort_unstable();
    let is_tip = |v: VertexId| unjudged.binary_search(&v).is_ok();
    let label = |h: HalfEdgeId| labels[h.face().index()];
    // A walk round each vertex would cost a hub the square of its faces.
    let mut has = vec![[false; 2]; mesh.vertex_count()];
    for h in mesh.half_edges() {
        if let Some(side) = label(h) {
            has[mesh.origin(h).index()][side as usize] = true;
        }
    }
    let shared_vertex = |v: VertexId| {
        has[v.index()] == [true; 2] && !is_tip(v) && strip.depth(positions.at(v), bound) > 0.0
    };
    let shared_edge = |h: HalfEdgeId| {
        let Some(pair) = mesh.pair(h) else {
            return false;
        };
        // From the smaller, so that it does not matter which of the two was asked.
        let h_min = h.min(pair);
        let [p, q] = [mesh.origin(h_min), mesh.target(h_min)].map(|v| positions.at(v));
        let inside = |(from, to): (f64, f64)| {
            let middle = (from + to) / 2.0;
            from < to && strip.depth(p + (q - p) * middle, bound) > 0.0
        };
        let differ = label(h)
            .zip(label(pair))
            .is_some_and(|(one, other)| one != other);
        differ
            && !is_tip(mesh.origin(h))
            && !is_tip(mesh.target(h))
            && strip.clip(p, q, bound).is_some_and(inside)
    };
    let faces = mesh.faces().filter(|f| in_slit[f.index()]);
    let mut corners = faces.flat_map(FaceId::half_edges);
    !corners.any(|h| shared_vertex(mesh.origin(h)) || shared_edge(h))
}

fn ends_of(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> [Point; 2] {
    [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v))
}

fn mean_edge(mesh: &Mesh, positions: &Positions) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for h in mesh.edges() {
        sum += length(positions.at(mesh.target(h)) - positions.at(mesh.origin(h)));
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

fn nearest_vertex(strip: &Strip, mesh: &Mesh, positions: &Positions) -> f64 {
    let [a, b] = strip.sides;
    let distance = |v: VertexId| {
        let p = positions.at(v);
        let off = strip.plane.distance(p);
        let outside = if strip.through {
            0.0
        } else {
            (-a.distance(p)).max(-b.distance(p)).max(0.0)
        };
        (off * off + outside * outside).sqrt()
    };
    let used = mesh.vertices().filter(|&v| mesh.half_edge_of(v).is_some());
    used.map(distance).fold(f64::INFINITY, f64::min)
}

/// The smallest angle in degrees and the smallest altitude of any face; zeros for a
/// mesh without faces.
fn quality(mesh: &Mesh, positions: &Positions) -> (f64, f64) {
    // The smallest angle has the largest cotangent, which needs no arc function.
    let mut cotangent_max = (f64::NEG_INFINITY, (0.0, 0.0));
    let mut altitude_min = f64::INFINITY;
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        let sides = [b - a, c - b, a - c];
        altitude_min = altitude_min.min(altitude([a, b, c]));
        for (one, other) in [(0, 2), (1, 0), (2, 1)] {
            let along = dot(sides[one], -sides[other]);
            let across = length(cross(sides[one], -sides[other]));
            let cotangent = if across > 0.0 {
                along / across
            } else if along >= 0.0 {
                f64::INFINITY
            } else {
                f64::NEG_INFINITY
            };
            if cotangent > cotangent_max.0 {
                cotangent_max = (cotangent, (along, across));
            }
        }
    }
    if altitude_min == f64::INFINITY {
        return (0.0, 0.0);
    }
    let (along, across) = cotangent_max.1;
    (
        angle(along, across) * (180.0 / std::f64::consts::PI),
        altitude_min,
    )
}
