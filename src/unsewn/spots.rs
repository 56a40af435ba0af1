//! The places of the vertices along a boundary, as numbers: equal for vertices at one place.

use std::cmp::Ordering;

use super::groups::for_each_group;
use crate::geometry::{Point, length};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;
use crate::sets::DisjointSets;

/// A vertex that is not at an end of the boundary half-edges.
const NONE: u32 = u32::MAX;

/// How many points in one cell of the grid are compared. Where there are more, they are as dense as the
/// distance is long, and none is one with another.
const DENSE: usize = 64;

/// The places of the vertices of boundary half-edges.
pub(super) struct Spots<'p, P: ?Sized> {
    place: &'p P,
    distance: f64,
    /// By vertex.
    of: Vec<u32>,
    count: usize,
}

impl<'p, P: Place + ?Sized> Spots<'p, P> {
    /// Looks at both ends of each half-edge. Places are one if they are equal, or with a distance, if they
    /// are connected by steps of at most that and no two of them are farther apart.
    pub(super) fn new(
        mesh: &Mesh,
        place: &'p P,
        boundary: &[HalfEdgeId],
        distance: f64,
    ) -> Spots<'p, P> {
        let mut of = vec![NONE; mesh.vertex_count()];
        let mut order: Vec<VertexId> = Vec::new();
        for v in boundary
            .iter()
            .flat_map(|&h| [mesh.origin(h), mesh.target(h)])
        {
            if std::mem::replace(&mut of[v.index()], 0) == NONE {
                order.push(v);
            }
        }
        let at = |v: VertexId| coordinates(place.at(v));
        let mut firsts = Vec::new();
        let cells = order.len().next_power_of_two();
        let cell = |v: VertexId| hash(at(v)) as usize % cells;
        for_each_group(&order, cells, cell, |alike| {
            alike.sort_unstable_by(|&a, &b| compare(at(a), at(b)).then(a.cmp(&b)));
            for equal in alike.chunk_by(|&a, &b| at(a) == at(b)) {
                equal
                    .iter()
                    .for_each(|v| of[v.index()] = firsts.len() as u32);
                firsts.push(equal[0]);
            }
        });
        if distance > 0.0 {
            let merged = merged(&firsts, at, distance);
            for spot in of.iter_mut().filter(|spot| **spot != NONE) {
                *spot = merged[*spot as usize];
            }
        }
        Spots {
            place,
            distance,
            of,
            count: firsts.len(),
        }
    }

    /// The number of places.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The number of the place of a vertex of the boundary.
    pub(super) fn of_vertex(&self, v: VertexId) -> u32 {
        self.of[v.index()]
    }

    /// Whether the faces of two half-edges that run between the same places continue each other: each has
    /// three places, and not the same three.
    pub(super) fn are_partners(&self, mesh: &Mesh, h: HalfEdgeId, g: HalfEdgeId) -> bool {
        let ends = [mesh.origin(h), mesh.target(h)].map(|v| self.of_vertex(v));
        let opposite = [h, g].map(|h| mesh.origin(h.prev()));
        let is_thin = |v: VertexId| ends.contains(&self.of_vertex(v));
        let [p, q] = opposite.map(|v| self.place.at(v));
        let is_same = || p == q || length(q - p) <= self.distance;
        !opposite.into_iter().any(is_thin) && !is_same()
    }
}

/// The coordinates of a point, with 0 for −0.
fn coordinates(p: Point) -> [f64; 3] {
    [p.x, p.y, p.z].map(|x| x + 0.0)
}

/// A number that is the same for equal points, and seldom for others.
fn hash(p: [f64; 3]) -> u64 {
    let mixed = p.iter().fold(0, |hash: u64, x| {
        (hash.rotate_left(23) ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    });
    mixed ^ mixed >> 32
}

fn compare(p: [f64; 3], q: [f64; 3]) -> Ordering {
    let axes = p.iter().zip(&q).map(|(x, y)| x.total_cmp(y));
    axes.fold(Ordering::Equal, Ordering::then)
}

/// For each of these vertices a number that it has in common with those that are connected with it by steps
/// of at most `distance`, if no two of them are farther apart.
fn merged(vertices: &[VertexId], at: impl Fn(VertexId) -> [f64; 3], distance: f64) -> Vec<u32> {
    let count = vertices.len() as u32;
    let at = |i: u32| at(vertices[i as usize]);
    let cell: Vec<[f64; 3]> = (0..count)
        .map(|i| at(i).map(|x| (x / distance).floor()))
        .collect();
    let cell = |i: u32| cell[i as usize];
    let far = |i: u32, j: u32| length(Point::from(at(j)) - Point::from(at(i)));
    let mut cells: Vec<u32> = (0..count).collect();
    cells.sort_unstable_by(|&i, &j| compare(cell(i), cell(j)).then(i.cmp(&j)));
    // Those in a cell and in the two beside it along z.
    let inside = |[x, y, z]: [f64; 3]| {
        let [low, high] = [[x, y, z - 1.0], [x, y, z + 1.0]];
        let from = cells.partition_point(|&i| compare(cell(i), low).is_lt());
        let count = cells[from..].iter().take(DENSE + 1);
        let count = count.take_while(|&&i| compare(cell(i), high).is_le());
        &cells[from..from + count.count()]
    };
    let mut sets = DisjointSets::new(count);
    let mut is_dense = vec![false; vertices.len()];
    for &i in &cells {
        let [x, y, z] = cell(i);
        // The other half of the cells round this one sees it.
        for [dx, dy] in [
            [-1.0, -1.0],
            [-1.0, 0.0],
            [-1.0, 1.0],
            [0.0, -1.0],
            [0.0, 0.0],
        ] {
            let near = inside([x + dx, y + dy, z]);
            if near.len() > DENSE {
                is_dense[i as usize] = true;
                continue;
            }
            let near = near.iter().copied();
            for j in near.filter(|&j| j != i && far(i, j) <= distance) {
                sets.join(i, j);
            }
        }
    }
    let representatives = sets.representatives();
    let representative = |i: u32| representatives[i as usize];
    cells.sort_unstable_by_key(|&i| (representative(i), i));
    let mut merged: Vec<u32> = (0..count).collect();
    for set in cells.chunk_by(|&i, &j| representative(i) == representative(j)) {
        let is_apart = |n: usize| set[..n].iter().any(|&j| far(set[n], j) > distance);
        let is_wide = || (0..set.len()).any(is_apart);
        if set.len() <= DENSE && !set.iter().any(|&i| is_dense[i as usize]) && !is_wide() {
            set.iter().for_each(|&i| merged[i as usize] = set[0]);
        }
    }
    merged
}
