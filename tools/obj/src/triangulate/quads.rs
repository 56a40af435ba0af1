//! Quads whose diagonal is an edge elsewhere, cut along the other one.
//!
//! Each polygon is cut by itself, so a diagonal may also be a side of other faces, or their
//! diagonal: two quads in a row on the same three vertices would become faces that are back to back.
//! A quad has another diagonal, which is taken if it lies within and is no edge yet. Larger polygons
//! stay as they were cut.

use std::collections::BTreeMap;

use tearmesh::Point;

use super::Triangulation;
use super::ears::is_simple;
use crate::polygons::Polygons;

/// An edge by its ends, the lower first.
type Edge = [u32; 2];

/// Edges that may be in a set: at the lower end, marks of the higher ones. An edge without its
/// mark is certainly not in the set.
struct Marks {
    of: Vec<u64>,
    factor: u32,
}

impl Marks {
    fn mark(&self, [_, end]: Edge) -> u64 {
        1 << (end.wrapping_mul(self.factor) >> 26)
    }

    #[inline]
    fn has(&self, edge: Edge) -> bool {
        self.of[edge[0] as usize] & self.mark(edge) != 0
    }

    #[inline]
    fn add(&mut self, edge: Edge) {
        self.of[edge[0] as usize] |= self.mark(edge);
    }
}

/// Cuts quads another way whose diagonal is an edge elsewhere.
pub(super) fn avoid_edges(
    triangulation: &mut Triangulation,
    polygons: &Polygons,
    positions: &[Point],
) {
    // Nearly always no diagonal is an edge elsewhere, and marks show it for all but a few, which
    // marks by another hash show for nearly all of these.
    let marks = |factor| Marks {
        of: vec![0; positions.len()],
        factor,
    };
    let (mut diagonals, mut suspected) = (marks(0x9e37_79b1), marks(0x85eb_ca6b));
    for_each_edge(triangulation, polygons, |edge, _, is_diagonal| {
        if is_diagonal && diagonals.has(edge) {
            suspected.add(edge);
        } else if is_diagonal {
            diagonals.add(edge);
        }
    });
    for_each_edge(triangulation, polygons, |edge, _, is_diagonal| {
        if !is_diagonal && diagonals.has(edge) {
            suspected.add(edge);
        }
    });
    drop(diagonals);
    // The diagonals of quads that may have to go, and those that may come, with how often each is an
    // edge.
    let mut counts: BTreeMap<Edge, u32> = BTreeMap::new();
    let mut quads = Vec::new();
    for_each_edge(triangulation, polygons, |edge, polygon, is_diagonal| {
        let corners = &polygons.vertices[polygons.corners(polygon)];
        if let (true, true, &[a, b, c, d]) = (is_diagonal, suspected.has(edge), corners) {
            let both = [ends(a, c), ends(b, d)];
            quads.push((polygon, both, usize::from(edge != both[0])));
            counts.extend(both.map(|diagonal| (diagonal, 0)));
        }
    });
    if quads.is_empty() {
        return;
    }
    counts.keys().for_each(|&edge| suspected.add(edge));
    for_each_edge(triangulation, polygons, |edge, _, _| {
        if suspected.has(edge)
            && let Some(count) = counts.get_mut(&edge)
        {
            *count += 1;
        }
    });
    for (polygon, diagonals, is) in quads {
        let cuts = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
        let other = cuts[1 - is];
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        let places: Vec<Point> = vertices.iter().map(|&v| positions[v as usize]).collect();
        if counts[&diagonals[is]] > 1
            && counts[&diagonals[1 - is]] == 0
            && is_simple(&places, &other)
        {
            counts.extend([(diagonals[1 - is], 1)]);
            counts.entry(diagonals[is]).and_modify(|count| *count -= 1);
            for (triangle, cut) in polygons.triangles(polygon).zip(other) {
                triangulation.corners[triangle] = cut;
                triangulation.triangles[triangle] = cut.map(|i| vertices[usize::from(i)]);
            }
        }
    }
}

/// Visits all edges of polygons, once for each polygon that has it as a side or a diagonal, with
/// the polygon, and whether it is a diagonal.
#[inline]
fn for_each_edge(
    triangulation: &Triangulation,
    polygons: &Polygons,
    mut visit: impl FnMut(Edge, usize, bool),
) {
    for polygon in 0..polygons.len() {
        let last = polygons.corners(polygon).len() as u16 - 1;
        for triangle in polygons.triangles(polygon) {
            let ([i, j, k], [a, b, c]) = (
                triangulation.corners[triangle],
                triangulation.triangles[triangle],
            );
            for ([i, j], [a, b]) in [([i, j], [a, b]), ([j, k], [b, c]), ([k, i], [c, a])] {
                let is_side = j == i + 1 || (i == last && j == 0);
                // A diagonal runs one way in one triangle and the other way in the next.
                if is_side || i < j {
                    visit(ends(a, b), polygon, !is_side);
                }
            }
        }
    }
}

fn ends(a: u32, b: u32) -> Edge {
    [a.min(b), a.max(b)]
}
