//! What exactly is wrong with triangles that `build.rs` refused.
//!
//! Simple and thorough rather than fast: everything is sorted, and nothing is assumed of
//! the rest of the mesh when one part of it is broken. O(n log n), and some 50 bytes a face.

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
    let mut sound = Vec::with_capacity(triangles.len());
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
    let mut by_vertices: Vec<_> = sound
        .iter()
        .map(|&(face, corners)| (sorted(corners), face, corners))
        .collect();
    by_vertices.sort_unstable();
    for group in by_vertices.chunk_by(|(a, ..), (b, ..)| a == b) {
        let vertices = group[0].0;
        match *group {
            [_] => {}
            [(_, f, a), (_, g, b)] if !is_rotation(a, b) => {
                defects.push(Defect::Pillow {
                    vertices,
                    faces: [f, g],
                });
            }
            _ => {
                let faces = group.iter().map(|&(_, face, _)| face).collect();
                defects.push(Defect::DuplicateFaces { vertices, faces });
            }
        }
    }
}

fn is_rotation(a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    [[b[0], b[1], b[2]], [b[1], b[2], b[0]], [b[2], b[0], b[1]]].contains(&a)
}

fn crowded_and_flipped_edges(sound: &[Sound], defects: &mut Vec<Defect>) {
    // Twelve bytes a half-edge: its edge, its face, and whether it runs up.
    let mut uses = Vec::with_capacity(3 * sound.len());
    for (i, &(_, [a, b, c])) in sound.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let key = (i as u32) << 1 | u32::from(from < to);
            uses.push(([from.min(to), from.max(to)], key));
        }
    }
    uses.sort_unstable();
    let face = |key: u32| sound[(key >> 1) as usize].0;
    let across = |ends: [VertexId; 2], key: u32| {
        let (_, vertices) = sound[(key >> 1) as usize];
        vertices.into_iter().find(|v| !ends.contains(v))
    };
    for group in uses.chunk_by(|(a, ..), (b, ..)| a == b) {
        let (ends, first) = group[0];
        let opposite = across(ends, first);
        if group.iter().all(|&(_, key)| across(ends, key) == opposite) {
            continue; // One face, or a pillow or duplicates, which are defects of their own.
        }
        match *group {
            [(_, one), (_, other)] if one & 1 != other & 1 => {}
            [(_, one), (_, other)] => {
                let [from, to] = if one & 1 == 1 {
                    ends
                } else {
                    [ends[1], ends[0]]
                };
                defects.push(Defect::FlippedFace {
                    from,
                    to,
                    faces: [face(one), face(other)],
                });
            }
            _ => {
                let faces = group.iter().map(|&(_, key)| face(key)).collect();
                defects.push(Defect::CrowdedEdge { ends, faces });
            }
        }
    }
}

/// Faces round a vertex belong to one fan if they share an edge at it, in any direction
/// and with however many others: what is wrong with the edge is said elsewhere.
fn bow_ties(sound: &[Sound], defects: &mut Vec<Defect>) {
    let mut corners = Vec::with_capacity(3 * sound.len());
    for (i, &(_, vertices)) in sound.iter().enumerate() {
        corners.extend(vertices.map(|v| (v, i as u32)));
    }
    corners.sort_unstable();
    for around in corners.chunk_by(|(a, _), (b, _)| a == b) {
        let vertex = around[0].0;
        let mut fan: Vec<usize> = (0..around.len()).collect();
        let mut by_neighbour: BTreeMap<VertexId, usize> = BTreeMap::new();
        for (i, &(_, face)) in around.iter().enumerate() {
            let (_, vertices) = sound[face as usize];
            for v in vertices.into_iter().filter(|&v| v != vertex) {
                let first = *by_neighbour.entry(v).or_insert(i);
                let (a, b) = (leader(&mut fan, i), leader(&mut fan, first));
                fan[a.max(b)] = a.min(b);
            }
        }
        let mut fans: BTreeMap<usize, Vec<FaceId>> = BTreeMap::new();
        for (i, &(_, face)) in around.iter().enumerate() {
            fans.entry(leader(&mut fan, i))
                .or_default()
                .push(sound[face as usize].0);
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
