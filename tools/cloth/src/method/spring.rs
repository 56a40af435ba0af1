//! Springs: projection onto the rest length, by the methods that move particles in place of forces.
//!
//! They go colour by colour: no two springs of one colour share a particle, so the loops have no chain of
//! writes that wait for each other, and the result does not depend on the order within a colour.

use tearmesh::geometry::{Point, Vector, dot};

use crate::system::constraint::Colour;

/// How a sweep corrects the errors of constraints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Correction {
    /// The part of an error that a sweep corrects.
    pub(crate) fraction: f64,
    /// What makes a compliance one of a step: α̃ = scale / k. Zero of constraints that are rigid.
    pub(crate) scale: f64,
    /// The ratio of length to rest length at which the system counts as blown up.
    pub(crate) ratio_max: f64,
}

/// How many constraints of a colour are projected together: first all their lengths, then
/// all roots and divisions, which a processor does two at a time, then all moves. Each number is what
/// it would be one by one, which takes 8.4 ns a constraint where this takes 6.2 (a sheet of 32 × 32 cells).
///
/// Fewer or more at a time are slower. What is left is to fetch two ends and to put them back, not
/// arithmetic: intrinsics, which need `unsafe`, gain 2 % with SSE2 and about 30 % with AVX2.
const TOGETHER: usize = 8;

/// One sweep over a colour: C = l − L, the compliance α̃, and multipliers that accumulate (Macklin et al.
/// 2016, equation 18). Without compliance, and with a part of each error, that is a sweep of Müller et al.
/// 2007, §3.3. The first sweep writes multipliers and reads none. False where a constraint is longer than
/// is allowed, or not a number: it is left as it is, and the rest of the colour too.
#[must_use]
pub(crate) fn project<const IS_FIRST: bool>(
    colour: &mut Colour,
    inverse_masses: &[f64],
    correction: Correction,
    positions: &mut [Point],
) -> bool {
    let (ends, last_ends) = colour.ends.as_chunks::<TOGETHER>();
    let (rest, last_rest) = colour.rest.as_chunks::<TOGETHER>();
    let (compliance, last_compliance) = colour.compliance.as_chunks::<TOGETHER>();
    let (multipliers, last_multipliers) = colour.multipliers.as_chunks_mut::<TOGETHER>();
    let inverse_masses = &inverse_masses[..positions.len()];
    let numbers = rest.iter().zip(compliance).zip(multipliers);
    for (ends, ((rest, compliance), multipliers)) in ends.iter().zip(numbers) {
        let numbers = (rest, compliance, multipliers);
        if !together::<IS_FIRST, _>(ends, numbers, inverse_masses, correction, positions) {
            return false;
        }
    }
    let numbers = last_rest.iter().zip(last_compliance).zip(last_multipliers);
    for (&ends, ((&rest, &compliance), multiplier)) in last_ends.iter().zip(numbers) {
        let numbers = (&[rest], &[compliance], std::array::from_mut(multiplier));
        if !together::<IS_FIRST, 1>(&[ends], numbers, inverse_masses, correction, positions) {
            return false;
        }
    }
    true
}

/// Projects some constraints of one colour, by their ends, rest lengths, compliances and multipliers; none of
/// them where one is too long.
#[inline(always)]
fn together<const IS_FIRST: bool, const N: usize>(
    ends: &[[u32; 2]; N],
    (rest, compliance, multipliers): (&[f64; N], &[f64; N], &mut [f64; N]),
    inverse_masses: &[f64],
    correction: Correction,
    positions: &mut [Point],
) -> bool {
    let (mut d, mut squares, mut weights) = ([Vector::zeros(); N], [0.0; N], [0.0; N]);
    for i in 0..N {
        let [a, b] = ends[i].map(|end| end as usize);
        d[i] = positions[b] - positions[a];
        squares[i] = dot(d[i], d[i]);
        weights[i] = inverse_masses[a] + inverse_masses[b];
    }
    let (mut changes, mut pushes) = ([0.0; N], [0.0; N]);
    let mut is_sane = true;
    for i in 0..N {
        let length = squares[i].sqrt();
        is_sane &= length <= correction.ratio_max * rest[i];
        let before = if IS_FIRST { 0.0 } else { multipliers[i] };
        let compliance = correction.scale * compliance[i];
        // −Δλ / l: one division for both. Between two that are held a spring moves nothing, and the
        // multiplier is its force; what is rigid there has none.
        let divisor = (weights[i] + compliance) * length;
        let change = correction.fraction * (length - rest[i] + compliance * before) / divisor;
        changes[i] = if divisor > 0.0 { change } else { 0.0 };
        pushes[i] = before - changes[i] * length;
    }
    *multipliers = pushes;
    if !is_sane {
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
    colour: &mut Colour,
    inverse_masses: &[f64],
    ratio: f64,
    positions: &mut [Point],
) -> f64 {
    let mut largest = 0.0_f64;
    let constraints = colour.ends.iter().zip(&colour.rest);
    for ((&ends, &rest), multiplier) in constraints.zip(&mut colour.multipliers) {
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

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 2 * TOGETHER + 5;

    /// Constraints of one colour: some with one end held, one with both, one without length.
    struct Pairs {
        colour: Colour,
        inverse_masses: Vec<f64>,
        positions: Vec<Point>,
    }

    impl Pairs {
        fn new() -> Pairs {
            let mut state = 1_u64;
            let mut random = || {
                // Knuth's generator, whose higher bits are random enough.
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let mut point = || Point::new(random(), random(), random());
            let mut positions: Vec<Point> = (0..2 * COUNT).map(|_| point()).collect();
            positions[14] = positions[15];
            let mut inverse_masses: Vec<f64> = (0..2 * COUNT).map(|_| 1.0 + random()).collect();
            inverse_masses.iter_mut().step_by(3).for_each(|w| *w = 0.0);
            inverse_masses[10..12].fill(0.0);
            let stiffness: Vec<f64> = (0..COUNT).map(|_| 1.0 + 9.0 * random()).collect();
            Pairs {
                colour: Colour {
                    ids: (0..COUNT as u32).collect(),
                    ends: (0..COUNT as u32).map(|i| [2 * i, 2 * i + 1]).collect(),
                    rest: (0..COUNT).map(|_| 0.1 + random()).collect(),
                    compliance: stiffness.iter().map(|k| 1.0 / k).collect(),
                    stiffness,
                    damping: vec![0.0; COUNT],
                    multipliers: vec![0.25; COUNT],
                },
                inverse_masses,
                positions,
            }
        }

        /// A sweep; whether it was sane.
        fn sweep<const IS_FIRST: bool>(&mut self, fraction: f64, scale: f64) -> bool {
            let correction = Correction {
                fraction,
                scale,
                ratio_max: 100.0,
            };
            let (colour, positions) = (&mut self.colour, &mut self.positions);
            project::<IS_FIRST>(colour, &self.inverse_masses, correction, positions)
        }
    }

    /// With a part of the correction and without compliance, and with compliance in the first sweep, which reads
    /// no multiplier, and in the next.
    #[test]
    fn what_is_projected_together_is_as_if_one_by_one() {
        let pairs = Pairs::new();
        for (is_first, before, fraction, scale) in [
            (false, 0.25, 0.7, 0.0),
            (true, f64::NAN, 1.0, 3.0),
            (false, 0.25, 1.0, 3.0),
        ] {
            let mut swept = Pairs::new();
            swept.colour.multipliers.fill(before);
            let mut expected = pairs.positions.clone();
            let mut expected_multipliers = Vec::new();
            let before = if is_first { 0.0 } else { before };
            for i in 0..COUNT {
                let [a, b] = [2 * i, 2 * i + 1];
                let d = pairs.positions[b] - pairs.positions[a];
                let length = (d.x * d.x + d.y * d.y + d.z * d.z).sqrt();
                let [w_a, w_b] = [a, b].map(|end| pairs.inverse_masses[end]);
                let w = w_a + w_b;
                let compliance = scale * (1.0 / pairs.colour.stiffness[i]);
                let error = length - pairs.colour.rest[i] + compliance * before;
                let change = fraction * error / ((w + compliance) * length);
                if w > 0.0 && length > 0.0 {
                    expected[a] += d * change * w_a;
                    expected[b] -= d * change * w_b;
                }
                let pulls = length > 0.0 && w + compliance > 0.0;
                expected_multipliers.push(before - if pulls { change * length } else { 0.0 });
            }
            assert!(match is_first {
                true => swept.sweep::<true>(fraction, scale),
                false => swept.sweep::<false>(fraction, scale),
            });
            assert_eq!(swept.positions, expected);
            assert_eq!(swept.colour.multipliers, expected_multipliers);
            assert_ne!(swept.positions, pairs.positions);
        }
    }

    #[test]
    fn a_constraint_beyond_all_measure_is_noticed_anywhere() {
        for far in 0..COUNT {
            for (y, is_sane) in [(0.5, true), (1e4, false), (f64::NAN, false)] {
                let mut pairs = Pairs::new();
                pairs.positions[2 * far].y = y;
                assert_eq!(pairs.sweep::<true>(1.0, 1.0), is_sane, "{far}");
            }
        }
    }
}
