//! Pieces, and the lips of slits, apart from each other: for the eye, and for programs that join what lies at one
//! place.

use std::collections::BTreeMap;

use tearmesh::{Components, FaceId, HalfEdgeId, Mesh, Point, Positions, Vector, VertexId};

use crate::measure::Edges;

/// Where vertices are shown.
pub(crate) struct Gapped {
    pub(crate) points: Vec<Point>,
    /// How many are shown apart from where they are, and how many of these by less than was asked for.
    pub(crate) moved: usize,
    pub(crate) clamped: usize,
    /// How many pieces are moved as a whole.
    pub(crate) pieces: usize,
    /// How many vertices of lips move within their piece.
    pub(crate) lips: usize,
}

/// How often a vertex is brought half way back before it is left where it is.
const HALVINGS: u32 = 40;

/// What is left of a face at least, by area.
const LEAST: f64 = 0.1;

/// What is left of the length of a seam at least, added up square to it, where its two pieces move as a
/// whole: one that goes round a piece leaves nothing.
const STRAIGHT: f64 = 0.5;

/// What is left of a gap at least where pieces round a vertex move by what each two of them need.
const AGREED: f64 = 0.9;

/// Moves everything that is torn `gap` apart. Pieces that part wholly move as they are, each by half of
/// it. Where both lips are of one piece, or the seam goes round a piece, each lip moves by half of it:
/// within the surface, square to the lip, and along the boundary where the lip ends there. A vertex that both lips
/// share, as the tip of a slit, stays; so the gap opens over one edge. Where a face would turn over, or
/// lose nearly all of its area, its vertices are brought back by halves. Linear: a vertex is brought back
/// so often at most, and then only its own faces are looked at again.
pub(crate) fn gapped(mesh: &Mesh, positions: &Positions, gap: f64) -> Gapped {
    let pieces = Pieces::new(mesh, positions);
    let away = directions(mesh, positions, &pieces);
    let wanted = gap / 2.0;
    let far = wanted.min(Edges::of(mesh, positions).longest);
    let mut halvings = vec![0_u32; away.len()];
    let at = |v: VertexId, halvings: &[u32]| {
        let part = match halvings[v.index()] {
            HALVINGS => 0.0,
            times => far * 0.5_f64.powi(times as i32),
        };
        away[v.index()].map_or(positions.at(v), |away| positions.at(v) + away * part)
    };
    let moves = |v: VertexId| away[v.index()].is_some();
    let moving = mesh
        .faces()
        .filter(|&f| mesh.face_vertices(f).into_iter().any(moves));
    let mut left: Vec<FaceId> = moving.collect();
    let mut faces_of = vec![Vec::new(); away.len()];
    for &f in &left {
        for v in mesh.face_vertices(f).into_iter().filter(|&v| moves(v)) {
            faces_of[v.index()].push(f);
        }
    }
    // Each round brings a vertex back, which can be done so often.
    loop {
        let mut back = Vec::new();
        for &f in &left {
            let corners = mesh.face_vertices(f);
            let before = normal(corners.map(|v| positions.at(v)));
            let after = normal(corners.map(|v| at(v, &halvings)));
            let keeps = before.dot(&after) >= LEAST * before.norm_squared();
            let mut moved = corners
                .into_iter()
                .filter(|&v| moves(v) && halvings[v.index()] < HALVINGS);
            if !keeps && moved.clone().next().is_some() {
                back.extend(moved.by_ref());
            }
        }
        if back.is_empty() {
            break;
        }
        back.sort();
        back.dedup();
        for &v in &back {
            halvings[v.index()] += 1;
        }
        // A face that keeps its shape may lose it when a neighbour is brought back.
        left.clear();
        left.extend(back.iter().flat_map(|v| &faces_of[v.index()]));
        left.sort_unstable();
        left.dedup();
    }
    let with_piece = |v: VertexId| match pieces.shift(mesh, v).filter(|_| gap > 0.0) {
        Some(shift) => at(v, &halvings) + shift * gap,
        None => at(v, &halvings),
    };
    let points: Vec<Point> = mesh.vertices().map(with_piece).collect();
    let is_less = |v: &VertexId| moves(*v) && (halvings[v.index()] > 0 || far < wanted);
    let is_apart = |v: &VertexId| points[v.index()] != positions.at(*v);
    Gapped {
        moved: mesh.vertices().filter(is_apart).count(),
        clamped: mesh.vertices().filter(is_less).count(),
        pieces: match gap > 0.0 {
            true => pieces.shifts.iter().flatten().count(),
            false => 0,
        },
        lips: mesh.vertices().filter(|&v| moves(v)).count(),
        points,
    }
}

/// The pieces of a mesh, and how they part.
struct Pieces {
    of: Components,
    /// By how much of the gap each piece moves as a whole, if it does.
    shifts: Vec<Option<Vector>>,
}

impl Pieces {
    fn new(mesh: &Mesh, positions: &Positions) -> Pieces {
        let of = mesh.components();
        let mut is_stuck = vec![false; of.count()];
        let mut of_vertex: Vec<Option<usize>> = vec![None; mesh.vertex_count()];
        // Between two pieces: the way from the first to the second, and the length of their seam.
        let mut seams: BTreeMap<[usize; 2], (Vector, f64)> = BTreeMap::new();
        for h in mesh.half_edges() {
            let piece = of.of(h.face());
            let known = *of_vertex[mesh.origin(h).index()].get_or_insert(piece);
            if known != piece {
                is_stuck[piece] = true;
                is_stuck[known] = true;
            }
            let Some(across) = mesh.ghost_pair(h).map(|across| of.of(across.face())) else {
                continue;
            };
            let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
            let away = inward(mesh, positions, h) * (b - a).norm();
            if across != piece {
                let seam = seams.entry([piece.min(across), piece.max(across)]);
                let (way, length) = seam.or_insert((Vector::zeros(), 0.0));
                *way += if piece > across { away } else { -away };
                *length += (b - a).norm();
            }
        }
        let mut beside: Vec<Vec<(usize, Vector)>> = vec![Vec::new(); of.count()];
        for (&[one, other], &(way, length)) in &seams {
            if way.norm() < STRAIGHT * length || length == 0.0 {
                is_stuck[one] = true;
            }
            beside[one].push((other, unit(way)));
            beside[other].push((one, -unit(way)));
        }
        let mut pieces = Pieces {
            shifts: vec![None; of.count()],
            of,
        };
        let mut is_seen = vec![false; beside.len()];
        for first in 0..beside.len() {
            if !is_seen[first] && !beside[first].is_empty() {
                pieces.part(first, &beside, &is_stuck, &mut is_seen);
            }
        }
        pieces
    }

    /// Finds how far all pieces that hang together by seams move, unless one of them cannot move as a
    /// whole.
    fn part(
        &mut self,
        first: usize,
        beside: &[Vec<(usize, Vector)>],
        is_stuck: &[bool],
        is_seen: &mut [bool],
    ) {
        let mut together = vec![first];
        self.shifts[first] = Some(Vector::zeros());
        is_seen[first] = true;
        let mut next = 0;
        while let Some(&piece) = together.get(next) {
            next += 1;
            let shift = self.shifts[piece].expect("it was reached");
            for &(other, way) in &beside[piece] {
                if !std::mem::replace(&mut is_seen[other], true) {
                    self.shifts[other] = Some(shift + way);
                    together.push(other);
                }
            }
        }
        let at = |piece: usize| self.shifts[piece].expect("it was reached");
        let parts = |&piece: &usize| {
            let mut ways = beside[piece].iter();
            !is_stuck[piece]
                && ways.all(|&(other, way)| (at(other) - at(piece)).dot(&way) >= AGREED)
        };
        let all_part = together.iter().all(parts);
        let sum: Vector = together.iter().map(|&piece| at(piece)).sum();
        let middle = sum / together.len() as f64;
        for piece in together {
            let shift = &mut self.shifts[piece];
            *shift = shift.filter(|_| all_part).map(|shift| shift - middle);
        }
    }

    /// By how much of the gap a vertex moves with its piece.
    fn shift(&self, mesh: &Mesh, v: VertexId) -> Option<Vector> {
        self.shifts[self.of.of(mesh.half_edge_of(v)?.face())]
    }

    /// What is across a torn edge, unless the two sides move apart as a whole.
    fn across(&self, mesh: &Mesh, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let across = mesh.ghost_pair(h)?;
        let [one, other] = [h, across].map(|h| self.of.of(h.face()));
        (one == other || self.shifts[one].is_none()).then_some(across)
    }
}

/// In which direction each vertex moves away from the other lip, if it does.
fn directions(mesh: &Mesh, positions: &Positions, pieces: &Pieces) -> Vec<Option<Vector>> {
    let mut away = vec![Vector::zeros(); mesh.vertex_count()];
    let mut is_lip = vec![false; away.len()];
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
            is_lip[v.index()] = true;
            is_shared[v.index()] |= v == across;
        }
    }
    // What a lip ends at is the boundary that was there before the cut, or another piece.
    let mut along = vec![Vector::zeros(); away.len()];
    for h in mesh
        .half_edges()
        .filter(|&h| mesh.pair(h).is_none() && pieces.across(mesh, h).is_none())
    {
        let [a, b] = [mesh.origin(h), mesh.target(h)];
        let edge = positions.at(b) - positions.at(a);
        for (v, edge) in [(a, edge), (b, -edge)] {
            if is_lip[v.index()] {
                along[v.index()] += unit(edge);
            }
        }
    }
    let direction = |v: usize| {
        let (at_end, square) = (unit(along[v]), unit(away[v]));
        let direction = if at_end == Vector::zeros() {
            square
        } else {
            at_end
        };
        (is_lip[v] && !is_shared[v] && direction != Vector::zeros()).then_some(direction)
    };
    (0..away.len()).map(direction).collect()
}

/// The direction from an edge into its face, in the plane of this.
fn inward(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> Vector {
    let [a, b, c] = [h, h.next(), h.prev()].map(|h| positions.at(mesh.origin(h)));
    let edge = unit(b - a);
    unit(unit(edge.cross(&(c - a))).cross(&edge))
}

/// The vector of this direction and of length 1; zero where there is none.
fn unit(v: Vector) -> Vector {
    let largest = v.amax();
    if largest > 0.0 {
        let scaled = v / largest;
        scaled / scaled.norm()
    } else {
        Vector::zeros()
    }
}

/// Twice the area of a triangle, along its normal.
fn normal([a, b, c]: [Point; 3]) -> Vector {
    (b - a).cross(&(c - a))
}
