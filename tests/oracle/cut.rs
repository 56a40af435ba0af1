//! Cuts, as the soup sees them: insertions of which only a record tells, seams whose two sides are one
//! while they are closed, and gaps where only places count.

use std::collections::BTreeMap;

use super::{Child, Place, Soup, Spot, links_of, reversed, side};

impl Soup {
    /// Inserts the vertices of a cut, which alone knows its chords. The spots are read off the vertices that
    /// are told; a vertex on one side of a torn edge must have its twin on the other.
    pub(crate) fn insert_of_cut(&mut self, told: &[(u32, Place)], children: &[Child]) {
        let mut spots: Vec<Spot> = Vec::new();
        let mut left = told;
        while let [(_, place), rest @ ..] = left {
            let spot = self.spot(*place);
            let has_twin = match spot {
                Spot::Side { side, .. } => self
                    .links
                    .iter()
                    .any(|&link| link.contains(&side) && self.is_torn(link)),
                Spot::Inside { .. } => false,
            };
            left = if has_twin { &rest[1..] } else { rest };
            spots.push(spot);
        }
        let (places, _, _) = self.divide(&spots, children);
        assert_eq!(told, places, "the new vertices");
    }

    /// The spot of a place.
    fn spot(&self, place: Place) -> Spot {
        match place {
            Place::Edge { ends, t } => {
                let found = |wanted: [u32; 2]| {
                    let mut sides = (0..3 * self.faces.len()).map(|h| (h / 3, h % 3));
                    sides.find(|&(f, i)| side(self.faces[f], i) == wanted)
                };
                let (side, forward) = match found(ends) {
                    Some(side) => (side, true),
                    None => (found(reversed(ends)).expect("an edge"), false),
                };
                Spot::Side { side, t, forward }
            }
            Place::Face { vertices, weights } => {
                let face = self.faces.iter().position(|face| *face == vertices);
                Spot::Inside {
                    face: face.expect("a face"),
                    weights,
                }
            }
        }
    }

    /// Closes seams: each two sides of faces between the same two places, in opposite directions. Where copies
    /// of a vertex have slid apart, both sides of an edge may be between the same vertices and not the same
    /// places, once the other edges are closed: such an edge is one.
    pub(crate) fn close(&mut self, seams: &[[(usize, usize); 2]]) {
        self.open_class = Some(self.class.clone());
        let ends = seams.iter().map(|&[(f, i), (g, j)]| {
            let ([a, b], [c, d]) = (side(self.faces[f], i), side(self.faces[g], j));
            [[a, d], [b, c]].map(|ends| ends.map(|v| v as usize))
        });
        let (at_one_place, enclosed): (Vec<_>, Vec<_>) = ends.partition(|ends| {
            let mut ends = ends.iter();
            ends.all(|&[one, other]| self.points[one] == self.points[other])
        });
        for [one, other] in at_one_place.into_iter().flatten() {
            let [from, to] = [self.class[one], self.class[other]];
            for class in &mut self.class {
                *class = if *class == from { to } else { *class };
            }
        }
        for [one, other] in enclosed.into_iter().flatten() {
            assert_eq!(self.class[one], self.class[other], "not one edge");
        }
        self.renew_whole();
    }

    /// Opens the seams that were closed. What was inserted on them is on both sides, and is not one.
    pub(crate) fn open(&mut self) {
        self.class = self.open_class.take().expect("seams were closed");
        self.renew_whole();
    }

    fn renew_whole(&mut self) {
        let of_class = |face: &[u32; 3]| face.map(|v| self.class[v as usize]);
        self.whole = self.faces.iter().map(of_class).collect();
        self.links = links_of(&self.whole);
    }

    /// Gives the second of two new vertices, on the two sides of a torn edge with these ends, a class of its
    /// own for when seams are open, unless the edge is torn without them.
    pub(super) fn open_twin(&mut self, other: u32, [ends, across]: [[u32; 2]; 2]) {
        let Some(open) = &mut self.open_class else {
            return;
        };
        let is_one = |(a, b): (&u32, &u32)| open[*a as usize] == open[*b as usize];
        if !ends.iter().zip(&across).all(is_one) {
            open[other as usize] = self.classes;
            self.classes += 1;
        }
    }

    /// The lengths of all sides of faces that have no partner: another side between the same places, in the
    /// opposite direction.
    pub(crate) fn gaps(&self) -> Vec<f64> {
        let place = |v: u32| self.points[v as usize].map(|x| (x + 0.0).to_bits());
        let mut count = BTreeMap::<_, (isize, f64)>::new();
        for &face in &self.faces {
            for i in 0..3 {
                let [a, b] = side(face, i);
                let ([p, q], [from, to]) =
                    ([a, b].map(place), [a, b].map(|v| self.points[v as usize]));
                let apart = [0, 1, 2].map(|i| to[i] - from[i]);
                let length = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
                let (ends, sign) = if p < q { ([p, q], 1) } else { ([q, p], -1) };
                let known = count.entry(ends).or_insert((0, length));
                known.0 += if p == q { 0 } else { sign };
            }
        }
        let gaps = count.into_values().filter(|(count, _)| *count != 0);
        gaps.map(|(count, length)| count.unsigned_abs() as f64 * length)
            .collect()
    }

    /// The area of all faces.
    pub(crate) fn area(&self) -> f64 {
        let area = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| self.points[v as usize]);
            let ([ux, uy, uz], [vx, vy, vz]) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            (x * x + y * y + z * z).sqrt() / 2.0
        };
        self.faces.iter().map(area).sum()
    }
}
