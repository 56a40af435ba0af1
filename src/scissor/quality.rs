//! The worst of many triangles: the smallest angle and the smallest altitude.

use std::ops::Range;

use crate::geometry::{Point, altitude, angle, cross, dot, length};

/// The smallest angle and the smallest altitude of some triangles.
#[derive(Clone)]
pub(super) struct Quality {
    /// Of the smallest angle, which has the largest: it needs no arc function.
    cotangent_max: f64,
    /// The two numbers of which that is the quotient.
    along_and_across: [f64; 2],
    altitude_min: f64,
}

/// By what part rounding makes nothing larger that was not: far more than it does.
pub(super) const MARGIN: f64 = 1e-6;

/// The squares of lengths whose squares in turn neither vanish nor overflow.
const USABLE_SQUARES: Range<f64> = 1e-100..1e100;

impl Quality {
    pub(super) const OF_NOTHING: Quality = Quality {
        cotangent_max: f64::NEG_INFINITY,
        along_and_across: [0.0; 2],
        altitude_min: f64::INFINITY,
    };

    /// Whether the [`squares_of_sides`] of a triangle alone tell that adding it would change nothing:
    /// roots and quotients are for the few that could be the worst.
    #[inline]
    pub(super) fn is_surely_better(&self, squares: [f64; 3]) -> bool {
        let larger = |x: f64, y: f64| if x > y { x } else { y };
        let smaller = |x: f64, y: f64| if x < y { x } else { y };
        let longest = larger(larger(squares[0], squares[1]), squares[2]);
        let shortest = smaller(smaller(squares[0], squares[1]), squares[2]);
        let sum = squares[0] + squares[1] + squares[2];
        // The product of the two longer sides by the law of cosines, and by Lagrange's identity the
        // square of twice the area: good to the margin unless the triangle is as thin as that.
        let along = sum / 2.0 - shortest;
        let area = longest * (sum - longest - shortest) - along * along;
        let along_max = along + sum * MARGIN;
        let cotangent = larger(self.cotangent_max, 0.0);
        USABLE_SQUARES.contains(&longest)
            && area > longest * longest * MARGIN
            && area > longest * self.altitude_min * self.altitude_min * (1.0 + MARGIN)
            && area * cotangent * cotangent > along_max * along_max
    }

    /// Looks at one more triangle.
    #[cold]
    pub(super) fn add(&mut self, [a, b, c]: [Point; 3]) {
        self.altitude_min = self.altitude_min.min(altitude([a, b, c]));
        for (corner, one, other) in [(a, b, c), (b, c, a), (c, a, b)] {
            let along = dot(one - corner, other - corner);
            let across = length(cross(one - corner, other - corner));
            let cotangent = if across > 0.0 {
                along / across
            } else if along >= 0.0 {
                f64::INFINITY
            } else {
                f64::NEG_INFINITY
            };
            if cotangent > self.cotangent_max {
                self.cotangent_max = cotangent;
                self.along_and_across = [along, across];
            }
        }
    }

    /// The smallest angle in degrees; 0 where there was no triangle.
    pub(super) fn angle_min_deg(&self) -> f64 {
        let [along, across] = self.along_and_across;
        angle(along, across) * (180.0 / std::f64::consts::PI)
    }

    /// The smallest altitude; 0 where there was no triangle.
    pub(super) fn altitude_min(&self) -> f64 {
        if self.altitude_min == f64::INFINITY {
            return 0.0;
        }
        self.altitude_min
    }
}

/// The squares of the lengths of the sides of a triangle, in turn from the first corner.
#[inline]
pub(super) fn squares_of_sides([a, b, c]: [Point; 3]) -> [f64; 3] {
    [b - a, c - b, a - c].map(|side| dot(side, side))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place(size: f64) -> impl Strategy<Value = Point> {
        let coordinate = move || prop_oneof![4 => -size..size, 1 => Just(0.0)];
        [coordinate(), coordinate(), coordinate()].prop_map(Point::from)
    }

    /// Triangles that differ by any part, of any shape and size: as thin as cannot be told from a line,
    /// and so small or large that their squares are no numbers to go by.
    fn alike() -> impl Strategy<Value = Vec<[Point; 3]>> {
        let corners = [place(1.0), place(1.0), place(1.0)];
        let thinness = prop_oneof![Just(1.0), Just(1e-4), Just(1e-9)];
        let exponent = prop_oneof![4 => -2..3, 2 => -82..-74, 1 => -170..150];
        let by = (-9..0).prop_flat_map(|e| {
            let off = move || place(10f64.powi(e));
            prop::collection::vec([off(), off(), off()], 1..20)
        });
        let base = (corners, thinness, exponent, by);
        base.prop_map(|([a, b, c], thinness, exponent, by)| {
            let scale = 10f64.powi(exponent);
            let c = a + (b - a) * 0.3 + (c - a) * thinness;
            let moved = |off: [Point; 3]| {
                let corners = [a, b, c].into_iter().zip(off);
                let mut corners = corners.map(|(p, off)| (p + off.coords * thinness) * scale);
                [(); 3].map(|()| corners.next().expect("a triangle has three corners"))
            };
            by.into_iter().map(moved).collect()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 4096,
            failure_persistence: None,
            ..ProptestConfig::default()
        })]
        #[test]
        fn what_squares_alone_rule_out_would_have_changed_nothing(triangles in alike()) {
            let (mut quick, mut all) = (Quality::OF_NOTHING, Quality::OF_NOTHING);
            for &triangle in &triangles {
                if !quick.is_surely_better(squares_of_sides(triangle)) {
                    quick.add(triangle);
                }
                all.add(triangle);
            }
            prop_assert_eq!(quick.altitude_min().to_bits(), all.altitude_min().to_bits());
            prop_assert_eq!(quick.angle_min_deg().to_bits(), all.angle_min_deg().to_bits());
        }
    }
}
