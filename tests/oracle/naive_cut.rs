//! A second implementation of the straight cut: naive, slow and for generic cuts only. It
//! shows that the oracle accepts what it should, and gives it something to refuse.
//!
//! It never asks what hangs together. A point where the slit crosses an edge becomes two vertices
//! at once, one for each side of the plane, and each triangle takes the one of its own side.

use std::collections::BTreeMap;

use super::straight::{Cut, Surface, on_the_way};

/// Cuts a surface. The cut has to be generic.
pub(crate) fn cut(before: &Surface, cut: &Cut) -> Surface {
    cut_on(before, cut, None)
}

/// Cuts a surface from a vertex on, through which the plane and one side plane go: the joint,
/// at which an earlier cut ended. Otherwise the cut has to be generic, and it has to leave the faces
/// of the joint.
pub(crate) fn cut_from(before: &Surface, cut: &Cut, joint: u32) -> Surface {
    cut_on(before, cut, Some(joint))
}

fn cut_on(before: &Surface, cut: &Cut, joint: Option<u32>) -> Surface {
    let mut knife = Knife {
        cut,
        after: Surface {
            points: before.points.clone(),
            faces: Vec::new(),
        },
        on_edge: BTreeMap::new(),
    };
    for &face in &before.faces {
        match joint.and_then(|joint| face.iter().position(|&v| v == joint)) {
            Some(i) => knife.cut_face_of_joint([face[i], face[(i + 1) % 3], face[(i + 2) % 3]]),
            None => knife.cut_face(face),
        }
    }
    if let Some(joint) = joint {
        knife.part(joint);
    }
    knife.after
}

/// A point of the slit: the vertices before and behind the plane. At a tip they are one.
#[derive(Clone, Copy)]
struct Double {
    place: [f64; 3],
    before: u32,
    behind: u32,
}

struct Knife<'a> {
    cut: &'a Cut,
    after: Surface,
    on_edge: BTreeMap<(u32, u32), Double>,
}

impl Knife<'_> {
    fn cut_face(&mut self, [a, b, c]: [u32; 3]) {
        let front = [a, b, c].map(|v| self.is_before(v));
        // The corner that is alone on its side comes first.
        let [a, b, c] = match front {
            [x, y, z] if x == y && y == z => return self.after.faces.push([a, b, c]),
            [x, y, z] if x != y && x != z => [a, b, c],
            [x, y, _] if x != y => [b, c, a],
            _ => [c, a, b],
        };
        let [p, q] = [(a, b), (a, c)].map(|(v, w)| self.crossing(v, w));
        let Some([from, to]) = self.between_the_sides(p, q) else {
            return self.after.faces.push([a, b, c]);
        };
        match (from > 0.0, to < 1.0) {
            (false, false) => {
                let (p, q) = (self.edge_point(a, b, p), self.edge_point(a, c, q));
                self.emit(&[a], &[p, q], [0, 1, 2]);
                self.emit(&[b, c], &[p], [2, 0, 1]);
                self.emit(&[c], &[p, q], [1, 0, 2]);
            }
            (false, true) => {
                let (tip, p) = (self.tip(on_the_way(p, q, to)), self.edge_point(a, b, p));
                self.emit(&[a], &[p, tip], [0, 1, 2]);
                self.emit(&[b], &[p, tip], [1, 0, 2]);
                self.emit(&[b, c], &[tip], [0, 1, 2]);
                self.emit(&[c, a], &[tip], [0, 1, 2]);
            }
            (true, false) => {
                let (tip, q) = (self.tip(on_the_way(p, q, from)), self.edge_point(a, c, q));
                self.emit(&[a, b], &[tip], [0, 1, 2]);
                self.emit(&[b, c], &[tip], [0, 1, 2]);
                self.emit(&[c], &[q, tip], [0, 1, 2]);
                self.emit(&[a], &[q, tip], [1, 0, 2]);
            }
            (true, true) => {
                let near = self.tip(on_the_way(p, q, from));
                let middle = self.double(on_the_way(p, q, (from + to) / 2.0));
                let far = self.tip(on_the_way(p, q, to));
                self.emit(&[a, b], &[near], [0, 1, 2]);
                self.emit(&[a], &[near, middle], [0, 1, 2]);
                self.emit(&[a], &[middle, far], [0, 1, 2]);
                self.emit(&[c, a], &[far], [0, 1, 2]);
                self.emit(&[b], &[middle, near], [0, 1, 2]);
                self.emit(&[b, c], &[middle], [0, 1, 2]);
                self.emit(&[c], &[far, middle], [0, 1, 2]);
            }
        }
    }

    /// Cuts a face from its first corner, the joint, to the opposite side, if that is where the
    /// slit goes.
    fn cut_face_of_joint(&mut self, [joint, b, c]: [u32; 3]) {
        if self.is_before(b) == self.is_before(c) || self.cut.depth(self.crossing(b, c)) < 0.0 {
            return self.after.faces.push([joint, b, c]);
        }
        let q = self.crossing(b, c);
        let q = self.edge_point(b, c, q);
        let joint = Double {
            place: self.after.points[joint as usize],
            before: joint,
            behind: joint,
        };
        self.emit(&[b], &[q, joint], [2, 0, 1]);
        self.emit(&[c], &[q, joint], [2, 1, 0]);
    }

    /// Gives every face of a vertex that no edges join with its first face a vertex of their own.
    fn part(&mut self, v: u32) {
        let faces = &mut self.after.faces;
        let has = |face: &[u32; 3], v| face.contains(&v);
        let first = faces.iter().position(|face| has(face, v));
        let mut fan = vec![first.expect("the joint has faces")];
        let mut seen = 0;
        while seen < fan.len() {
            let rim = faces[fan[seen]];
            for (f, face) in faces.iter().enumerate() {
                let common = face.iter().filter(|&&w| w != v && has(&rim, w));
                if has(face, v) && !fan.contains(&f) && common.count() > 0 {
                    fan.push(f);
                }
            }
            seen += 1;
        }
        let new = self.after.points.len() as u32;
        self.after.points.push(self.after.points[v as usize]);
        for (f, face) in faces.iter_mut().enumerate() {
            for corner in face.iter_mut().filter(|corner| **corner == v) {
                if !fan.contains(&f) {
                    *corner = new;
                }
            }
        }
    }

    /// The part of a segment that lies between the side planes, found by trying the middles of all
    /// parts into which they divide it.
    fn between_the_sides(&self, p: [f64; 3], q: [f64; 3]) -> Option<[f64; 2]> {
        let mut marks = vec![0.0, 1.0];
        for side in &self.cut.sides {
            let (s, t) = (side.distance(p), side.distance(q));
            if s * t < 0.0 {
                marks.push(s.abs() / (s.abs() + t.abs()));
            }
        }
        marks.sort_by(f64::total_cmp);
        let inside = |part: &&[f64]| {
            let middle = on_the_way(p, q, (part[0] + part[1]) / 2.0);
            self.cut.depth(middle) > 0.0
        };
        let inside: Vec<_> = marks.windows(2).filter(inside).collect();
        Some([inside.first()?[0], inside.last()?[1]])
    }

    /// Adds the triangle of old vertices and slit points, in the order given by `turn`. Its old
    /// vertices lie on one side of the plane, or all its slit points are tips.
    fn emit(&mut self, old: &[u32], slit: &[Double], turn: [usize; 3]) {
        let side = self.is_before(old[0]);
        let mut corners = old.to_vec();
        for point in slit {
            corners.push(if side { point.before } else { point.behind });
        }
        self.after.faces.push(turn.map(|i| corners[i]));
    }

    fn is_before(&self, v: u32) -> bool {
        self.cut.plane.distance(self.after.points[v as usize]) > 0.0
    }

    /// Where the plane crosses an edge; the same for both of its faces, and for both copies of an
    /// edge that is torn.
    fn crossing(&self, v: u32, w: u32) -> [f64; 3] {
        let [p, q] = [v, w].map(|v| self.after.points[v as usize]);
        let (p, q) = if p < q { (p, q) } else { (q, p) };
        let [d, e] = [p, q].map(|p| self.cut.plane.distance(p).abs());
        on_the_way(p, q, d / (d + e))
    }

    fn edge_point(&mut self, v: u32, w: u32, place: [f64; 3]) -> Double {
        let edge = (v.min(w), v.max(w));
        let known = self.on_edge.get(&edge).copied();
        let point = known.unwrap_or_else(|| self.double(place));
        assert_eq!(point.place, place, "both faces find one point");
        self.on_edge.insert(edge, point);
        point
    }

    fn double(&mut self, place: [f64; 3]) -> Double {
        Double {
            before: self.tip(place).before,
            behind: self.tip(place).behind,
            place,
        }
    }

    fn tip(&mut self, place: [f64; 3]) -> Double {
        self.after.points.push(place);
        let v = self.after.points.len() as u32 - 1;
        Double {
            place,
            before: v,
            behind: v,
        }
    }
}
