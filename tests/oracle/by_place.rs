//! Surfaces by the places of their vertices: what is open there, whoever shares a vertex.

use std::collections::BTreeMap;

use super::straight::{Surface, cross, dot, length, minus};

type Point = [f64; 3];

/// A place as numbers: −0 is 0.
pub(crate) fn place(p: Point) -> [u64; 3] {
    p.map(|x| (x + 0.0).to_bits())
}

/// The triangles of a surface by place, each from its lowest corner on.
pub(crate) fn by_place(surface: &Surface) -> Vec<[[u64; 3]; 3]> {
    let turned = |face: &[u32; 3]| {
        let mut corners = face.map(|v| place(surface.points[v as usize]));
        let lowest = (0..3).min_by_key(|&i| corners[i]).expect("three");
        corners.rotate_left(lowest);
        corners
    };
    let mut faces: Vec<_> = surface.faces.iter().map(turned).collect();
    faces.sort_unstable();
    faces
}

/// The directed edges, by place, that have no opposite there. (Where both ends round to one place, there is no
/// direction.)
pub(crate) fn open_edges(surface: &Surface) -> Vec<[Point; 2]> {
    let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
    for &[a, b, c] in &surface.faces {
        for ends in [[a, b], [b, c], [c, a]] {
            let [p, q] = ends.map(|v| place(surface.points[v as usize]));
            *edges.entry([p.min(q), p.max(q)]).or_default() += p.cmp(&q) as i32;
        }
    }
    let open = edges.into_iter().filter(|&(_, count)| count != 0);
    open.map(|(ends, _)| ends.map(|p| p.map(f64::from_bits)))
        .collect()
}

/// Whether a segment lies on another, but for rounding.
pub(crate) fn lies_on([p, q]: [Point; 2], [from, to]: [Point; 2]) -> bool {
    let way = minus(to, from);
    let is_on = |p: Point| {
        let off = minus(p, from);
        let along = dot(off, way) / dot(way, way);
        length(cross(off, way)) <= 1e-9 * dot(way, way) && (-1e-9..=1.0 + 1e-9).contains(&along)
    };
    is_on(p) && is_on(q)
}

/// Whether two faces have the same places.
pub(crate) fn has_layers(surface: &Surface) -> bool {
    let places = |face: &[u32; 3]| {
        let mut places = face.map(|v| place(surface.points[v as usize]));
        places.sort_unstable();
        places
    };
    let edge = |face: [[u64; 3]; 3]| [[face[0], face[1]], [face[1], face[2]], [face[0], face[2]]];
    let mut edges: BTreeMap<_, usize> = BTreeMap::new();
    for face in &surface.faces {
        edge(places(face))
            .into_iter()
            .for_each(|edge| *edges.entry(edge).or_default() += 1);
    }
    edges.into_values().any(|count| count > 2)
}
