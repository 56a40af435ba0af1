//! One cut of ours, looked at.

use std::collections::HashMap;

use tearmesh::{
    CutMethod, CutReport, Edit, Edits, ExactSum, HalfEdgeId, Masses, Mesh, PerCorner, Point,
    Positions, Scissor, VertexId,
};
use tearmesh_lab::sheet::wavy;

use crate::sheet::cells;

/// A mesh, and where its vertices are.
pub(crate) type Sheet = (Mesh, Positions);

/// A wavy sheet of about so many faces, in the order of its rows, as programs write meshes: in the order in which
/// Delaunay triangles are found, a partition takes a quarter longer.
pub(crate) fn sheet(faces: usize) -> Sheet {
    let (found, positions) = wavy(cells(faces, 2) as u32);
    let mut triangles = found.indices().as_chunks::<3>().0.to_vec();
    for triangle in &mut triangles {
        let least = (0..3).min_by_key(|&i| triangle[i]);
        triangle.rotate_left(least.expect("one of three"));
    }
    triangles.sort_unstable();
    let mesh = Mesh::build(found.vertex_count(), &triangles).expect("the same mesh");
    (mesh, positions)
}

/// What a cut was like, beside its report.
pub(super) struct Facts {
    pub(super) report: CutReport,
    pub(super) faces: usize,
    /// Whether there are as many pieces as there should be, none of them on both sides.
    pub(super) divided: bool,
    /// Half-edges of the seam without a partner of the same bits on the other side.
    pub(super) cracks: usize,
    /// By how much the area changed, as a part of it: areas are rounded, sums are not.
    pub(super) area: f64,
    /// Whether masses by area add up to what they did, to the last bit.
    pub(super) mass_is_exact: bool,
    /// The largest distance between a corner and its texture coordinate, which was the corner.
    pub(super) texture: f64,
    /// The smallest altitude of a child, as a part of its parent's; 1 where there is none.
    pub(super) child_altitude: f64,
    /// The children of which it is less than 2 %.
    pub(super) slivers: usize,
}

impl Facts {
    pub(super) fn new(scissor: &Scissor, method: CutMethod, (mesh, positions): &Sheet) -> Facts {
        let before = (mesh, positions);
        let (mut mesh, mut positions, mut edits) = (mesh.clone(), positions.clone(), Edits::new());
        let mut masses = Masses::area(&mesh, &positions, 1.0).expect("a sheet has an area");
        let corners = mesh.half_edges().map(|h| corner(&mesh, &positions, h));
        let mut texture = PerCorner::new(corners.collect::<Vec<Point>>());
        let (_, report) = scissor
            .cut_measured(method, &mut mesh, &mut positions, &mut edits)
            .expect("positions are in step");
        edits.replay(&mut (&mut masses, &mut texture));
        assert!(mesh.check().is_empty(), "a cut leaves a mesh");
        let area_before = areas(before.0, before.1).collect::<ExactSum>().to_f64();
        let mut growth: ExactSum = areas(&mesh, &positions).collect();
        growth.extend(areas(before.0, before.1).map(|area| -area));
        let off = |h| (texture.at(h) - corner(&mesh, &positions, h)).norm();
        let mean_edge = mean_edge(before);
        let children = altitudes(before, &positions, &edits);
        let divided = report.pieces == report.pieces_expected
            && !is_a_piece_on_both_sides(scissor, &mesh, &positions, 5.0 * mean_edge);
        Facts {
            report,
            faces: mesh.face_count(),
            divided,
            cracks: cracks(&mesh, &positions),
            area: growth.to_f64() / area_before,
            mass_is_exact: masses.ledger().is_balanced(),
            texture: mesh.half_edges().map(off).fold(0.0, f64::max),
            child_altitude: children.iter().copied().fold(1.0, f64::min),
            slivers: children.iter().filter(|&&part| part < 0.02).count(),
        }
    }
}

/// Whether a piece has vertices farther away than `reach` in front of the plane, and behind it. Two
/// pieces may be a sheet that hangs together, and a crumb.
fn is_a_piece_on_both_sides(
    scissor: &Scissor,
    mesh: &Mesh,
    positions: &Positions,
    reach: f64,
) -> bool {
    let pieces = mesh.components();
    let mut sides = vec![[false; 2]; pieces.count()];
    for h in mesh.half_edges() {
        let distance = scissor.plane().distance(corner(mesh, positions, h));
        let of_piece = &mut sides[pieces.of(h.face())];
        of_piece[0] |= distance > reach;
        of_piece[1] |= distance < -reach;
    }
    sides.contains(&[true; 2])
}

fn corner(mesh: &Mesh, positions: &Positions, h: HalfEdgeId) -> Point {
    positions.at(mesh.origin(h))
}

/// The areas of all faces.
fn areas(mesh: &Mesh, positions: &Positions) -> impl Iterator<Item = f64> {
    mesh.faces().map(|f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    })
}

/// The mean length of an edge.
pub(super) fn mean_edge((mesh, positions): (&Mesh, &Positions)) -> f64 {
    let ends = mesh
        .edges()
        .map(|h| [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v)));
    let lengths = ends.map(|[p, q]| (q - p).norm());
    lengths.sum::<f64>() / mesh.edges().count() as f64
}

/// Counts half-edges of the seam, by their ends alone.
fn cracks(mesh: &Mesh, positions: &Positions) -> usize {
    let bits = |v: VertexId| {
        let p = positions.at(v);
        [p.x, p.y, p.z].map(f64::to_bits)
    };
    let mut surplus: HashMap<[[u64; 3]; 2], i64> = HashMap::new();
    for h in mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some()) {
        let (from, to) = (bits(mesh.origin(h)), bits(mesh.target(h)));
        let (ends, count) = if from < to {
            ([from, to], 1)
        } else {
            ([to, from], -1)
        };
        *surplus.entry(ends).or_default() += count;
    }
    surplus
        .values()
        .map(|count| count.unsigned_abs() as usize)
        .sum()
}

/// The smallest altitude of each child, as a part of its parent's.
fn altitudes(before: (&Mesh, &Positions), positions: &Positions, edits: &Edits) -> Vec<f64> {
    let mut altitudes = Vec::new();
    for edit in edits.iter() {
        let Edit::Insert(insert) = edit else { continue };
        for child in insert.children {
            let (mesh, old) = before;
            let parent = altitude(mesh.face_vertices(child.parent).map(|v| old.at(v)));
            let own = altitude(child.vertices.map(|v| positions.at(v)));
            altitudes.push(own / parent);
        }
    }
    altitudes
}

/// The smallest altitude of a triangle.
fn altitude([a, b, c]: [Point; 3]) -> f64 {
    let sides = [b - a, c - b, a - c].map(|side| side.norm());
    (b - a).cross(&(c - a)).norm() / sides.into_iter().fold(0.0, f64::max)
}
