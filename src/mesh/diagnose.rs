//! What exactly is wrong with triangles that `build.rs` refused.
//!
//! Thorough rather than fast: faces and half-edges are sorted, and nothing is assumed of the
//! rest of the mesh when one part of it is broken. O(n log n).
//!
//! Lean, since whoever is told must not run out of memory instead: what is sorted are bare
//! numbers, whose keys are looked up in the triangles, and a batch of them at a time. So beside
//! the triangles and the list of defects there is a byte a face, or up to twelve
//! where all faces meet at one vertex.

use std::collections::BTreeMap;

use super::Mesh;
use super::defect::{BuildError, Found};
use crate::id::{FaceId, VertexId};
use crate::sets::DisjointSets;

/// Every defect; `None` for an oriented 2-manifold.
pub(super) fn diagnose(vertices: usize, triangles: &[[u32; 3]]) -> Option<BuildError> {
    let mut found = Found::new(vertices);
    if vertices > Mesh::MAX_VERTICES {
        found.too_many_vertices();
    }
    if triangles.len() > Mesh::MAX_FACES {
        found.too_many_faces(triangles.len());
    }
    if found.count() > 0 {
        return found.finish();
    }
    let soup = Soup {
        vertices,
        triangles,
    };
    soup.unsound_faces(&mut found);
    soup.faces_on_the_same_vertices(&mut found);
    soup.crowded_and_flipped_edges(&mut found);
    soup.bow_ties(&mut found);
    found.finish()
}

/// Triangles of which nothing is known. Faces and half-edges are numbers here.
#[derive(Clone, Copy)]
struct Soup<'t> {
    vertices: usize,
    triangles: &'t [[u32; 3]],
}

/// An edge, by its ends, the smaller first.
type Ends = [u32; 2];

impl Soup<'_> {
    fn unsound_faces(self, found: &mut Found) {
        for (f, triangle) in self.triangles.iter().enumerate() {
            let face = FaceId::from_u32(f as u32);
            let known = found.count();
            for (corner, &index) in (0..).zip(triangle) {
                if index as usize >= self.vertices {
                    found.index_out_of_range(face, corner, index);
                }
            }
            let [a, b, c] = *triangle;
            let twice = [(a, a == b || a == c), (b, b == c)];
            if let Some((twice, _)) = twice.into_iter().find(|&(_, is_twice)| is_twice)
                && known == found.count()
            {
                found.repeated_vertex(face, VertexId::from_u32(twice));
            }
        }
    }

    /// Whether the three vertices of a face exist and differ. Of other faces
    /// nothing more is said.
    fn is_sound(self, f: u32) -> bool {
        let [a, b, c] = self.triangles[f as usize];
        (a.max(b).max(c) as usize) < self.vertices && a != b && b != c && c != a
    }

    fn sound_faces(self) -> impl Iterator<Item = u32> + Clone {
        (0..self.triangles.len() as u32).filter(move |&f| self.is_sound(f))
    }

    fn sound_half_edges(self) -> impl Iterator<Item = u32> + Clone {
        self.sound_faces().flat_map(|f| 3 * f..3 * f + 3)
    }

    fn origin(self, h: u32) -> u32 {
        self.triangles[h as usize / 3][h as usize % 3]
    }

    fn target(self, h: u32) -> u32 {
        self.triangles[h as usize / 3][(h as usize % 3 + 1) % 3]
    }

    /// The vertex of its face that a half-edge does not touch.
    fn opposite(self, h: u32) -> u32 {
        self.triangles[h as usize / 3][(h as usize % 3 + 2) % 3]
    }

    fn ends(self, h: u32) -> Ends {
        let (from, to) = (self.origin(h), self.target(h));
        [from.min(to), from.max(to)]
    }

    fn faces_on_the_same_vertices(self, found: &mut Found) {
        let vertices = |f: u32| {
            let mut vertices = self.triangles[f as usize];
            vertices.sort_unstable();
            vertices
        };
        let bin_of = |f: u32| {
            let [a, b, c] = vertices(f).map(u64::from);
            bin((a << 42) ^ (b << 21) ^ c)
        };
        in_batches(&self.sound_faces(), bin_of, |faces| {
            found.begin_block();
            faces.sort_unstable_by_key(|&f| (vertices(f), f));
            for group in faces.chunk_by(|&f, &g| vertices(f) == vertices(g)) {
                let shared = vertices(group[0]).map(VertexId::from_u32);
                match *group {
                    [_] => {}
                    [f, g] if !self.is_rotation(f, g) => {
                        found.pillow(shared, [f, g].map(FaceId::from_u32));
                    }
                    _ => found.duplicate_faces(shared, group.iter().copied()),
                }
            }
        });
    }

    fn is_rotation(self, f: u32, g: u32) -> bool {
        let [a, [x, y, z]] = [f, g].map(|f| self.triangles[f as usize]);
        [[x, y, z], [y, z, x], [z, x, y]].contains(&a)
    }

    fn crowded_and_flipped_edges(self, found: &mut Found) {
        let bin_of = |h: u32| {
            let [a, b] = self.ends(h).map(u64::from);
            bin(a << 32 | b)
        };
        in_batches(&self.sound_half_edges(), bin_of, |half_edges| {
            found.begin_block();
            half_edges.sort_unstable_by_key(|&h| (self.ends(h), h));
            for group in half_edges.chunk_by(|&h, &g| self.ends(h) == self.ends(g)) {
                self.look_at_edge(group, found);
            }
        });
    }

    /// Looks at the half-edges along one edge.
    fn look_at_edge(self, half_edges: &[u32], found: &mut Found) {
        let opposite = self.opposite(half_edges[0]);
        if half_edges.iter().all(|&h| self.opposite(h) == opposite) {
            return; // One face, or a pillow or duplicates, which are defects of their own.
        }
        let ends = self.ends(half_edges[0]).map(VertexId::from_u32);
        match *half_edges {
            [one, other] if self.origin(one) != self.origin(other) => {}
            [one, other] => {
                let [from, to] = [self.origin(one), self.target(one)].map(VertexId::from_u32);
                found.flipped_face(from, to, [one / 3, other / 3].map(FaceId::from_u32));
            }
            _ => found.crowded_edge(ends, half_edges.iter().map(|h| h / 3)),
        }
    }

    fn bow_ties(self, found: &mut Found) {
        let mut links = Links::default();
        let bin_of = |h: u32| bin(u64::from(self.origin(h)));
        in_batches(&self.sound_half_edges(), bin_of, |corners| {
            found.begin_block();
            corners.sort_unstable_by_key(|&h| (self.origin(h), h));
            for around in corners.chunk_by(|&h, &g| self.origin(h) == self.origin(g)) {
                self.look_at_vertex(around, &mut links, found);
            }
        });
    }

    /// Looks at the corners at one vertex. Faces round it belong to one fan if they share an edge
    /// at it, in any direction and with however many others: what is wrong with the edge is
    /// said elsewhere. So fans are the connected parts of the link of the vertex: its nodes are
    /// the neighbours, and each face joins two.
    fn look_at_vertex(self, around: &[u32], links: &mut Links, found: &mut Found) {
        links.clear();
        for &h in around {
            links.join(self.target(h), self.opposite(h));
        }
        let fan_count = links.number_parts(around.iter().map(|&h| self.target(h)));
        if fan_count < 2 {
            return;
        }
        let fan_of = |&h: &u32| (links.part(self.target(h)), h / 3);
        let mut by_fan: Vec<(u32, u32)> = around.iter().map(fan_of).collect();
        by_fan.sort_unstable();
        let fans = by_fan.chunk_by(|(a, _), (b, _)| a == b);
        let vertex = VertexId::from_u32(self.origin(around[0]));
        let fans = fans.map(|fan| fan.iter().map(|&(_, f)| f));
        found.bow_tie(vertex, fan_count, fans);
    }
}

/// Roughly how many batches the numbers are handed out in. Each batch is a pass over the triangles.
const BATCHES: usize = 16;

const BINS: usize = 1024;

/// The bin of a face, an edge or a vertex: the highest bits of a product with 2^64 over the
/// golden ratio, which differ for neighbours.
fn bin(key: u64) -> usize {
    (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 54) as usize
}

/// Hands out all numbers, those of a bin together. A batch is as many bins as have a sixteenth of
/// the numbers, or one that has more.
fn in_batches(
    numbers: &(impl Iterator<Item = u32> + Clone),
    bin_of: impl Fn(u32) -> usize,
    mut look: impl FnMut(&mut [u32]),
) {
    let mut sizes = [0; BINS];
    for number in numbers.clone() {
        sizes[bin_of(number)] += 1;
    }
    let most = sizes.iter().max().copied().unwrap_or(0);
    let limit = most.max(sizes.iter().sum::<usize>() / BATCHES);
    let mut batch = Vec::with_capacity(limit);
    let mut start = 0;
    while start < BINS {
        let mut end = start;
        let mut size = 0;
        while end < BINS && size + sizes[end] <= limit {
            size += sizes[end];
            end += 1;
        }
        batch.clear();
        batch.extend(
            numbers
                .clone()
                .filter(|&number| (start..end).contains(&bin_of(number))),
        );
        look(&mut batch);
        start = end;
    }
}

/// The link of a vertex: which neighbours faces join.
#[derive(Default)]
struct Links {
    nodes: BTreeMap<u32, u32>,
    parts: DisjointSets,
    /// The number of the part of each node.
    part: Vec<u32>,
}

impl Links {
    fn clear(&mut self) {
        self.nodes.clear();
        self.parts.reset(0);
        self.part.clear();
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [a, b].map(|v| *self.nodes.entry(v).or_insert_with(|| self.parts.push()));
        self.parts.join(a, b);
    }

    /// Numbers the parts in the order in which they are met; how many there are.
    fn number_parts(&mut self, neighbours: impl Iterator<Item = u32>) -> u32 {
        const UNKNOWN: u32 = u32::MAX;
        if self.parts.count() == 1 {
            return 1;
        }
        self.part.resize(self.parts.len(), UNKNOWN);
        let mut count = 0;
        for v in neighbours {
            let leader = self.parts.leader(self.nodes[&v]) as usize;
            if self.part[leader] == UNKNOWN {
                self.part[leader] = count;
                count += 1;
            }
        }
        for (node, &leader) in self.parts.leaders().iter().enumerate() {
            self.part[node] = self.part[leader as usize];
        }
        count
    }

    /// The number of the part of a neighbour, once parts are numbered.
    fn part(&self, neighbour: u32) -> u32 {
        self.part[self.nodes[&neighbour] as usize]
    }
}
