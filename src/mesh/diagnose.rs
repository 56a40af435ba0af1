//! The defects of triangles that `build.rs` refused.
//!
//! Thorough rather than fast: nothing is assumed of the rest of the mesh when one part of it is broken.
//! O(n log n).
//!
//! Lean, since whoever is told must not run out of memory instead: what is dealt out to the vertices,
//! and sorted there by edges, are bare numbers of half-edges, whose keys are looked up in the triangles,
//! and those of a quarter of the mesh at a time. So beside the triangles there are three bytes a face,
//! or up to eight where all faces meet at one vertex.

use std::collections::BTreeMap;

use super::Mesh;
use super::defect::{Defect, Faces, Fans};
use crate::id::{FaceId, VertexId};
use crate::sets::DisjointSets;

impl Mesh {
    /// Calls `visit` for each defect of triangles. The defects of one kind come in ascending order of
    /// their vertices, or of their faces where they have no others. Nothing is called for an oriented
    /// 2-manifold.
    ///
    /// The lists of a defect have at most `listed` faces and fans: the first ones, and the last. Takes
    /// O(n log n) time, and up to eight bytes a face for as long as it runs.
    ///
    /// ```
    /// use tearmesh::{Defect, Mesh};
    ///
    /// let mut listed = 0;
    /// Mesh::diagnose(3, &vec![[0, 1, 2]; 5000], usize::MAX, |defect| {
    ///     if let Defect::DuplicateFaces { faces, .. } = defect {
    ///         listed += faces.iter().count();
    ///     }
    /// });
    /// assert_eq!(listed, 5000);
    /// ```
    pub fn diagnose(
        vertices: usize,
        triangles: &[[u32; 3]],
        listed: usize,
        mut visit: impl FnMut(Defect),
    ) {
        let is_too_many = vertices > Mesh::MAX_VERTICES;
        if is_too_many {
            visit(Defect::TooManyVertices {
                given: vertices,
                limit: Mesh::MAX_VERTICES,
            });
        }
        if triangles.len() > Mesh::MAX_FACES {
            visit(Defect::TooManyFaces {
                given: triangles.len(),
                limit: Mesh::MAX_FACES,
            });
        } else if !is_too_many {
            let soup = Soup {
                vertices,
                triangles,
                listed,
            };
            soup.look_at_all(&mut visit);
        }
    }
}

/// Triangles of which nothing is known. Faces and half-edges are numbers here.
#[derive(Clone, Copy)]
struct Soup<'t> {
    vertices: usize,
    triangles: &'t [[u32; 3]],
    listed: usize,
}

impl Soup<'_> {
    fn look_at_all(self, visit: &mut impl FnMut(Defect)) {
        for f in 0..self.triangles.len() as u32 {
            self.is_sound(f, visit);
        }
        self.by_vertex(
            |h| self.ends(h)[0],
            |half_edges| {
                half_edges.sort_unstable_by_key(|&h| [self.ends(h)[1], self.opposite(h)]);
                for along in half_edges.chunk_by_mut(|&h, &g| self.ends(h) == self.ends(g)) {
                    self.look_at_edge(along, visit);
                }
            },
        );
        self.by_vertex(
            |h| self.origin(h),
            |half_edges| self.look_at_vertex(half_edges, visit),
        );
    }

    /// Hands out the half-edges of sound faces by their vertices, in ascending order. Those of as many
    /// vertices are found at once as have a quarter of them, or of one that has more.
    fn by_vertex(self, vertex: impl Fn(u32) -> u32, mut look: impl FnMut(&mut [u32])) {
        let all = || {
            let faces = (0..self.triangles.len() as u32).filter(|&f| self.is_sound(f, &mut |_| {}));
            faces.flat_map(|f| 3 * f..3 * f + 3)
        };
        let mut sizes = vec![0u32; self.vertices];
        all().for_each(|h| sizes[vertex(h) as usize] += 1);
        let quarter = sizes.iter().map(|&size| size as usize).sum::<usize>() / 4;
        let largest = sizes.iter().max().map_or(0, |&size| size as usize);
        let limit = quarter.max(largest);
        let mut half_edges = Vec::with_capacity(limit);
        let mut start = 0;
        while start < sizes.len() {
            // Sizes become the places where the next half-edge of each vertex goes, and then where those end.
            let (mut end, mut size) = (start, 0);
            while end < sizes.len() && size + sizes[end] as usize <= limit {
                let first = size as u32;
                size += sizes[end] as usize;
                sizes[end] = first;
                end += 1;
            }
            half_edges.resize(size, 0);
            for h in all() {
                let vertex = vertex(h) as usize;
                if (start..end).contains(&vertex) {
                    half_edges[sizes[vertex] as usize] = h;
                    sizes[vertex] += 1;
                }
            }
            let mut first = 0;
            for &last in &sizes[start..end] {
                look(&mut half_edges[first..last as usize]);
                first = last as usize;
            }
            start = end;
        }
    }

    /// Whether the three vertices of a face exist and differ. Of other faces nothing more is said.
    fn is_sound(self, f: u32, visit: &mut impl FnMut(Defect)) -> bool {
        let [a, b, c] = self.triangles[f as usize];
        let face = FaceId::from_u32(f);
        if a.max(b).max(c) as usize >= self.vertices {
            for (corner, index) in [a, b, c].into_iter().enumerate() {
                if index as usize >= self.vertices {
                    visit(Defect::IndexOutOfRange {
                        face,
                        corner,
                        index,
                        vertices: self.vertices,
                    });
                }
            }
            return false;
        }
        let twice = [(a, a == b || a == c), (b, b == c)];
        let twice = twice.into_iter().find(|&(_, is_twice)| is_twice);
        if let Some((vertex, _)) = twice {
            let vertex = VertexId::from_u32(vertex);
            visit(Defect::RepeatedVertex { face, vertex });
        }
        twice.is_none()
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

    /// The ends of an edge, the smaller first.
    fn ends(self, h: u32) -> [u32; 2] {
        let (from, to) = (self.origin(h), self.target(h));
        [from.min(to), from.max(to)]
    }

    /// Looks at the half-edges along one edge, which are in the order of the vertices opposite: whether they are
    /// too many, and whether faces lie on the same three vertices of which the edge has the first two.
    fn look_at_edge(self, along: &mut [u32], visit: &mut impl FnMut(Defect)) {
        let [first, _, ..] = *along else {
            return;
        };
        let [a, b] = self.ends(first);
        let ends = [a, b].map(VertexId::from_u32);
        for group in along.chunk_by_mut(|&h, &g| self.opposite(h) == self.opposite(g)) {
            group.sort_unstable();
            let c = self.opposite(group[0]);
            let vertices = [ends[0], ends[1], VertexId::from_u32(c)];
            match *group {
                _ if c < b => {}
                [_] => {}
                [h, g] if self.origin(h) != self.origin(g) => visit(Defect::Pillow {
                    vertices,
                    faces: [h, g].map(|h| FaceId::from_u32(h / 3)),
                }),
                _ => {
                    let faces = Faces::of_half_edges(group, self.listed);
                    visit(Defect::DuplicateFaces { vertices, faces });
                }
            }
        }
        let opposite = self.opposite(first);
        if along.iter().all(|&h| self.opposite(h) == opposite) {
            return; // A pillow or duplicates, which are defects of their own.
        }
        along.sort_unstable();
        match *along {
            [one, other] if self.origin(one) != self.origin(other) => {}
            [one, other] => visit(Defect::FlippedFace {
                from: VertexId::from_u32(self.origin(one)),
                to: VertexId::from_u32(self.target(one)),
                faces: [one, other].map(|h| FaceId::from_u32(h / 3)),
            }),
            _ => {
                let faces = Faces::of_half_edges(along, self.listed);
                visit(Defect::CrowdedEdge { ends, faces });
            }
        }
    }

    /// Looks at the corners at one vertex, which ascend. Faces round it belong to one fan if they share an edge
    /// at it, in any direction and with however many others: what is wrong with the edge is
    /// said elsewhere. So fans are the connected parts of the link of the vertex: its nodes are
    /// the neighbours, and each face joins two.
    fn look_at_vertex(self, around: &mut [u32], visit: &mut impl FnMut(Defect)) {
        let (mut nodes, mut parts) = (BTreeMap::new(), DisjointSets::default());
        for &h in &*around {
            let ends = [self.target(h), self.opposite(h)];
            let [a, b] = ends.map(|v| *nodes.entry(v).or_insert_with(|| parts.push()));
            parts.join(a, b);
        }
        if parts.count() < 2 {
            return;
        }
        // Nodes are numbered as they are met, so that the representatives of fans ascend with their first faces.
        let representatives = parts.representatives();
        let fan = |h: u32| representatives[nodes[&self.target(h)] as usize];
        let vertex = VertexId::from_u32(self.origin(around[0]));
        around.sort_unstable_by_key(|&h| (fan(h), h));
        let fans = around.chunk_by(|&h, &g| fan(h) == fan(g));
        let fans = Fans::of_corners(fans, self.listed);
        visit(Defect::BowTie { vertex, fans });
    }
}
