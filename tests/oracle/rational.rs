//! The exact cut of a flat sheet in fractions, face by face, as plainly as possible.
//!
//! A sheet is a list of triangles over points whose coordinates are fractions. A line divides each triangle
//! that has corners on both sides of it: the corners and the places where the line crosses edges are new
//! corners, one for each edge. Then faces that share a corner on the line, but have no way to each other
//! round it that does not cross the line, get corners of their own. Nothing is rounded, so nothing has to be
//! near anything. Where a quadrangle has two diagonals, whoever is compared says which.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::joined_sets;

/// A fraction in lowest terms, with a denominator above zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fraction(i128, i128);

impl Fraction {
    pub(crate) fn new(above: i128, below: i128) -> Fraction {
        let (mut a, mut b) = (above.abs(), below.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let divisor = a.max(1) * below.signum();
        Fraction(above / divisor, below / divisor)
    }

    fn plus(self, other: Fraction) -> Fraction {
        Fraction::new(self.0 * other.1 + other.0 * self.1, self.1 * other.1)
    }

    fn times(self, other: Fraction) -> Fraction {
        Fraction::new(self.0 * other.0, self.1 * other.1)
    }

    fn minus(self, other: Fraction) -> Fraction {
        self.plus(Fraction(-other.0, other.1))
    }

    fn over(self, other: Fraction) -> Fraction {
        self.times(Fraction::new(other.1, other.0))
    }

    fn sign(self) -> Ordering {
        self.0.cmp(&0)
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.0 as f64 / self.1 as f64
    }
}

/// A line: where `x[0] * line[0] + x[1] * line[1]` is `line[2]`.
pub(crate) type Line = [i128; 3];

/// A flat sheet of triangles.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) points: Vec<[Fraction; 2]>,
    pub(crate) faces: Vec<[usize; 3]>,
}

impl Sheet {
    /// Cuts along a line. `has_edge` says whether there is to be an edge between two points, one of the
    /// diagonals of a quadrangle; `false` for the other one.
    pub(crate) fn cut(&mut self, line: Line, has_edge: impl Fn([[Fraction; 2]; 2]) -> bool) {
        let whole = |number| Fraction::new(number, 1);
        let offset = |point: &[Fraction; 2]| {
            let [x, y] = [0, 1].map(|axis| point[axis].times(whole(line[axis])));
            x.plus(y).minus(whole(line[2]))
        };
        let mut offsets: Vec<Fraction> = self.points.iter().map(offset).collect();
        let mut crossings: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut faces = Vec::new();
        for face in std::mem::take(&mut self.faces) {
            // The outline with the crossings, and what of it is on either side.
            let mut outline = Vec::new();
            for i in 0..3 {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                outline.push(a);
                let signs = [a, b].map(|v| offsets[v].sign());
                if signs[0] == signs[1].reverse() && signs[0] != Ordering::Equal {
                    let crossing = *crossings.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        let t = offsets[a].over(offsets[a].minus(offsets[b]));
                        let [p, q] = [a, b].map(|v| self.points[v]);
                        let at = [0, 1].map(|x| p[x].plus(t.times(q[x].minus(p[x]))));
                        self.points.push(at);
                        offsets.push(whole(0));
                        self.points.len() - 1
                    });
                    outline.push(crossing);
                }
            }
            let signs = || face.iter().map(|&v| offsets[v].sign());
            if !(signs().any(Ordering::is_lt) && signs().any(Ordering::is_gt)) {
                faces.push(face);
                continue;
            }
            for not in [Ordering::Less, Ordering::Greater] {
                let corners = outline.iter().copied();
                let side: Vec<usize> = corners.filter(|&v| offsets[v].sign() != not).collect();
                match side[..] {
                    [a, b, c] => faces.push([a, b, c]),
                    [a, b, c, d] if has_edge([a, c].map(|v| self.points[v])) => {
                        faces.extend([[a, b, c], [a, c, d]]);
                    }
                    [a, b, c, d] => faces.extend([[a, b, d], [b, c, d]]),
                    _ => panic!("a line divides a triangle into triangles and quadrangles"),
                }
            }
        }
        self.faces = faces;
        self.separate(&offsets);
    }

    /// Gives faces a corner on the line of their own unless they have a way to each other round it, through
    /// edges that have both of their faces on one side.
    fn separate(&mut self, offsets: &[Fraction]) {
        // What was made here is on the line.
        let is_in_front = |v: usize| offsets.get(v).is_some_and(|offset| offset.sign().is_gt());
        let is_front = |face: [usize; 3]| face.into_iter().any(is_in_front);
        for (v, offset) in offsets.iter().enumerate() {
            if offset.sign() != Ordering::Equal {
                continue;
            }
            let at: Vec<usize> = (0..self.faces.len())
                .filter(|&f| self.faces[f].contains(&v))
                .collect();
            let mut joined = Vec::new();
            for i in 0..at.len() {
                for j in i + 1..at.len() {
                    let [one, other] = [at[i], at[j]].map(|f| self.faces[f]);
                    let common = one.iter().filter(|w| other.contains(w)).count();
                    if common == 2 && is_front(one) == is_front(other) {
                        joined.push([i, j]);
                    }
                }
            }
            let fans = joined_sets(at.len(), &joined);
            let mut own: BTreeMap<usize, usize> = BTreeMap::new();
            for (i, &f) in at.iter().enumerate() {
                let is_first = own.is_empty();
                let corner = *own.entry(fans[i]).or_insert_with(|| {
                    if is_first {
                        return v;
                    }
                    self.points.push(self.points[v]);
                    self.points.len() - 1
                });
                let corners = self.faces[f].iter_mut();
                corners.filter(|w| **w == v).for_each(|w| *w = corner);
            }
        }
    }
}
