//! What exactly is wrong with triangles that `build.rs` refused.
//!
//! Simple and thorough rather than fast: everything is sorted, and nothing is assumed of
//! the rest of the mesh when one part of it is broken. O(n log n).

use std::collections::BTreeMap;

use super::{Defect, Mesh};
use crate::id::{FaceId, VertexId};

/// Every defect, ascending; empty for an oriented 2-manifold.
pub(super) fn diagnose(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Defect> {
    let mut defects = Vec::new();
    if vertices > Mesh::MAX_VERTICES {
        defects.push(Defect::TooManyVertices {
            given: vertices,
            limit: Mesh::MAX_VERTICES,
        });
    }
    if triangles.len() > Mesh::MAX_FACES {
        defects.push(Defect::TooManyFaces {
            given: triangles.len(),
            limit: Mesh::MAX_FACES,
        });
    }
    if !defects.is_empty() {
        return defects;
    }
    let mut sound = Vec::new();
    for (f, triangle) in triangles.iter().enumerate() {
        let face = FaceId::from_u32(f as u32);
        let known = defects.len();
        for (corner, &index) in triangle.iter().enumerate() {
            if index as usize >= vertices {
                defects.push(Defect::IndexOutOfRange {
                    face,
                    corner,
                    index,
                    vertices,
                });
            }
        }
        let [a, b, c] = *triangle;
        if let Some(twice) = if a == b || a == c {
            Some(a)
        } else {
            (b == c).then_some(b)
        } && known == defects.len()
        {
            defects.push(Defect::RepeatedVertex {
                face,
                vertex: VertexId::from_u32(twice),
            });
        }
        if known == defects.len() {
            sound.push((face, triangle.map(VertexId::from_u32)));
        }
    }
    faces_on_the_same_vertices(&sound, &mut defects);
    crowded_and_flipped_edges(&sound, &mut defects);
    bow_ties(&sound, &mut defects);
    defects.sort();
    defects
}

/// A face whose three vertices exist and differ.
type Sound = (FaceId, [VertexId; 3]);

fn sorted(mut vertices: [VertexId; 3]) -> [VertexId; 3] {
    vertices.sort();
    vertices
}

fn faces_on_the_same_vertices(sound: &[Sound], defects: &mut Vec<Defect>) {
    let mut by_vertices: BTreeMap<_, Vec<Sound>> = BTreeMap::new();
    for &(face, corners) in sound {
        by_vertices
            .entry(sorted(corners))
            .or_default()
            .push((face, corners));
    }
    for (vertices, group) in by_vertices {
        let faces: Vec<FaceId> = group.iter().map(|&(face, _)| face).collect();
        match group[..] {
            [_] => {}
            [(f, a), (g, b)] if !is_rotation(a, b) => {
                defects.push(Defect::Pillow {
                    vertices,
                    faces: [f, g],
                });
            }
            _ => defects.push(Defect::DuplicateFaces { vertices, faces }),
        }
    }
}

fn is_rotation(a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    [[b[0], b[1], b[2]], [b[1], b[2], b[0]], [b[2], b[0], b[1]]].contains(&a)
}

fn crowded_and_flipped_edges(sound: &[Sound], defects: &mut Vec<Defect>) {
    let mut by_ends: BTreeMap<[VertexId; 2], Vec<(Sound, bool)>> = BTreeMap::new();
    for &(face, corners) in sound {
        let [a, b, c] = corners;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let ends = [from.min(to), from.max(to)];
            by_ends
                .entry(ends)
                .or_default()
                .push(((face, corners), from < to));
        }
    }
    for (ends, uses) in by_ends {
        let ((_, first), _) = uses[0];
        if uses
            .iter()
            .all(|&((_, corners), _)| sorted(corners) == sorted(first))
        {
            continue; // One face, or a pillow or duplicates, which are defects of their own.
        }
        match uses[..] {
            [(_, up), (_, also_up)] if up != also_up => {}
            [((f, _), up), ((g, _), _)] => {
                let [from, to] = if up { ends } else { [ends[1], ends[0]] };
                defects.push(Defect::FlippedFace {
                    from,
                    to,
                    faces: [f, g],
                });
            }
            _ => {
                let faces = uses.iter().map(|&((face, _), _)| face).collect();
                defects.push(Defect::CrowdedEdge { ends, faces });
            }
        }
    }
}

/// Faces round a vertex belong to one fan if they share an edge at it, in any direction
/// and with however many others: what is wrong with the edge is said elsewhere.
fn bow_ties(sound: &[Sound], defects: &mut Vec<Defect>) {
    let mut by_vertex: BTreeMap<VertexId, Vec<Sound>> = BTreeMap::new();
    for &(face, corners) in sound {
        for v in corners {
            by_vertex.entry(v).or_default().push((face, corners));
        }
    }
    for (vertex, around) in by_vertex {
        let mut fan: Vec<usize> = (0..around.len()).collect();
        let mut by_neighbour: BTreeMap<VertexId, usize> = BTreeMap::new();
        for (i, &(_, corners)) in around.iter().enumerate() {
            for v in corners.into_iter().filter(|&v| v != vertex) {
                let first = *by_neighbour.entry(v).or_insert(i);
                let (a, b) = (leader(&mut fan, i), leader(&mut fan, first));
                fan[a.max(b)] = a.min(b);
            }
        }
        let mut fans: BTreeMap<usize, Vec<FaceId>> = BTreeMap::new();
        for (i, &(face, _)) in around.iter().enumerate() {
            fans.entry(leader(&mut fan, i)).or_default().push(face);
        }
        if fans.len() > 1 {
            defects.push(Defect::BowTie {
                vertex,
                fans: fans.into_values().collect(),
            });
        }
    }
}

/// The representative of a set in a union-find forest, with path halving.
fn leader(parent: &mut [usize], mut i: usize) -> usize {
    while parent[i] != i {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    i
}
