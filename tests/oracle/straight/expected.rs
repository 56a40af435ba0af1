//! What an ideal cut makes of a surface: the seam, its ends, the pieces; and whether a cut is
//! far enough from every special case to be foreseen.

use std::collections::BTreeMap;

use super::surface::{Cut, Flat, Surface, cross, length, minus, on_the_way};
use crate::oracle::joined_sets;

/// How far a generic cut stays away from every special case, in edges.
const MARGIN: f64 = 1e-6;

/// What an ideal cut makes of a surface.
pub(super) struct Expected {
    plane: Flat,
    /// The length of what plane, faces and strip have in common.
    pub(super) length: f64,
    /// What each face has in common with plane and strip.
    pub(super) segments: Vec<[[f64; 3]; 2]>,
    /// Ends of the slit inside a face.
    pub(super) tips: Vec<[f64; 3]>,
    /// The number of ends of the slit on the boundary.
    pub(super) boundary_ends: usize,
    /// The number of faces into which each face is cut.
    pub(super) children: Vec<usize>,
    /// The pieces of the parts before and behind the plane of each face.
    piece: Vec<usize>,
    pub(super) pieces: usize,
}

impl Expected {
    pub(super) fn new(before: &Surface, cut: &Cut) -> Expected {
        let mut expected = Expected {
            plane: cut.plane,
            length: 0.0,
            segments: Vec::new(),
            tips: Vec::new(),
            boundary_ends: 0,
            children: Vec::new(),
            piece: Vec::new(),
            pieces: 0,
        };
        let directed = before.directed_edges();
        let mut joined = Vec::new();
        for (f, face) in before.faces.iter().enumerate() {
            let slit = Slit::of(before, cut, face);
            let inside = slit.as_ref().and_then(|slit| slit.inside);
            if let (Some(slit), Some((from, to))) = (&slit, inside) {
                let [p, q] = slit.ends.map(|(_, p)| p);
                let segment = [from, to].map(|t| on_the_way(p, q, t));
                expected.length += (to - from) * length(minus(q, p));
                // Ends on an edge as they are, so that both faces have the same.
                expected.segments.push([
                    if from > 0.0 { segment[0] } else { p },
                    if to < 1.0 { segment[1] } else { q },
                ]);
                expected.tips.extend(slit.tips());
                for ((a, b), _) in slit.nodes() {
                    let lone = !directed.contains_key(&(b, a));
                    expected.boundary_ends += usize::from(lone);
                }
            }
            // A slit that begins and ends in one face has a vertex between its tips: with both
            // ends joined, an edge could not open.
            let [nodes, tips] =
                slit.map_or([0, 0], |slit| [slit.nodes().count(), slit.tips().count()]);
            let in_face = tips + usize::from(tips == 2);
            expected.children.push(1 + nodes + 2 * in_face);
            if inside != Some((0.0, 1.0)) {
                joined.push([2 * f, 2 * f + 1]);
            }
        }
        expected.join_pieces(before, joined);
        expected
    }

    /// Joins the parts of neighbours along their common edges, and counts what is left apart. A
    /// face that is not crossed has joined parts, of which one is empty.
    fn join_pieces(&mut self, before: &Surface, mut joined: Vec<[usize; 2]>) {
        let mut side_of = BTreeMap::new();
        for (f, &[a, b, c]) in before.faces.iter().enumerate() {
            for side in [(a, b), (b, c), (c, a)] {
                side_of.insert(side, f);
            }
        }
        for (&(a, b), &f) in &side_of {
            if let Some(&g) = side_of.get(&(b, a)) {
                for v in [a, b] {
                    let p = before.points[v as usize];
                    joined.push([self.part(f, p), self.part(g, p)]);
                }
            }
        }
        self.piece = joined_sets(2 * before.faces.len(), &joined);
        let first = |&part: &usize| self.piece[part] == part;
        self.pieces = (0..self.piece.len()).filter(first).count();
    }

    /// The number of the part of a face that lies on the side of a point.
    fn part(&self, face: usize, p: [f64; 3]) -> usize {
        2 * face + usize::from(self.plane.distance(p) < 0.0)
    }

    /// The piece of the part of a face that lies on the side of a point.
    pub(super) fn piece_of(&self, face: usize, p: [f64; 3]) -> usize {
        self.piece[self.part(face, p)]
    }
}

/// An end of what a face has in common with plane and strip, and the edge (as sorted vertices) on which it is;
/// none at a side plane.
pub(crate) type End = ([f64; 3], Option<[u32; 2]>);

/// What each face that is crossed between the side planes has in common with plane and strip.
pub(crate) fn segments(before: &Surface, cut: &Cut) -> BTreeMap<usize, [End; 2]> {
    let of = |(f, face): (usize, &[u32; 3])| {
        let slit = Slit::of(before, cut, face)?;
        let (from, to) = slit.inside?;
        let [(one, p), (other, q)] = slit.ends;
        let end = |t: f64, (a, b): (u32, u32), at| match t == 0.0 || t == 1.0 {
            true => (at, Some([a.min(b), a.max(b)])),
            false => (on_the_way(p, q, t), None),
        };
        Some((f, [end(from, one, p), end(to, other, q)]))
    };
    before.faces.iter().enumerate().filter_map(of).collect()
}

/// Where the plane crosses a face.
struct Slit {
    /// The edges where it enters and leaves, directed as in the face, and the points there.
    ends: [((u32, u32), [f64; 3]); 2],
    /// The part between the side planes, from 0 to 1.
    inside: Option<(f64, f64)>,
}

impl Slit {
    fn of(before: &Surface, cut: &Cut, &[a, b, c]: &[u32; 3]) -> Option<Slit> {
        let mut ends = Vec::new();
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let mut ends_of_edge = [a, b].map(|v| before.points[v as usize]);
            // In one order for both faces and for both sides of a torn edge, so that all find
            // the same point.
            ends_of_edge.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
            let [p, q] = ends_of_edge;
            let (d, e) = (cut.plane.distance(p), cut.plane.distance(q));
            if (d < 0.0) != (e < 0.0) {
                ends.push(((a, b), on_the_way(p, q, d / (d - e))));
            }
        }
        let ends: [_; 2] = ends.try_into().ok()?;
        let inside = clip(cut, ends[0].1, ends[1].1);
        Some(Slit { ends, inside })
    }

    /// The ends that are edge points of the seam.
    fn nodes(&self) -> impl Iterator<Item = ((u32, u32), [f64; 3])> {
        let inside = self.inside;
        let is_node = move |i: usize| inside.is_some_and(|(from, to)| [from, 1.0 - to][i] == 0.0);
        (0..2).filter(move |&i| is_node(i)).map(|i| self.ends[i])
    }

    /// Where the seam ends inside the face.
    fn tips(&self) -> impl Iterator<Item = [f64; 3]> {
        let [p, q] = self.ends.map(|(_, p)| p);
        let inside = self.inside.map_or([0.0, 1.0], |(from, to)| [from, to]);
        let inner = inside.into_iter().filter(|&t| t > 0.0 && t < 1.0);
        inner.map(move |t| on_the_way(p, q, t))
    }
}

/// The part of a segment between the side planes, as two parameters.
fn clip(cut: &Cut, p: [f64; 3], q: [f64; 3]) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for side in &cut.sides {
        let (s, t) = (side.distance(p), side.distance(q));
        if s < 0.0 {
            from = if t < 0.0 { 2.0 } else { from.max(s / (s - t)) };
        } else if t < 0.0 {
            to = to.min(s / (s - t));
        }
    }
    (from < to).then_some((from, to))
}

/// Whether a cut stays 1e-6 edges away from every special case: vertices on the plane, edge
/// points on a side plane, tips on an edge, on each other or on the other side plane.
///
/// Vertices count where a face of theirs may reach into the strip.
pub(crate) fn is_generic(before: &Surface, cut: &Cut) -> bool {
    let margin = MARGIN * before.mean_edge();
    let longest = before.longest_edge();
    let clear =
        |p: [f64; 3]| cut.plane.distance(p).abs() > margin || cut.depth(p) < -longest - margin;
    let mut corners = before.faces.iter().flatten();
    corners.all(|&v| clear(before.points[v as usize]))
        && before.faces.iter().all(|face| {
            let Some(slit) = Slit::of(before, cut, face) else {
                return true;
            };
            let tips: Vec<_> = slit.tips().collect();
            slit.ends.iter().all(|&(_, p)| cut.depth(p).abs() > margin)
                && tips.iter().all(|&tip| is_inside(before, face, tip, margin))
                // A tip lies on its own side plane, and well before the other one.
                && tips.iter().all(|&tip| {
                    let near = |side: &&Flat| side.distance(tip) <= margin;
                    cut.sides.iter().filter(near).count() == 1
                })
                && (tips.len() < 2 || length(minus(tips[0], tips[1])) > margin)
        })
}

/// Whether a point of a face keeps this distance from its edges.
fn is_inside(before: &Surface, face: &[u32; 3], p: [f64; 3], margin: f64) -> bool {
    let [a, b, c] = before.corners(face);
    [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| {
        let across = cross(minus(b, a), minus(p, a));
        length(across) > margin * length(minus(b, a))
    })
}
