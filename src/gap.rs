//! A gap between the sides of a cut, so that it can be seen, and so that programs that merge coincident points
//! leave it open.

use std::collections::BTreeMap;

use crate::geometry::{Point, Vector};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Components, Mesh};
use crate::place::Positions;

/// How far apart the sides of cuts are: the report of [`gapped`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Gapped {
    /// The gap that was asked for.
    pub length: f64,
    /// The number of vertices that moved.
    pub vertices_moved: usize,
    /// The number of vertices that moved by less than half the gap, so that no face flips.
    pub vertices_clamped: usize,
    /// The number of pieces that moved rigidly.
    pub pieces_moved: usize,
    /// The number of vertices on cut sides that moved within their piece.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub side_vertices: usize,
}

/// How often the way of a vertex is halved before the vertex stays in place.
const HALVINGS: u32 = 40;

/// The least part of its area that a face keeps.
const AREA_MIN: f64 = 0.1;

/// The least straightness of a seam whose pieces move rigidly: the length of the sum of its normals
/// over its length. A seam around a piece has 0.
const STRAIGHTNESS_MIN: f64 = 0.5;

/// The least part of the gap between two pieces of a group that moves rigidly: where three pieces
/// meet, the shifts that any two of them need can differ.
const GAP_MIN: f64 = 0.9;

/// Moves everything that is torn `gap` apart, and returns the new position of each vertex. The mesh and its
/// positions stay as they are.
///
/// Two pieces that a seam separates move rigidly, each by half the gap. Where both sides of a seam
/// are of one piece (a slit), or the seam goes around a piece, the vertices of each side move by
/// half the gap within the surface: square to the side, or along the boundary where the side ends
/// at it. A vertex of both sides, such as the tip of a slit, stays in place. Where a face would
/// flip or lose nearly all of its area, the ways of its vertices are halved until it does not.
/// Takes linear time: only the faces around such vertices are tested again, and each vertex has at most
/// forty halvings.
///
/// ```
/// use tearmesh::{gap, shapes, CutMethod, Edits, Plane, Point, Scissor, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::x())?;
/// let mut edits = Edits::new();
/// Scissor::by_plane(plane).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
/// let (report, points) = gap::gapped(&mesh, &positions, 0.1);
/// assert_eq!((report.pieces_moved, points.len()), (2, mesh.vertex_count()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn gapped(mesh: &Mesh, positions: &Positions, gap: f64) -> (Gapped, Vec<Point>) {
    let pieces = Pieces::new(mesh, positions);
    let away = directions(mesh, positions, &pieces);
    let wanted = gap / 2.0;
    let lengths = mesh.edges().map(|h| edge(mesh, positions, h).norm());
    let far = wanted.min(lengths.fold(0.0, f64::max));
    let mut halvings = vec![0_u32; away.len()];
    let at = |v: VertexId, halvings: &[u32]| {
        let part = match halvings[v.index()] {
            HALVINGS => 0.0,
            times => (0..times).fold(far, |far, _| far / 2.0),
        };
        away[v.index()].map_or(positions.at(v), |away| positions.at(v) + away * part)
    };
    let moves = |v: VertexId| away[v.index()].is_some();
    let mut untested: Vec<FaceId> = mesh.faces().collect();
    while !untested.is_empty() {
        let is_spoiled = |f: &FaceId| {
            let corners = mesh.face_vertices(*f);
            let before = normal(corners.map(|v| positions.at(v)));
            let after = normal(corners.map(|v| at(v, &halvings)));
            let keeps_area = before.dot(&after) >= AREA_MIN * before.norm_squared();
            !keeps_area
        };
        let spoiled = untested.into_iter().filter(is_spoiled);
        let corners = spoiled.flat_map(|f| mesh.face_vertices(f));
        let can_halve = |v: &VertexId| moves(*v) && halvings[v.index()] < HALVINGS;
        let mut halved: Vec<VertexId> = corners.filter(can_halve).collect();
        halved.sort_unstable();
        halved.dedup();
        for v in &halved {
            halvings[v.index()] += 1;
        }
        // A face that was not spoiled may be now.
        untested = halved.iter().flat_map(|&v| mesh.faces_of(v)).collect();
        untested.sort_unstable();
        untested.dedup();
    }
    let with_piece = |v: VertexId| match pieces.shift(mesh, v).filter(|_| gap > 0.0) {
        Some(shift) => at(v, &halvings) + shift * gap,
        None => at(v, &halvings),
    };
    let points: Vec<Point> = mesh.vertices().map(with_piece).collect();
    let is_less = |v: &VertexId| moves(*v) && (halvings[v.index()] > 0 || far < wanted);
    let is_apart = |v: &VertexId| points[v.index()] != positions.at(*v);
    let shifts = pieces.shifts.iter().flatten();
    let gapped = Gapped {
        length: gap,
        vertices_moved: mesh.vertices().filter(is_apart).count(),
        vertices_clamped: mesh.vertices().filter(is_less).count(),
        pieces_moved: shifts.filter(|_| gap > 0.0).count(),
        side_vertices: away.iter().flatten().count(),
    };
    (gapped, points)
}

/// The pieces of a mesh, and how they move.
struct Pieces {
    of: Components,
    /// For each piece that moves rigidly, how far it moves, in gaps.
    shifts: Vec<Option<Vector>>,
}

impl Pieces {
    fn new(mesh: &Mesh, positions: &Positions) -> Pieces {
        let of = mesh.components();
        let mut is_stuck = vec![false; of.count()];
        let mut of_vertex: Vec<Option<usize>> = vec![None; mesh.vertex_count()];
        // For two pieces, the sum of the normals of their seam, from the lower to the higher, and
        // its length.
        let mut seams: BTreeMap<[usize; 2], (Vector, f64)> = BTreeMap::new();
        for h in mesh.half_edges() {
            let piece = of.of(h.face());
            let known = *of_vertex[mesh.origin(h).index()].get_or_insert(piece);
            if known != piece {
                // They share a vertex.
                (is_stuck[piece], is_stuck[known]) = (true, true);
            }
            let across = mesh.ghost_pair(h).map(|across| of.of(across.face()));
            let Some(across) = across.filter(|&across| across != piece) else {
                continue;
            };
            let edge_m = edge(mesh, positions, h).norm();
            let normal = inward(mesh, positions, h) * edge_m;
            let seam = seams.entry([piece.min(across), piece.max(across)]);
            let (sum, length) = seam.or_insert((Vector::zeros(), 0.0));
            *sum += if piece > across { normal } else { -normal };
            *length += edge_m;
        }
        let mut beside: Vec<Vec<(usize, Vector)>> = vec![Vec::new(); of.count()];
        for (&[one, other], &(sum, length)) in &seams {
            if sum.norm() < STRAIGHTNESS_MIN * length || length == 0.0 {
                is_stuck[one] = true;
            }
            beside[one].push((other, unit(sum)));
            beside[other].push((one, -unit(sum)));
        }
        let mut pieces = Pieces {
            shifts: vec![None; of.count()],
            of,
        };
        let mut is_seen = vec![false; beside.len()];
        for first in 0..beside.len() {
            if !is_seen[first] && !beside[first].is_empty() {
                pieces.shift_group(first, &beside, &is_stuck, &mut is_seen);
            }
        }
        pieces
    }

    /// Shifts all pieces that are connected with `first` by seams, unless one of them cannot move
    /// rigidly.
    fn shift_group(
        &mut self,
        first: usize,
        beside: &[Vec<(usize, Vector)>],
        is_stuck: &[bool],
        is_seen: &mut [bool],
    ) {
        let mut group = vec![first];
        self.shifts[first] = Some(Vector::zeros());
        is_seen[first] = true;
        let mut next = 0;
        while let Some(&piece) = group.get(next) {
            next += 1;
            let shift = self.shifts[piece].expect("it was reached");
            for &(other, way) in &beside[piece] {
                if !std::mem::replace(&mut is_seen[other], true) {
                    self.shifts[other] = Some(shift + way);
                    group.push(other);
                }
            }
        }
        let at = |piece: usize| self.shifts[piece].expect("it was reached");
        let is_apart = |&piece: &usize| {
            let mut ways = beside[piece].iter();
            !is_stuck[piece]
                && ways.all(|&(other, way)| (at(other) - at(piece)).dot(&way) >= GAP_MIN)
        };
        let all_are_apart = group.iter().all(is_apart);
        let sum: Vector = group.iter().map(|&piece| at(piece)).sum();
        let middle = sum / group.len() as f64;
        for piece in group {
            let shift = &mut self.shifts[piece];
            *shift = shift.filter(|_| all_are_apart).map(|shift| shift - middle);
        }
    }

    /// How far a vertex moves with its piece, in gaps.
    fn shift(&self, mesh: &Mesh, v: VertexId) -> Option<Vector> {
        self.shifts[self.of.of(mesh.half_edge_of(v)?.face())]
    }

    /// The other side of a torn edge, unless its piece and this one move apart rigidly.
    fn across(&self, mesh: &Mesh, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let across = mesh.ghost_pair(h)?;
        let [one, other] = [h, across].map(|h| self.of.of(h.face()));
        (one == other || self.shifts[one].is_none()).then_some(across)
    }
}

/// The direction in which each vertex moves away from the other side of its slit, if it does.
fn directions(mesh: &Mesh, positions: &Positions, pieces: &Pieces) -> Vec<Option<Vector>> {
    let mut away = vec![Vector::zeros(); mesh.vertex_count()];
    let mut is_side = vec![false; away.len()];
    let mut is_shared = vec![false; away.len()];
    for h in mesh.half_edges() {
        let Some(other) = pieces.across(mesh, h) else {
            continue;
        };
        let inward = inward(mesh, positions, h);
        for (v, across) in [
            (mesh.origin(h), mesh.target(other)),
            (mesh.target(h), mesh.origin(other)),
        ] {
            away[v.index()] += inward;
            is_side[v.index()] = true;
            is_shared[v.index()] |= v == across;
        }
    }
    // A side ends at the boundary that was there before the cut, or at another piece.
    let mut along = vec![Vector::zeros(); away.len()];
    let is_end = |h: &HalfEdgeId| mesh.pair(*h).is_none() && pieces.across(mesh, *h).is_none();
    for h in mesh.half_edges().filter(is_end) {
        let [a, b] = [mesh.origin(h), mesh.target(h)];
        let edge = edge(mesh, positions, h);
        for (v, edge) in [(a, edge), (b, -edge)] {
            if is_side[v.index()] {
                along[v.index()] += unit(edge);
            }
        }
    }
    let direction = |v: usize| {
        let (at_end, square) = (unit(along[v]), unit(away[v]));
        let is_at_end = at_end != Vector::zeros();
        let direction = if is_at_end { at_end } else { square };
        (is_side[v] && !is_shared[v] && direction != Vector::zeros()).then_some(direction)
    };
    (0..away.len()).map(direction).collect()
}

/// The way along a half-edge.
fn edge(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> Vector {
    positions.at(mesh.target(h)) - positions.at(mesh.origin(h))
}

/// The unit vector in the plane of a face, square to one of its edges and pointing inward.
fn inward(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> Vector {
    let [a, b, c] = [h, h.next(), h.prev()].map(|h| positions.at(mesh.origin(h)));
    let edge = unit(b - a);
    unit(unit(edge.cross(&(c - a))).cross(&edge))
}

/// The unit vector in this direction; zero for zero.
fn unit(v: Vector) -> Vector {
    let scaled = v / v.amax();
    match v.amax() > 0.0 {
        true => scaled / scaled.norm(),
        false => Vector::zeros(),
    }
}

/// Twice the area of a triangle, along its normal.
fn normal([a, b, c]: [Point; 3]) -> Vector {
    (b - a).cross(&(c - a))
}
