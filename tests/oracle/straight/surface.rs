//! Surfaces and cuts as plain data, and what can be counted and measured on them.

use std::collections::BTreeMap;

use crate::oracle::joined_sets;
pub(crate) use vectors::{cross, dot, length, minus};

#[path = "../../support/vectors.rs"]
mod vectors;

/// Triangles. What hangs together shares numbers of vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
}

/// A plane: a point of it and the normal, of length one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flat {
    point: [f64; 3],
    normal: [f64; 3],
}

/// A cut: wherever the plane goes, or between two side planes whose normals point inward.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    pub(crate) plane: Flat,
    pub(crate) sides: Vec<Flat>,
}

impl Flat {
    pub(crate) fn new(point: [f64; 3], normal: [f64; 3]) -> Flat {
        let size = length(normal);
        let normal = normal.map(|x| x / size);
        Flat { point, normal }
    }

    /// The signed distance of a point.
    pub(crate) fn distance(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, minus(p, self.point))
    }

    pub(crate) fn normal(&self) -> [f64; 3] {
        self.normal
    }
}

impl Cut {
    /// The cut between two rays, each an origin and a direction: the plane through both
    /// origins along the first direction, or, from one eye, along both directions. Each side
    /// plane runs along its ray, upright on the plane, and looks towards the other ray.
    pub(crate) fn between([(a, along_a), (b, along_b)]: [([f64; 3], [f64; 3]); 2]) -> Cut {
        let mut normal = cross(minus(a, b), along_a);
        if length(normal) <= 1e-12 * length(along_a) * (length(a) + length(b)) {
            normal = cross(along_a, along_b);
        }
        let side = |origin, along, other, other_along| {
            let inward = cross(normal, along);
            let size = length(inward);
            let to_other = minus(other, origin);
            let mut towards = dot(inward, to_other);
            if towards.abs() <= 1e-12 * size * (length(origin) + length(other)) {
                towards = dot(inward, other_along);
            }
            Flat::new(origin, inward.map(|x| x * towards.signum()))
        };
        Cut {
            plane: Flat::new(a, normal),
            sides: vec![side(a, along_a, b, along_b), side(b, along_b, a, along_a)],
        }
    }

    /// This cut along its whole plane, without side planes.
    pub(crate) fn through(self) -> Cut {
        let sides = Vec::new();
        Cut { sides, ..self }
    }

    /// How far inside the nearest side plane a point lies; infinite where there is none.
    pub(crate) fn depth(&self, p: [f64; 3]) -> f64 {
        let depths = self.sides.iter().map(|side| side.distance(p));
        depths.fold(f64::INFINITY, f64::min)
    }
}

impl Surface {
    /// The directed edges, and how often each is there.
    pub(crate) fn directed_edges(&self) -> BTreeMap<(u32, u32), usize> {
        let mut edges = BTreeMap::new();
        for &[a, b, c] in &self.faces {
            for side in [(a, b), (b, c), (c, a)] {
                *edges.entry(side).or_default() += 1;
            }
        }
        edges
    }

    /// The directed edges that have no opposite.
    pub(crate) fn boundary(&self) -> Vec<(u32, u32)> {
        let edges = self.directed_edges();
        let lone = |&(a, b): &(u32, u32)| !edges.contains_key(&(b, a));
        edges.keys().copied().filter(lone).collect()
    }

    pub(super) fn total_length(&self, edges: &[(u32, u32)]) -> f64 {
        let of =
            |&(a, b): &(u32, u32)| length(minus(self.points[b as usize], self.points[a as usize]));
        edges.iter().map(of).sum()
    }

    /// The edges, each once.
    pub(super) fn edges(&self) -> Vec<(u32, u32)> {
        let directed = self.directed_edges();
        let once = |&(a, b): &(u32, u32)| a < b || !directed.contains_key(&(b, a));
        directed.keys().copied().filter(once).collect()
    }

    pub(crate) fn mean_edge(&self) -> f64 {
        let edges = self.edges();
        self.total_length(&edges) / edges.len() as f64
    }

    pub(crate) fn longest_edge(&self) -> f64 {
        let edges = self.edges();
        let lengths = edges.iter().map(|&edge| self.total_length(&[edge]));
        lengths.fold(0.0, f64::max)
    }

    pub(crate) fn area(&self) -> f64 {
        let area = |face: &[u32; 3]| length(twice_area(self.corners(face))) / 2.0;
        self.faces.iter().map(area).sum()
    }

    pub(super) fn corners(&self, face: &[u32; 3]) -> [[f64; 3]; 3] {
        face.map(|v| self.points[v as usize])
    }

    /// Vertices that have faces, minus edges, plus faces.
    pub(super) fn euler(&self) -> i64 {
        let mut used: Vec<u32> = self.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        used.len() as i64 - self.edges().len() as i64 + self.faces.len() as i64
    }

    /// The piece of each face, joined over shared edges, and the number of pieces.
    pub(crate) fn pieces(&self) -> (Vec<usize>, usize) {
        let mut on = BTreeMap::<_, Vec<usize>>::new();
        for (f, &[a, b, c]) in self.faces.iter().enumerate() {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                on.entry((a.min(b), a.max(b))).or_default().push(f);
            }
        }
        let joined: Vec<_> = on
            .values()
            .flat_map(|faces| faces.windows(2).map(|two| [two[0], two[1]]))
            .collect();
        let piece = joined_sets(self.faces.len(), &joined);
        let count = (0..piece.len()).filter(|&f| piece[f] == f).count();
        (piece, count)
    }

    /// For each vertex the number of fans that its faces form, joined over shared edges.
    pub(crate) fn fans(&self) -> Vec<usize> {
        let mut rims = vec![Vec::new(); self.points.len()];
        for &[a, b, c] in &self.faces {
            for [v, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
                rims[v as usize].push((from, to));
            }
        }
        let fans = |rim: &Vec<(u32, u32)>| {
            let mut joined = Vec::new();
            for (i, one) in rim.iter().enumerate() {
                for (j, other) in rim.iter().enumerate() {
                    if one.1 == other.0 {
                        joined.push([i, j]);
                    }
                }
            }
            let fan = joined_sets(rim.len(), &joined);
            (0..rim.len()).filter(|&i| fan[i] == i).count()
        };
        rims.iter().map(fans).collect()
    }
}

/// The point at `t` of the way from `p` to `q`.
pub(crate) fn on_the_way(p: [f64; 3], q: [f64; 3], t: f64) -> [f64; 3] {
    let way = minus(q, p);
    [p[0] + t * way[0], p[1] + t * way[1], p[2] + t * way[2]]
}

/// The normal of a triangle, twice its area long.
pub(super) fn twice_area([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(minus(b, a), minus(c, a))
}

/// A place, bit for bit.
pub(super) fn bits(p: &[f64; 3]) -> [u64; 3] {
    p.map(f64::to_bits)
}

/// The place of these bits.
pub(super) fn place(bits: [u64; 3]) -> [f64; 3] {
    bits.map(f64::from_bits)
}
