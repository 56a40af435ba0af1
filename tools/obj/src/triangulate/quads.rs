//! Quads whose diagonal is an edge elsewhere, cut along the other one.
//!
//! Each polygon is cut by itself, so a diagonal may also be a side of other faces, or their
//! diagonal: two quads in a row on the same three vertices would become faces that are back to back.
//! A quad has another diagonal, which is taken if it lies within and is no edge yet. Larger polygons
//! stay as they were cut, and their diagonals are not looked at.

use std::collections::BTreeMap;

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
    let mut diagonals = marks(0x9e37_79b1);
    let mut suspected: Option<Marks> = None;
    let mut suspect = |edge| {
        suspected
            .get_or_insert_with(|| marks(0x85eb_ca6b))
            .add(edge);
    };
    for_each_diagonal(triangles, polygons, |edge, _| {
        if diagonals.has(edge) {
            suspect(edge);
        }
        diagonals.add(edge);
    });
    // The sides that may be among them, unless that is more than an eighth of all.
    let (mut sides, mut are_all) = (Vec::new(), true);
    for_each_side(polygons, |edge| {
        if diagonals.has(edge) {
            suspect(edge);
            are_all &= sides.len() < polygons.vertices.len() / 8;
            if are_all {
                sides.push(edge);
            }
        }
    });
    drop(diagonals);
    let Some(mut suspected) = suspected else {
        return;
    };
    // The diagonals of quads that may have to go, and those that may come, with how often each is an
    // edge.
    let mut counts: BTreeMap<Edge, u32> = BTreeMap::new();
    let both_of = |polygon: u32| match polygons.vertices[polygons.corners(polygon as usize)] {
        [a, b, c, d] => [ends(a, c), ends(b, d)],
        _ => unreachable!("a diagonal is that of a quad"),
    };
    let mut quads = Vec::new();
    for_each_diagonal(triangles, polygons, |edge, polygon| {
        if suspected.has(edge) {
            // A hostile file has nothing but such quads.
            let polygon = polygon as u32;
            push(&mut quads, (polygon, edge != both_of(polygon)[0]));
            *counts.entry(edge).or_default() += 1;
        }
    });
    sides.sort_unstable();
    let is_edge = |edge: &Edge| counts[edge] > 1 || sides.binary_search(edge).is_ok();
    quads.retain(|&(polygon, is)| !are_all || is_edge(&both_of(polygon)[usize::from(is)]));
    if quads.is_empty() {
        return;
    }
    let both = quads.iter().flat_map(|&(polygon, _)| both_of(polygon));
    counts = both.map(|diagonal| (diagonal, 0)).collect();
    counts.keys().for_each(|&edge| suspected.add(edge));
    let mut count = |edge| {
        if suspected.has(edge)
            && let Some(count) = counts.get_mut(&edge)
        {
            *count += 1;
        }
    };
    for_each_diagonal(triangles, polygons, |edge, _| count(edge));
    for_each_side(polygons, count);
    for (polygon, is) in quads {
        let (diagonals, is) = (both_of(polygon), usize::from(is));
        let polygon = polygon as usize;
        let cuts = [[[0_u16, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
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
                triangles[triangle] = cut.map(|i| vertices[usize::from(i)]);
            }
        }
    }
}

/// Visits the diagonals of all quads.
#[inline]
fn for_each_diagonal(
    triangles: &[[u32; 3]],
    polygons: &Polygons,
    mut visit: impl FnMut(Edge, usize),
) {
    for polygon in 0..polygons.len() {
        if let [a, b, c, d] = polygons.vertices[polygons.corners(polygon)] {
            let first = triangles[polygons.triangles(polygon).start];
            let is_fan = first[0] == a && first[2] == c; // As nearly always.
            let has_both = is_fan || first.contains(&a) && first.contains(&c);
            visit(if has_both { ends(a, c) } else { ends(b, d) }, polygon);
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
