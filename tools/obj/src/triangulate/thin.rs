//! Thin triangles, and the triangulation of a polygon that has the least thin ones.
//!
//! Corners on a line, rounded to the digits of a file, are a little beside it: a fan or an ear
//! there faces the viewer, and has next to no area. So where the usual triangulation of a polygon
//! has a thin triangle, the best of all is sought, by dynamic programming (Klincsek 1980): the best
//! of the corners from i to j is that of some third corner k on the side from i to j, with the best
//! from i to k and from k to j. What is made best is the thinnest triangle.
//!
//! O(n³), so only polygons of up to [`CORNERS_MAX`] corners are treated so: the time for a
//! hostile file stays bounded, and a modeller's polygon hardly has more. All others stay as they were
//! cut.

use tearmesh::Point;

use super::ears::{Flat, doubled_area};

/// The most corners of a polygon whose triangulations are all compared.
pub(super) const CORNERS_MAX: usize = 24;

/// A triangle is thin if its least altitude is a smaller part of its longest side. Six digits leave
/// a millionth of a face as large as a unit, and a thousandth of one that is a thousandth of it.
const THIN: f64 = 1e-3;

/// Twice the area and the longest side, both squared.
#[inline]
fn squares([a, b, c]: [Point; 3]) -> [f64; 2] {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let doubled_area = ab.cross(&ac).norm_squared();
    let sides = [ab, ac, bc].map(|side| side.norm_squared());
    [doubled_area, sides[0].max(sides[1]).max(sides[2])]
}

/// Whether a triangle is thin.
#[inline]
pub(super) fn is_thin(triangle: [Point; 3]) -> bool {
    let [doubled_area, longest] = squares(triangle);
    doubled_area < THIN * THIN * longest * longest
}

/// The square of the least altitude as a part of the longest side.
fn shape(triangle: [Point; 3]) -> f64 {
    let [doubled_area, longest] = squares(triangle);
    let shape = doubled_area / longest / longest;
    if shape.is_nan() { 0.0 } else { shape }
}

/// Replaces triangles of a polygon by those of its best triangulation, if one of theirs is thin
/// and the thinnest of the others is less so.
pub(super) fn thicken(flat: &[Flat], place: impl Fn(u16) -> Point, cut: &mut [[u16; 3]]) {
    let at = |triangle: [u16; 3]| triangle.map(&place);
    if flat.len() > CORNERS_MAX || !cut.iter().any(|&triangle| is_thin(at(triangle))) {
        return;
    }
    let is = cut.iter().map(|&triangle| shape(at(triangle)));
    let is = is.fold(f64::INFINITY, f64::min);
    let all = Best::of(flat, |triangle| shape(at(triangle)));
    if all.thinnest() > is {
        let mut triangles = cut.iter_mut();
        all.for_each([0, flat.len() as u16 - 1], &mut |triangle| {
            *triangles.next().expect("n − 2 triangles each") = triangle;
        });
    }
}

/// For each two corners of a polygon the best triangulation of those between.
struct Best {
    corners: usize,
    /// Its thinnest triangle, and the third corner of the one on the side between the two.
    table: Vec<(f64, u16)>,
}

impl Best {
    /// Of triangles that all face the viewer: those cover a simple polygon without overlap.
    fn of(flat: &[Flat], shape: impl Fn([u16; 3]) -> f64) -> Best {
        let corners = flat.len();
        let mut best = Best {
            corners,
            table: vec![(f64::INFINITY, 0); corners * corners],
        };
        for length in 2..corners {
            for first in 0..corners - length {
                let last = first + length;
                let mut found = (f64::NEG_INFINITY, first as u16 + 1);
                for third in first + 1..last {
                    let [i, k, j] = [first, third, last].map(|corner| corner as u16);
                    let parts = best.at(i, k).0.min(best.at(k, j).0);
                    if parts > found.0 && doubled_area(flat, i, k, j) > 0.0 {
                        let thinnest = parts.min(shape([i, k, j]));
                        if thinnest > found.0 {
                            found = (thinnest, k);
                        }
                    }
                }
                best.table[first * corners + last] = found;
            }
        }
        best
    }

    fn at(&self, first: u16, last: u16) -> (f64, u16) {
        self.table[usize::from(first) * self.corners + usize::from(last)]
    }

    /// The thinnest triangle; less than any if there is no triangulation.
    fn thinnest(&self) -> f64 {
        self.at(0, self.corners as u16 - 1).0
    }

    fn for_each(&self, [first, last]: [u16; 2], visit: &mut impl FnMut([u16; 3])) {
        if last - first < 2 {
            return;
        }
        let third = self.at(first, last).1;
        self.for_each([first, third], visit);
        visit([first, third, last]);
        self.for_each([third, last], visit);
    }
}
