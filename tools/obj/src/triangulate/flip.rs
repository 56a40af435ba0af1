//! Diagonals that collide with other edges, and their flip.
//!
//! Each polygon is cut by itself, so a diagonal may join two vertices that already have
//! an edge elsewhere: two quads that share two neighbouring edges (a vertex with only two
//! faces; modellers make them) would be cut along the same diagonal, and a sound surface would
//! become a pillow. So the diagonals are looked up among all edges, and one that is not
//! alone gives way to the other diagonal of its quadrilateral, if that one is free and
//! lies inside.
//!
//! Linear but for the sorting of diagonals that may collide: some ten nanoseconds a polygon.

use std::collections::BTreeMap;

use tearmesh::Point;

use super::corners::Corners;
use super::ears::{doubled_area, flatten};
use crate::polygons::Polygons;

/// Flips diagonals that collide.
pub(super) fn flip_colliding(
    triangles: &mut [[u32; 3]],
    corners: &mut Corners,
    polygons: &Polygons,
    positions: &[Point],
) {
    let colliding = colliding_polygons(corners, polygons, positions.len());
    if colliding.is_empty() {
        return;
    }
    corners.keep_each(triangles.len(), polygons, polygons.len());
    let mut edges = edges_among(&colliding, corners, polygons, positions.len());
    let mut flat = Vec::new();
    for polygon in colliding.into_iter().map(|polygon| polygon as usize) {
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        flatten(vertices, positions, &mut flat);
        let vertex = |corner: u16| vertices[usize::from(corner)];
        let key = |[a, b]: [u16; 2]| ends(vertex(a), vertex(b));
        let of_polygon = polygons.triangles(polygon);
        let mut cut: Vec<[u16; 3]> = corners.of_polygon(of_polygon.clone()).collect();
        for diagonal in diagonals(&cut, vertices.len()).collect::<Vec<_>>() {
            if edges[&key(diagonal)] < 2 {
                continue;
            }
            let Some(([first, second], [k, l])) = quadrilateral(&cut, diagonal) else {
                continue;
            };
            let [i, j] = diagonal;
            let flipped = [[l, j, k], [l, k, i]].map(from_smallest);
            let inside = flipped
                .iter()
                .all(|&[a, b, c]| doubled_area(&flat, a, b, c) > 0.0);
            if inside && !edges.contains_key(&key([k, l])) {
                cut[first] = flipped[0];
                cut[second] = flipped[1];
                edges.entry(key(diagonal)).and_modify(|count| *count -= 1);
                edges.insert(key([k, l]), 1);
            }
        }
        for (triangle, cut) in of_polygon.zip(cut) {
            corners.set(triangle, cut);
            triangles[triangle] = cut.map(vertex);
        }
    }
}

/// The polygons with a diagonal that is also an edge or a diagonal elsewhere, ascending.
fn colliding_polygons(corners: &Corners, polygons: &Polygons, vertex_count: usize) -> Vec<u32> {
    // Nearly always there are none, and marks at the smaller ends, which lie in memory as the
    // polygons do, show it for all but a few. Those are sorted.
    let mut seen = vec![0; vertex_count];
    let mut suspected = Suspected::default();
    for_each_diagonal(corners, polygons, |[a, b], _| {
        let seen = &mut seen[a as usize];
        if *seen & mark(b) != 0 {
            suspected.insert([a, b], vertex_count);
        }
        *seen |= mark(b);
    });
    // The sides that may be among them, unless that is more than an eighth of all.
    let mut sides = Vec::new();
    let mut all_listed = true;
    let room = polygons.vertices.len() / 8;
    for polygon in 0..polygons.len() {
        for_each_side(polygons, polygon, |[a, b]| {
            if seen[a as usize] & mark(b) != 0 {
                suspected.insert([a, b], vertex_count);
                all_listed &= sides.len() < room;
                if all_listed {
                    sides.push([a, b]);
                }
            }
        });
    }
    if suspected.is_empty() {
        return Vec::new();
    }
    drop(seen);
    let suspects = Suspects::among(corners, polygons, &suspected);
    // A mark for each: a polygon may collide in many places.
    let mut colliding = vec![false; polygons.len()];
    for pair in (0..vertex_count as u32).flat_map(|a| suspects.at(a).windows(2)) {
        if pair[0].0 == pair[1].0 {
            colliding[pair[0].1 as usize] = true;
            colliding[pair[1].1 as usize] = true;
        }
    }
    let mut meet = |[a, b]: [u32; 2]| {
        let entries = suspects.at(a);
        let first = entries.partition_point(|entry| entry.0 < b);
        // If there are more diagonals like this, they have collided with each other.
        if let Some(&(end, polygon)) = entries.get(first)
            && end == b
        {
            colliding[polygon as usize] = true;
        }
    };
    if all_listed {
        sides.into_iter().for_each(meet);
    } else {
        (0..polygons.len()).for_each(|polygon| for_each_side(polygons, polygon, &mut meet));
    }
    let numbers = (0..).zip(&colliding).filter(|&(_, &collides)| collides);
    numbers.map(|(polygon, _)| polygon).collect()
}

/// Diagonals that may collide, sorted.
struct Suspects {
    /// By the smaller end, where its entries end.
    ends: Vec<u32>,
    /// The larger end, and the polygon.
    entries: Vec<(u32, u32)>,
}

impl Suspects {
    /// A counting sort by the smaller end.
    fn among(corners: &Corners, polygons: &Polygons, suspected: &Suspected) -> Suspects {
        let vertex_count = suspected.marks.len();
        let mut ends = vec![0_u32; vertex_count + 1];
        for_each_diagonal(corners, polygons, |[a, b], _| {
            ends[a as usize + 1] += u32::from(suspected.may_hold([a, b]));
        });
        let mut before = 0;
        for end in &mut ends {
            before += *end;
            *end = before;
        }
        let mut entries = vec![(0, 0); before as usize];
        for_each_diagonal(corners, polygons, |[a, b], polygon| {
            if suspected.may_hold([a, b]) {
                // Filling moves each start on to the end of its entries.
                let slot = &mut ends[a as usize];
                entries[*slot as usize] = (b, polygon as u32);
                *slot += 1;
            }
        });
        let mut suspects = Suspects { ends, entries };
        for a in 0..vertex_count as u32 {
            let range = suspects.first(a)..suspects.ends[a as usize] as usize;
            suspects.entries[range].sort_unstable();
        }
        suspects
    }

    fn first(&self, a: u32) -> usize {
        let before = (a as usize).checked_sub(1);
        before.map_or(0, |before| self.ends[before] as usize)
    }

    fn at(&self, a: u32) -> &[(u32, u32)] {
        &self.entries[self.first(a)..self.ends[a as usize] as usize]
    }
}

/// The mark of the larger end of an edge, by a hash, among all that are seen at the smaller one. A
/// mark that is missing is certain.
#[inline]
fn mark(end: u32) -> u32 {
    1 << (end.wrapping_mul(0x9e37_79b1) >> 27)
}

/// Edges that may have been met twice: at the smaller end, marks of the larger ones by another
/// hash. Takes no memory until there is one.
#[derive(Default)]
struct Suspected {
    marks: Vec<u32>,
}

impl Suspected {
    fn mark(end: u32) -> u32 {
        1 << (end.wrapping_mul(0x85eb_ca6b) >> 27)
    }

    #[cold]
    fn insert(&mut self, [a, b]: [u32; 2], vertex_count: usize) {
        self.marks.resize(vertex_count, 0);
        self.marks[a as usize] |= Suspected::mark(b);
    }

    #[inline]
    fn may_hold(&self, [a, b]: [u32; 2]) -> bool {
        self.marks[a as usize] & Suspected::mark(b) != 0
    }

    fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }
}

/// How often each edge occurs whose ends both belong to these polygons: as a side of a
/// polygon, and as a diagonal.
fn edges_among(
    colliding: &[u32],
    corners: &Corners,
    polygons: &Polygons,
    vertex_count: usize,
) -> BTreeMap<[u32; 2], u32> {
    let mut concerned = vec![false; vertex_count];
    for &polygon in colliding {
        for &vertex in &polygons.vertices[polygons.corners(polygon as usize)] {
            concerned[vertex as usize] = true;
        }
    }
    let mut edges = BTreeMap::new();
    let mut count = |edge: [u32; 2]| {
        if edge.iter().all(|&end| concerned[end as usize]) {
            *edges.entry(edge).or_insert(0) += 1;
        }
    };
    for_each_diagonal(corners, polygons, |edge, _| count(edge));
    for polygon in 0..polygons.len() {
        for_each_side(polygons, polygon, &mut count);
    }
    edges
}

fn for_each_side(polygons: &Polygons, polygon: usize, mut visit: impl FnMut([u32; 2])) {
    let vertices = &polygons.vertices[polygons.corners(polygon)];
    if let [a, b, c, d] = *vertices {
        for [from, to] in [[a, b], [b, c], [c, d], [d, a]] {
            visit(ends(from, to));
        }
        return;
    }
    let mut from = vertices[vertices.len() - 1];
    for &to in vertices {
        visit(ends(from, to));
        from = to;
    }
}

fn for_each_diagonal(
    corners: &Corners,
    polygons: &Polygons,
    mut visit: impl FnMut([u32; 2], usize),
) {
    let mut several = Vec::new();
    for polygon in 0..polygons.len() {
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        if vertices.len() == 3 {
            continue;
        }
        let triangles = polygons.triangles(polygon);
        // Nearly all polygons are convex quads.
        if let [a, _, c, _] = *vertices
            && corners.get(triangles.start, 0) == [0, 1, 2]
        {
            visit(ends(a, c), polygon);
            continue;
        }
        several.clear();
        several.extend(corners.of_polygon(triangles));
        for [i, j] in diagonals(&several, vertices.len()) {
            let [a, b] = [i, j].map(|corner| vertices[usize::from(corner)]);
            visit(ends(a, b), polygon);
        }
    }
}

/// The diagonals of a polygon, each once: those edges of its triangles that run from
/// a smaller corner to a larger one which is not its neighbour.
fn diagonals(triangles: &[[u16; 3]], arity: usize) -> impl Iterator<Item = [u16; 2]> + '_ {
    let last = arity as u16 - 1;
    triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(move |&[i, j]| i + 1 < j && !(i == 0 && j == last))
}

/// The triangles on both sides of a diagonal from i to j, by their place in the list, and their
/// third corners.
fn quadrilateral(triangles: &[[u16; 3]], [i, j]: [u16; 2]) -> Option<([usize; 2], [u16; 2])> {
    let find = |from: u16, to: u16| {
        triangles.iter().enumerate().find_map(|(at, &[a, b, c])| {
            [[a, b, c], [b, c, a], [c, a, b]]
                .into_iter()
                .find(|&[x, y, _]| (x, y) == (from, to))
                .map(|[_, _, third]| (at, third))
        })
    };
    let (first, k) = find(i, j)?;
    let (second, l) = find(j, i)?;
    Some(([first, second], [k, l]))
}

fn from_smallest(mut triangle: [u16; 3]) -> [u16; 3] {
    let smallest = (0..3).min_by_key(|&i| triangle[i]).unwrap_or(0);
    triangle.rotate_left(smallest);
    triangle
}

fn ends(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
