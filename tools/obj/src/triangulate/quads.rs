//! Quads whose diagonal is an edge elsewhere, cut along the other one.
//!
//! Each polygon is cut by itself, so a diagonal may also be a side of other faces, or their
//! diagonal: two quads in a row on the same three vertices would become faces that are back to back.
//! A quad has another diagonal, which is taken if it lies within and is no edge yet. Larger polygons
//! stay as they were cut, and their diagonals are not looked at.

use tearmesh::Point;

use super::ears::is_simple;
use crate::polygons::Polygons;
use crate::store::push;

/// An edge by its ends, the lower first.
type Edge = [u32; 2];

/// Edges that may be in a set: at the lower end, marks of the higher ones. An edge without its
/// mark is certainly not in the set.
struct Marks {
    of: Vec<u32>,
    factor: u32,
}

impl Marks {
    fn mark(&self, [_, end]: Edge) -> u32 {
        1 << (end.wrapping_mul(self.factor) >> 27)
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
pub(super) fn avoid_edges(triangles: &mut [[u32; 3]], polygons: &Polygons, positions: &[Point]) {
    // Nearly always no diagonal is an edge elsewhere, and marks show it for all but a few, which
    // marks by another hash show for nearly all of these.
    let marks = |factor| Marks {
        of: vec![0; positions.len()],
        factor,
    };
    let (mut diagonals, mut suspected) = (marks(0x9e37_79b1), marks(0x85eb_ca6b));
    for_each_diagonal(triangles, polygons, |_, [edge, _]| {
        if diagonals.has(edge) {
            suspected.add(edge);
        }
        diagonals.add(edge);
    });
    for_each_side(polygons, |edge| {
        if diagonals.has(edge) {
            suspected.add(edge);
        }
    });
    drop(diagonals);
    // Both diagonals of quads whose own may have to go, and how often each is an edge.
    let (mut quads, mut counts) = (Vec::new(), Vec::new());
    for_each_diagonal(triangles, polygons, |polygon, both| {
        if suspected.has(both[0]) {
            // A hostile file has nothing but such quads.
            push(&mut quads, polygon as u32);
            for edge in both {
                push(&mut counts, (edge, 0_u32));
            }
        }
    });
    counts.sort_unstable();
    counts.dedup();
    counts.iter().for_each(|&(edge, _)| suspected.add(edge));
    let mut count = |edge| {
        if suspected.has(edge)
            && let Ok(place) = counts.binary_search_by_key(&edge, |&(edge, _)| edge)
        {
            counts[place].1 += 1;
        }
    };
    for_each_diagonal(triangles, polygons, |_, [edge, _]| count(edge));
    for_each_side(polygons, count);
    for polygon in quads {
        let polygon = polygon as usize;
        let both = diagonals_of(triangles, polygons, polygon).expect("it is a quad");
        let [own, other] = both.map(|edge| {
            let place = counts.binary_search_by_key(&edge, |&(edge, _)| edge);
            place.expect("it is counted")
        });
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        let cut = match both[1] == ends(vertices[0], vertices[2]) {
            true => [[0_u16, 1, 2], [0, 2, 3]],
            false => [[0, 1, 3], [1, 2, 3]],
        };
        let places: Vec<Point> = vertices.iter().map(|&v| positions[v as usize]).collect();
        if counts[own].1 > 1 && counts[other].1 == 0 && is_simple(&places, &cut) {
            counts[own].1 -= 1;
            counts[other].1 = 1;
            for (triangle, cut) in polygons.triangles(polygon).zip(cut) {
                triangles[triangle] = cut.map(|i| vertices[usize::from(i)]);
            }
        }
    }
}

/// The diagonal of a quad, and its other one; `None` for any other polygon.
#[inline]
fn diagonals_of(triangles: &[[u32; 3]], polygons: &Polygons, polygon: usize) -> Option<[Edge; 2]> {
    let [a, b, c, d] = polygons.vertices[polygons.corners(polygon)] else {
        return None;
    };
    let first = triangles[polygons.triangles(polygon).start];
    let is_fan = first[0] == a && first[2] == c; // As nearly always.
    let both = [ends(a, c), ends(b, d)];
    Some(match is_fan || first.contains(&a) && first.contains(&c) {
        true => both,
        false => [both[1], both[0]],
    })
}

/// Visits both diagonals of all quads, their own first.
#[inline]
fn for_each_diagonal(
    triangles: &[[u32; 3]],
    polygons: &Polygons,
    mut visit: impl FnMut(usize, [Edge; 2]),
) {
    for polygon in 0..polygons.len() {
        if let Some(both) = diagonals_of(triangles, polygons, polygon) {
            visit(polygon, both);
        }
    }
}

/// Visits the sides of all polygons.
#[inline]
fn for_each_side(polygons: &Polygons, mut visit: impl FnMut(Edge)) {
    for polygon in 0..polygons.len() {
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        let mut from = vertices[vertices.len() - 1];
        for &to in vertices {
            visit(ends(from, to));
            from = to;
        }
    }
}

fn ends(a: u32, b: u32) -> Edge {
    [a.min(b), a.max(b)]
}
