//! One face and its new points, to triangles.
//!
//! Everything is told in parts of the face that is divided: a node has the weights of the three
//! corners, and the determinant of three nodes is the part of the face's area between them. So
//! the result does not depend on where the corners are.
//!
//! * Points inside: the first is joined to the whole outline; each further one to the corners
//!   of the triangle in which it then lies, or, on an edge between two of them, to those of both.
//! * Points on edges alone: a chord divides the face, that which was asked for or the one
//!   that two points on different edges (or one point and the corner opposite) have anyway.
//!   Each side is a convex polygon, and of all its triangulations the one is taken whose smallest
//!   triangle is largest. For the quad p, b, c, q that a cut with `p` on ab at s and `q` on ac
//!   at t leaves, that is the diagonal p–c where s >= t, and else q–b: the rule under
//!   which no altitude is smaller than r (1 − r) of the parent's where r <= s, t <= 1 − r.

use super::plan::{InsertRefusal, PointId};
use crate::edit::Mix;
use crate::exact::ROUNDING;
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A corner or a new point of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) vertex: VertexId,
    pub(super) source: Mix<HalfEdgeId>,
    /// The point of the plan, for one on an edge.
    pub(super) point: Option<PointId>,
    /// The weights of the corners.
    at: [f64; 3],
}

/// A face that is being divided. Reused from face to face.
#[derive(Debug, Default)]
pub(super) struct Retriangulation {
    /// The outline, counter-clockwise from the first corner, then the points inside.
    pub(super) nodes: Vec<Node>,
    /// The nodes of the corners.
    pub(super) corners: [usize; 3],
    /// How many nodes the outline has.
    pub(super) ring: usize,
    /// Edges that are required between two nodes of the outline, the earlier one first.
    pub(super) chords: Vec<[usize; 2]>,
    pub(super) triangles: Vec<[usize; 3]>,
    /// Scratch for [`Retriangulation::fill`]: the best smallest area of each part of a
    /// polygon, and the node that gives it.
    best: Vec<(f64, usize)>,
}

impl Retriangulation {
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.ring = 0;
        self.chords.clear();
        self.triangles.clear();
    }

    /// Adds the next node: a corner or a point on an edge to the outline, and once that is complete
    /// a point inside.
    pub(super) fn push(
        &mut self,
        vertex: VertexId,
        source: Mix<HalfEdgeId>,
        point: Option<PointId>,
    ) {
        if let Mix::Copy(h) = source {
            self.corners[h.corner()] = self.ring;
        }
        self.ring += usize::from(!matches!(source, Mix::Weighted { .. }));
        self.nodes.push(Node {
            vertex,
            source,
            point,
            at: source.weights(),
        });
    }

    /// The part of the face that a triangle of nodes covers, with a sign.
    pub(super) fn share(&self, [a, b, c]: [usize; 3]) -> f64 {
        let [a, b, c] = [a, b, c].map(|n| self.nodes[n].at);
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    pub(super) fn run(&mut self, face: FaceId) -> Result<(), InsertRefusal> {
        if self.nodes.len() > self.ring {
            if !self.chords.is_empty() {
                return Err(InsertRefusal::Chord { face });
            }
            return self.star().ok_or(InsertRefusal::Crowded { face });
        }
        match self.chords.last().copied().or_else(|| self.implied_chord()) {
            Some(ends) => self.halves(ends).ok_or(InsertRefusal::Chord { face })?,
            None => self.fill(&(0..self.ring).collect::<Vec<usize>>()),
        }
        // Near a corner a child may be smaller than any `f64`.
        let mut shares = self.triangles.iter().map(|&triangle| self.share(triangle));
        match shares.find(|&share| share <= 0.0) {
            Some(share) => Err(InsertRefusal::Share { face, share }),
            None => Ok(()),
        }
    }

    /// The chord that any triangulation has: of a point and the corner opposite, or of points on
    /// two edges.
    fn implied_chord(&self) -> Option<[usize; 2]> {
        let edge_of = |n: usize| (0..3).rev().find(|&corner| self.corners[corner] <= n);
        let mut points = (0..self.ring).filter(|n| !self.corners.contains(n));
        let (first, second) = (points.next()?, points.next());
        let ends = match second {
            None => [first, self.corners[(edge_of(first)? + 2) % 3]],
            Some(second) => [first, second],
        };
        let apart = second.is_none_or(|second| edge_of(first) != edge_of(second));
        (apart && points.next().is_none()).then_some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    }

    /// `None` where a chord does not divide the face, or crosses another.
    fn halves(&mut self, [one, other]: [usize; 2]) -> Option<()> {
        let near: Vec<usize> = (one..=other).collect();
        let far: Vec<usize> = (other..self.ring).chain(0..=one).collect();
        if self.chords.len() > 1 || self.is_flat(&near) || self.is_flat(&far) {
            return None;
        }
        self.fill(&near);
        self.fill(&far);
        Some(())
    }

    /// Whether all nodes of a part of the outline lie on one edge.
    fn is_flat(&self, part: &[usize]) -> bool {
        (0..3).any(|corner| part.iter().all(|&n| self.nodes[n].at[corner] == 0.0))
    }

    /// Triangulates a convex polygon so that its smallest triangle is as large as can be; of
    /// equals, the one with the later third node is taken.
    fn fill(&mut self, polygon: &[usize]) {
        let n = polygon.len();
        if n == 3 {
            self.triangles.push([polygon[0], polygon[1], polygon[2]]);
            return;
        }
        // best[i, j]: how to fill the part from node i to node j, by the third node of the
        // triangle on the side that closes it.
        let mut best = std::mem::take(&mut self.best);
        best.clear();
        best.resize(n * n, (f64::INFINITY, 0));
        for span in 2..n {
            for i in 0..n - span {
                let j = i + span;
                let mut choice = (f64::NEG_INFINITY, i + 1);
                for k in i + 1..j {
                    let area = self.share([polygon[i], polygon[k], polygon[j]]);
                    // Where all three are on one edge the area is an exact zero.
                    let least = area.min(best[i * n + k].0).min(best[k * n + j].0);
                    if least >= choice.0 {
                        choice = (least, k);
                    }
                }
                best[i * n + j] = choice;
            }
        }
        let mut open = vec![[0, n - 1]];
        while let Some([i, j]) = open.pop() {
            if j > i + 1 {
                let k = best[i * n + j].1;
                self.triangles.push([polygon[i], polygon[k], polygon[j]]);
                open.extend([[k, j], [i, k]]);
            }
        }
        self.best = best;
    }

    /// Joins the points inside to what is round them; `None` where they cannot be told apart.
    fn star(&mut self) -> Option<()> {
        let centre = self.ring;
        for n in 0..self.ring {
            self.triangles.push([centre, n, (n + 1) % self.ring]);
        }
        for point in centre + 1..self.nodes.len() {
            self.locate(point)?;
        }
        let vanishing = |&t: &[usize; 3]| self.share(t) <= 0.0;
        (!self.triangles.iter().any(vanishing)).then_some(())
    }

    /// Joins a point to the corners of the triangle in which it lies, or to those of two.
    fn locate(&mut self, point: usize) -> Option<()> {
        // The parts into which the point divides a triangle, each opposite to a corner.
        let parts = |[a, b, c]: [usize; 3]| {
            [[point, b, c], [a, point, c], [a, b, point]].map(|part| self.share(part))
        };
        let depth =
            |&(_, parts): &(usize, [f64; 3])| parts.into_iter().fold(f64::INFINITY, f64::min);
        let (home, parts) = self
            .triangles
            .iter()
            .map(|&triangle| parts(triangle))
            .enumerate()
            .max_by(|a, b| depth(a).total_cmp(&depth(b)))?;
        let thin: Vec<usize> = (0..3).filter(|&i| parts[i] <= ROUNDING).collect();
        let [a, b, c] = self.triangles[home];
        match thin[..] {
            [] => {
                self.triangles[home] = [a, b, point];
                self.triangles.extend([[b, c, point], [c, a, point]]);
                Some(())
            }
            [opposite] => {
                let turned = [[a, b, c], [b, c, a], [c, a, b]][opposite];
                self.divide_edge(home, turned, point)
            }
            _ => None,
        }
    }

    /// Puts a point on the edge b–c of the triangle `home`, and so also into the one across.
    fn divide_edge(&mut self, home: usize, [a, b, c]: [usize; 3], point: usize) -> Option<()> {
        let across = |&[d, e, f]: &[usize; 3]| {
            let turns = [[d, e, f], [e, f, d], [f, d, e]];
            turns.into_iter().find(|turned| turned[1..] == [c, b])
        };
        let mut triangles = self.triangles.iter().enumerate();
        let (other, [apex, ..]) = triangles.find_map(|(i, t)| Some((i, across(t)?)))?;
        self.triangles[home] = [a, b, point];
        self.triangles[other] = [apex, c, point];
        self.triangles.extend([[a, point, c], [apex, point, b]]);
        Some(())
    }
}
