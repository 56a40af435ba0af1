//! The lips of cuts, apart from each other: for the eye, and for programs that join what lies at one
//! place.

use tearmesh::{FaceId, HalfEdgeId, Mesh, Point, Positions, Vector, VertexId};

use crate::measure::Edges;

/// Where vertices are shown.
pub(crate) struct Gapped {
    pub(crate) points: Vec<Point>,
    /// How many are shown apart from where they are, and how many of these by less than was asked for.
    pub(crate) moved: usize,
    pub(crate) clamped: usize,
}

/// How often a vertex is brought half way back before it is left where it is.
const HALVINGS: u32 = 40;

/// What is left of a face at least, by area.
const LEAST: f64 = 0.1;

/// Moves both lips of everything that is torn half of `gap` away from each other: within the surface,
/// square to the lip, and along the boundary where the lip ends there. A vertex that both lips
/// share, as the tip of a slit, stays; so the gap opens over one edge. Where a face would turn over, or
/// lose nearly all of its area, its vertices are brought back by halves. Linear: a vertex is brought back
/// so often at most, and then only its own faces are looked at again.
pub(crate) fn gapped(mesh: &Mesh, positions: &Positions, gap: f64) -> Gapped {
    let away = directions(mesh, positions);
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
    let points: Vec<Point> = mesh.vertices().map(|v| at(v, &halvings)).collect();
    let is_less = |v: &VertexId| moves(*v) && (halvings[v.index()] > 0 || far < wanted);
    let is_apart = |v: &VertexId| points[v.index()] != positions.at(*v);
    Gapped {
        moved: mesh.vertices().filter(is_apart).count(),
        clamped: mesh.vertices().filter(is_less).count(),
        points,
    }
}

/// In which direction each vertex moves away from the other lip, if it does.
fn directions(mesh: &Mesh, positions: &Positions) -> Vec<Option<Vector>> {
    let mut away = vec![Vector::zeros(); mesh.vertex_count()];
    let mut is_lip = vec![false; away.len()];
    let mut is_shared = vec![false; away.len()];
    for h in mesh.half_edges() {
        let Some(other) = mesh.ghost_pair(h) else {
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
    // What a lip ends at is the boundary that was there before the cut.
    let mut along = vec![Vector::zeros(); away.len()];
    for h in mesh
        .half_edges()
        .filter(|&h| mesh.pair_or_ghost(h).is_none())
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
