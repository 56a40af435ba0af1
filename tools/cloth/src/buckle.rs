//! Bend constraints that buckle (Choi and Ko 2002 §4.2), colour by colour: the counterpart of the
//! springs in [`kernel`](crate::kernel).
//!
//! A [`Batch`] has c, the stiffness against compression, in the place of a spring's stiffness;
//! the law is one for all. A bend is made of these three where it is needed, which costs a few
//! products, and [`Bend`] says what it does. One without stiffness, which
//! is what an edit leaves where rounding left no length, does nothing.

use tearmesh::geometry::{Point, Vector, dot};

use crate::implicit::bend::Axial;
use crate::implicit::{Bend, Buckling};
use crate::kernel::Batch;

/// Bends of one colour, and their law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bends<'a> {
    pub(crate) batch: Batch<'a>,
    pub(crate) law: Buckling,
}

impl Bends<'_> {
    pub(crate) fn iter(&self) -> impl Iterator<Item = Bend> + '_ {
        let batch = self.batch;
        let numbers = batch.rest.iter().zip(batch.stiffness);
        let bends = batch
            .ends
            .iter()
            .zip(numbers)
            .filter(|(_, (_, c))| **c > 0.0);
        bends.map(|(&ends, (&rest, &c))| self.law.bend(ends, rest, c))
    }

    /// Adds the forces to those of the ends. False where a bend is longer than `ratio_max` times
    /// its rest length, or not a number.
    #[must_use]
    pub(crate) fn forces(
        &self,
        positions: &[Point],
        ratio_max: f64,
        forces: &mut [Vector],
    ) -> bool {
        let mut sane = true;
        for bend in self.iter() {
            let [a, b] = bend.ends().map(|end| end as usize);
            let d = positions[b] - positions[a];
            let length = dot(d, d).sqrt();
            sane &= length <= ratio_max * bend.rest_length();
            if length > 0.0 {
                let force = d * (bend.axial(length).force / length);
                forces[a] += force;
                forces[b] -= force;
            }
        }
        sane
    }

    /// Whether no bend is longer than `ratio_max` times its rest length, or not a number.
    #[must_use]
    pub(crate) fn are_within(&self, positions: &[Point], ratio_max: f64) -> bool {
        self.iter().all(|bend| {
            let [a, b] = bend.ends().map(|end| end as usize);
            let d = positions[b] - positions[a];
            dot(d, d).sqrt() <= ratio_max * bend.rest_length()
        })
    }

    /// The energy, summed in order.
    #[must_use]
    pub(crate) fn energy(&self, positions: &[Point]) -> f64 {
        let of = |bend: Bend| {
            let [a, b] = bend.ends().map(|end| end as usize);
            let d = positions[b] - positions[a];
            bend.axial(dot(d, d).sqrt()).energy
        };
        self.iter().map(of).sum()
    }

    /// Adds K u. All force here is compression, so what acts across a bend counts as zero.
    pub(crate) fn stiffness_times(
        &self,
        slope: Slope,
        positions: &[Point],
        u: &[Vector],
        product: &mut [Vector],
    ) {
        for bend in self.iter() {
            let [a, b] = bend.ends().map(|end| end as usize);
            let change = self.pull(&bend, slope, positions[b] - positions[a], u[b] - u[a]);
            product[a] -= change;
            product[b] += change;
        }
    }

    /// The change of a bend's force when its vector `d` changes by `u`.
    #[must_use]
    pub(crate) fn pull(&self, bend: &Bend, slope: Slope, d: Vector, u: Vector) -> Vector {
        let square = dot(d, d);
        let stiffness = match slope {
            Slope::Now => bend.axial(square.sqrt()).slope,
            Slope::Steepest => bend.compression() * self.law.stiffest(),
        };
        if square == 0.0 {
            return u * stiffness;
        }
        d * (dot(d, u) / square * stiffness)
    }
}

/// Which stiffness of a bend counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slope {
    /// That at its present length.
    Now,
    /// The largest that it has at any. A flat cloth has none to bends, and gets stiffer as it
    /// folds; so the stability limit is asked with this.
    Steepest,
}

/// Energy, force and slope of a bend with its ends so far apart.
#[must_use]
pub(crate) fn axial(law: Buckling, rest: f64, stiffness: f64, distance: f64) -> Axial {
    if stiffness > 0.0 {
        law.bend([0, 1], rest, stiffness).axial(distance)
    } else {
        Axial::default()
    }
}
