//! Springs: energy, force and stiffness, and projection onto the rest length.
//!
//! E = ½ k (l − L)², with k the stiffness, l the length and L that at rest. The force is k (l − L)
//! along the spring; across it the stiffness is k (1 − L/l), which is negative under compression.
//!
//! The methods that project move the ends instead, colour by colour: no two springs of one colour
//! share a particle, so the loops have no chain of writes that wait for each other, and the result
//! does not depend on the order within a colour.

use tearmesh::geometry::{Point, Vector, dot};

use crate::constraint::{Batch, TOGETHER};
use crate::pair::{Law, Link, length};

/// The law of springs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hooke;

impl Law for Hooke {
    type Link = Spring;

    #[inline]
    fn link(self, rest_length_m: f64, stiffness_n_per_m: f64) -> Option<Spring> {
        Some(Spring {
            rest: rest_length_m,
            stiffness: stiffness_n_per_m,
        })
    }

    fn stiffest(self) -> f64 {
        1.0
    }
}

/// A spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    rest: f64,
    stiffness: f64,
}

impl Link for Spring {
    #[inline]
    fn twice_energy(self, length: f64) -> f64 {
        let extension = length - self.rest;
        self.stiffness * extension * extension
    }

    #[inline]
    fn force(self, length: f64) -> f64 {
        self.stiffness * (length - self.rest)
    }

    #[inline]
    fn damped_stiffness(self) -> f64 {
        self.stiffness
    }
    #[inline]
    fn stiffness(self, length: f64) -> [f64; 2] {
        let across = self.stiffness * ((length - self.rest) / length);
        [self.stiffness, across]
    }
}

/// Moves the ends of each constraint by the part `fraction` of the way to its rest length, by
/// inverse mass (Müller et al. 2007, §3.3). Multipliers accumulate, as in
/// [`project_compliant`] without compliance. False where a constraint is longer than `ratio_max`
/// times its rest length, or not a number: it is left as it is, and the rest of the colour too.
#[must_use]
pub(crate) fn project(
    batch: Batch<'_>,
    multipliers: &mut [f64],
    inverse_masses: &[f64],
    fraction: f64,
    ratio_max: f64,
    positions: &mut [Point],
) -> bool {
    let change = |rest: f64, multiplier: &mut f64, length: f64, w: f64| {
        let change = fraction * (length - rest) / (length * w);
        let change = if w > 0.0 && length > 0.0 { change } else { 0.0 };
        *multiplier -= change * length;
        change
    };
    let inverse_masses = &inverse_masses[..positions.len()];
    let (ends, last_ends) = batch.ends.as_chunks::<TOGETHER>();
    let (rest, last_rest) = batch.rest.as_chunks::<TOGETHER>();
    let (multipliers, last_multipliers) = multipliers.as_chunks_mut::<TOGETHER>();
    for (ends, (rest, multipliers)) in ends.iter().zip(rest.iter().zip(multipliers)) {
        let change = |i: usize, length, w| change(rest[i], &mut multipliers[i], length, w);
        let longest = rest.map(|rest| ratio_max * rest);
        if !approach(ends, longest, inverse_masses, positions, change) {
            return false;
        }
    }
    let numbers = last_rest.iter().zip(last_multipliers);
    for (&ends, (&rest, multiplier)) in last_ends.iter().zip(numbers) {
        let change = |_, length, w| change(rest, multiplier, length, w);
        let longest = [ratio_max * rest];
        if !approach(&[ends], longest, inverse_masses, positions, change) {
            return false;
        }
    }
    true
}

/// One sweep of XPBD: C = l − L, α̃ = `scale` / k, and multipliers that accumulate
/// (Macklin et al. 2016, equation 18). The first sweep writes multipliers and reads none. False as
/// in [`project`].
#[must_use]
pub(crate) fn project_compliant<const IS_FIRST: bool>(
    batch: Batch<'_>,
    multipliers: &mut [f64],
    inverse_masses: &[f64],
    scale: f64,
    ratio_max: f64,
    positions: &mut [Point],
) -> bool {
    let change = |rest: f64, compliance: f64, multiplier: &mut f64, length: f64, w: f64| {
        let before = if IS_FIRST { 0.0 } else { *multiplier };
        let compliance = scale * compliance;
        // −Δλ / l: one division for both.
        let change = (length - rest + compliance * before) / ((w + compliance) * length);
        // Between two that are held it moves nothing, and is the force of the spring.
        let change = if length > 0.0 { change } else { 0.0 };
        *multiplier = before - change * length;
        change
    };
    let inverse_masses = &inverse_masses[..positions.len()];
    let (ends, last_ends) = batch.ends.as_chunks::<TOGETHER>();
    let (rest, last_rest) = batch.rest.as_chunks::<TOGETHER>();
    let (compliance, last_compliance) = batch.compliance.as_chunks::<TOGETHER>();
    let (multipliers, last_multipliers) = multipliers.as_chunks_mut::<TOGETHER>();
    let numbers = rest.iter().zip(compliance).zip(multipliers);
    for (ends, ((rest, compliance), multipliers)) in ends.iter().zip(numbers) {
        let change =
            |i: usize, length, w| change(rest[i], compliance[i], &mut multipliers[i], length, w);
        let longest = rest.map(|rest| ratio_max * rest);
        if !approach(ends, longest, inverse_masses, positions, change) {
            return false;
        }
    }
    let numbers = last_rest.iter().zip(last_compliance).zip(last_multipliers);
    for (&ends, ((&rest, &compliance), multiplier)) in last_ends.iter().zip(numbers) {
        let change = |_, length, w| change(rest, compliance, multiplier, length, w);
        let longest = [ratio_max * rest];
        if !approach(&[ends], longest, inverse_masses, positions, change) {
            return false;
        }
    }
    true
}

/// Moves the ends of some constraints of one colour toward each other, by inverse mass and by so
/// many times their difference as `change` makes of their index, their length and the sum of
/// their inverse masses. None, and false, where one is longer than its `longest`, or not a number.
#[inline(always)]
fn approach<const N: usize>(
    ends: &[[u32; 2]; N],
    longest: [f64; N],
    inverse_masses: &[f64],
    positions: &mut [Point],
    mut change: impl FnMut(usize, f64, f64) -> f64,
) -> bool {
    let (mut d, mut squares, mut weights) = ([Vector::zeros(); N], [0.0; N], [0.0; N]);
    for i in 0..N {
        let [a, b] = ends[i].map(|end| end as usize);
        d[i] = positions[b] - positions[a];
        squares[i] = dot(d[i], d[i]);
        weights[i] = inverse_masses[a] + inverse_masses[b];
    }
    let mut changes = [0.0; N];
    let mut sane = true;
    for i in 0..N {
        let length = squares[i].sqrt();
        sane &= length <= longest[i];
        changes[i] = change(i, length, weights[i]);
    }
    if !sane {
        return false;
    }
    for i in 0..N {
        let [a, b] = ends[i].map(|end| end as usize);
        let step = d[i] * changes[i];
        positions[a] += step * inverse_masses[a];
        positions[b] -= step * inverse_masses[b];
    }
    true
}

/// Shortens each constraint that is longer than `ratio` times its rest length to that length
/// (Provot 1995, §4), and returns the largest l / L that it met. Multipliers accumulate, as in
/// [`project`].
#[must_use]
pub(crate) fn limit(
    batch: Batch<'_>,
    multipliers: &mut [f64],
    inverse_masses: &[f64],
    ratio: f64,
    positions: &mut [Point],
) -> f64 {
    let mut largest = 0.0_f64;
    let constraints = batch.ends.iter().zip(batch.rest);
    for ((&ends, &rest), multiplier) in constraints.zip(multipliers) {
        let [a, b] = ends.map(|end| end as usize);
        let d = positions[b] - positions[a];
        let length = dot(d, d).sqrt();
        largest = largest.max(length / rest);
        let (wa, wb) = (inverse_masses[a], inverse_masses[b]);
        let w = wa + wb;
        if length > ratio * rest && w > 0.0 {
            *multiplier -= (length - ratio * rest) / w;
            let step = d * ((length - ratio * rest) / (length * w));
            positions[a] += step * wa;
            positions[b] -= step * wb;
        }
    }
    largest
}

/// Writes the length of each constraint as a multiple of its rest length.
pub(crate) fn ratios(batch: Batch<'_>, positions: &[Point], ratios: &mut [f64]) {
    let constraints = batch.ends.iter().zip(batch.rest);
    for ((&ends, &rest), ratio) in constraints.zip(ratios) {
        *ratio = length(positions, ends.map(|end| end as usize)) / rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 2 * TOGETHER + 5;

    /// Constraints of one colour: some with one end held, one with both, one without length.
    struct Pairs {
        ids: Vec<u32>,
        ends: Vec<[u32; 2]>,
        rest: Vec<f64>,
        stiffness: Vec<f64>,
        compliance: Vec<f64>,
        inverse_masses: Vec<f64>,
        positions: Vec<Point>,
    }

    impl Pairs {
        fn new() -> Pairs {
            let mut state = 1_u64;
            let mut random = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (state >> 40) as f64 / (1_u64 << 24) as f64
            };
            let mut point = || Point::new(random(), random(), random());
            let mut positions: Vec<Point> = (0..2 * COUNT).map(|_| point()).collect();
            positions[14] = positions[15];
            let mut inverse_masses: Vec<f64> = (0..2 * COUNT).map(|_| 1.0 + random()).collect();
            inverse_masses.iter_mut().step_by(3).for_each(|w| *w = 0.0);
            inverse_masses[10..12].fill(0.0);
            let stiffness: Vec<f64> = (0..COUNT).map(|_| 1.0 + 9.0 * random()).collect();
            Pairs {
                ids: (0..COUNT as u32).collect(),
                ends: (0..COUNT as u32).map(|i| [2 * i, 2 * i + 1]).collect(),
                rest: (0..COUNT).map(|_| 0.1 + random()).collect(),
                compliance: stiffness.iter().map(|k| 1.0 / k).collect(),
                stiffness,
                inverse_masses,
                positions,
            }
        }

        fn batch(&self) -> Batch<'_> {
            Batch {
                ids: &self.ids,
                ends: &self.ends,
                rest: &self.rest,
                stiffness: &self.stiffness,
                compliance: &self.compliance,
            }
        }

        /// Moves the ends of a constraint by a part of their difference; by none where there is
        /// no length, or both are held.
        fn move_one(&self, i: usize, change: f64, positions: &mut [Point]) {
            let d = self.positions[2 * i + 1] - self.positions[2 * i];
            if self.weight(i) > 0.0 && self.length(i) > 0.0 {
                positions[2 * i] += d * change * self.inverse_masses[2 * i];
                positions[2 * i + 1] -= d * change * self.inverse_masses[2 * i + 1];
            }
        }

        fn length(&self, i: usize) -> f64 {
            let d = self.positions[2 * i + 1] - self.positions[2 * i];
            (d.x * d.x + d.y * d.y + d.z * d.z).sqrt()
        }

        fn weight(&self, i: usize) -> f64 {
            self.inverse_masses[2 * i] + self.inverse_masses[2 * i + 1]
        }
    }

    #[test]
    fn what_is_projected_together_is_what_it_would_be_one_by_one() {
        let pairs = Pairs::new();
        let mut expected = pairs.positions.clone();
        let mut expected_multipliers = Vec::new();
        for i in 0..COUNT {
            let (length, w) = (pairs.length(i), pairs.weight(i));
            let change = 0.7 * (length - pairs.rest[i]) / (length * w);
            pairs.move_one(i, change, &mut expected);
            let moves = w > 0.0 && length > 0.0;
            expected_multipliers.push(0.25 - if moves { change * length } else { 0.0 });
        }
        let mut positions = pairs.positions.clone();
        let (batch, w) = (pairs.batch(), &pairs.inverse_masses);
        let mut multipliers = vec![0.25; COUNT];
        assert!(project(
            batch,
            &mut multipliers,
            w,
            0.7,
            100.0,
            &mut positions
        ));
        assert_eq!(positions, expected);
        assert_eq!(multipliers, expected_multipliers);
        assert_ne!(positions, pairs.positions);
    }

    #[test]
    fn the_first_sweep_reads_no_multiplier_and_the_next_reads_that() {
        let pairs = Pairs::new();
        let scale = 3.0;
        for (first, mut multipliers) in [(true, vec![f64::NAN; COUNT]), (false, vec![0.25; COUNT])]
        {
            let mut expected = pairs.positions.clone();
            let mut expected_multipliers = Vec::new();
            for (i, &multiplier) in multipliers.iter().enumerate() {
                let before = if first { 0.0 } else { multiplier };
                let (length, w) = (pairs.length(i), pairs.weight(i));
                let compliance = scale * (1.0 / pairs.stiffness[i]);
                let error = length - pairs.rest[i] + compliance * before;
                let change = error / ((w + compliance) * length);
                pairs.move_one(i, change, &mut expected);
                let pulls = length > 0.0;
                expected_multipliers.push(before - if pulls { change * length } else { 0.0 });
            }
            let mut positions = pairs.positions.clone();
            let (batch, w) = (pairs.batch(), &pairs.inverse_masses);
            let sane = if first {
                project_compliant::<true>(batch, &mut multipliers, w, scale, 100.0, &mut positions)
            } else {
                project_compliant::<false>(batch, &mut multipliers, w, scale, 100.0, &mut positions)
            };
            assert!(sane);
            assert_eq!(positions, expected);
            assert_eq!(multipliers, expected_multipliers);
        }
    }

    #[test]
    fn one_constraint_beyond_all_measure_is_noticed_wherever_it_is() {
        for far in 0..COUNT {
            let mut pairs = Pairs::new();
            let ratio_max = 100.0;
            let sweep = |pairs: &Pairs| {
                let (batch, w) = (pairs.batch(), &pairs.inverse_masses);
                let mut multipliers = vec![0.0; COUNT];
                let mut x = pairs.positions.clone();
                let mut y = pairs.positions.clone();
                let mut others = multipliers.clone();
                [
                    project(batch, &mut others, w, 1.0, ratio_max, &mut x),
                    project_compliant::<true>(batch, &mut multipliers, w, 1.0, ratio_max, &mut y),
                ]
            };
            assert_eq!(sweep(&pairs), [true; 2]);
            pairs.positions[2 * far].y = 1e4;
            assert_eq!(sweep(&pairs), [false; 2], "{far}");
            pairs.positions[2 * far].y = f64::NAN;
            assert_eq!(sweep(&pairs), [false; 2], "{far}");
        }
    }
}
