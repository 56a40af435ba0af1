//! The solvers' inner loops: pure functions over slices, with no mesh and no system in sight.
//!
//! A family of constraints of one colour comes as slices of the same length: the two particles
//! of each, its rest length in metres, its stiffness in newtons per metre and the inverse of that.
//! No two of one colour share a particle, so the loops have no chain of writes that wait for each
//! other, and the result does not depend on the order within a colour.

use tearmesh::geometry::{Point, Vector, cross, dot};

use crate::implicit::{Triangle, triangle};

/// The constraints of one colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch<'a> {
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) rest: &'a [f64],
    pub(crate) stiffness: &'a [f64],
    pub(crate) compliance: &'a [f64],
}

impl Batch<'_> {
    fn iter(&self) -> impl Iterator<Item = ([usize; 2], f64, f64)> + '_ {
        let numbers = self.rest.iter().zip(self.stiffness);
        self.ends
            .iter()
            .zip(numbers)
            .map(|(&[a, b], (&rest, &stiffness))| ([a as usize, b as usize], rest, stiffness))
    }
}

/// Adds k (l − L) along each spring to the forces of its ends. False where a spring is longer
/// than `ratio_max` times its rest length, or not a number.
#[must_use]
pub(crate) fn forces(
    batch: Batch<'_>,
    positions: &[Point],
    ratio_max: f64,
    forces: &mut [Vector],
) -> bool {
    let mut sane = true;
    for ([a, b], rest, stiffness) in batch.iter() {
        let d = positions[b] - positions[a];
        let length = dot(d, d).sqrt();
        sane &= length <= ratio_max * rest;
        if length > 0.0 {
            let force = d * (stiffness * (length - rest) / length);
            forces[a] += force;
            forces[b] -= force;
        }
    }
    sane
}

/// Whether no spring is longer than `ratio_max` times its rest length, or not a number: what
/// [`forces`] says.
#[must_use]
pub(crate) fn is_within(batch: Batch<'_>, positions: &[Point], ratio_max: f64) -> bool {
    batch.iter().all(|([a, b], rest, _)| {
        let d = positions[b] - positions[a];
        dot(d, d).sqrt() <= ratio_max * rest
    })
}

/// The elastic energy ½ k (l − L)², summed in order.
#[must_use]
pub(crate) fn energy(batch: Batch<'_>, positions: &[Point]) -> f64 {
    let of = |([a, b], rest, stiffness): ([usize; 2], f64, f64)| {
        let d = positions[b] - positions[a];
        let extension = dot(d, d).sqrt() - rest;
        0.5 * stiffness * extension * extension
    };
    batch.iter().map(of).sum()
}

/// Adds K u: minus the change of forces when the particles move by `u`, to first order. Across
/// a spring under compression the stiffness is negative; it counts as zero, so that K has no
/// negative direction.
pub(crate) fn stiffness_times(
    batch: Batch<'_>,
    positions: &[Point],
    u: &[Vector],
    product: &mut [Vector],
) {
    for ([a, b], rest, stiffness) in batch.iter() {
        let change = pull(positions[b] - positions[a], rest, stiffness, u[b] - u[a]);
        product[a] -= change;
        product[b] += change;
    }
}

/// The change of a spring's force when its vector `d` changes by `u`.
#[must_use]
pub(crate) fn pull(d: Vector, rest: f64, stiffness: f64, u: Vector) -> Vector {
    let square = dot(d, d);
    if square == 0.0 {
        return u * stiffness;
    }
    let across = (1.0 - rest / square.sqrt()).max(0.0);
    let along = d * (dot(d, u) / square);
    (along + (u - along) * across) * stiffness
}

/// Adds the forces of triangles to those of their corners. False where warp or weft of one is
/// longer than `ratio_max` times its rest length, or not a number.
#[must_use]
pub(crate) fn triangle_forces(
    triangles: &[Triangle],
    positions: &[Point],
    ratio_max: f64,
    forces: &mut [Vector],
) -> bool {
    let mut sane = true;
    for t in triangles {
        let corners = triangle::corners(t, positions);
        let [w_u, w_v] = t.derivatives(corners);
        let square = ratio_max * ratio_max;
        sane &= dot(w_u, w_u) <= square && dot(w_v, w_v) <= square;
        let pulls = triangle::forces(t, corners);
        for (v, pull) in t.vertices.into_iter().zip(pulls) {
            forces[v as usize] += pull;
        }
    }
    sane
}

/// Whether neither warp nor weft of a triangle is longer than `ratio_max` times its rest length, or
/// not a number: what [`triangle_forces`] says.
#[must_use]
pub(crate) fn triangles_are_within(
    triangles: &[Triangle],
    positions: &[Point],
    ratio_max: f64,
) -> bool {
    let square = ratio_max * ratio_max;
    triangles.iter().all(|t| {
        let [w_u, w_v] = t.derivatives(triangle::corners(t, positions));
        dot(w_u, w_u) <= square && dot(w_v, w_v) <= square
    })
}

/// Adds K u of triangles, as [`stiffness_times`] does that of springs.
pub(crate) fn triangle_stiffness_times(
    triangles: &[Triangle],
    positions: &[Point],
    u: &[Vector],
    product: &mut [Vector],
) {
    for t in triangles {
        let moved = t.vertices.map(|v| u[v as usize]);
        let changes = triangle::stiffness_times(t, triangle::corners(t, positions), moved);
        for (v, change) in t.vertices.into_iter().zip(changes) {
            product[v as usize] += change;
        }
    }
}

/// How many constraints of a colour are projected together: first all their lengths, then all
/// roots and divisions, which a processor does two at a time, then all moves. Each number is what
/// it would be one by one.
///
/// Fewer or more at a time are slower. What is left is to fetch two ends and to put them back, not
/// arithmetic: intrinsics, which need `unsafe`, gain 2 % with SSE2 and about 30 % with AVX2.
const TOGETHER: usize = 8;

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
        let change = if w > 0.0 && length > 0.0 { change } else { 0.0 };
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
    for (([a, b], rest, _), multiplier) in batch.iter().zip(multipliers) {
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
    for (([a, b], rest, _), ratio) in batch.iter().zip(ratios) {
        let d = positions[b] - positions[a];
        *ratio = dot(d, d).sqrt() / rest;
    }
}

/// Adds the force of wind on faces: pressure c n·(u − v), where v is the mean velocity of the
/// corners, along the normal; a third to each corner (Provot 1995, §3).
pub(crate) fn wind(
    faces: &[u32],
    coefficient: f64,
    air: Vector,
    positions: &[Point],
    velocities: &[Vector],
    forces: &mut [Vector],
) {
    for face in faces.chunks_exact(3) {
        let [a, b, c] = [face[0] as usize, face[1] as usize, face[2] as usize];
        // Twice the area along the normal.
        let normal = cross(positions[b] - positions[a], positions[c] - positions[a]);
        let double_area = dot(normal, normal).sqrt();
        if double_area > 0.0 {
            let mean = (velocities[a] + velocities[b] + velocities[c]) / 3.0;
            let pressure = coefficient * dot(normal, air - mean) / double_area;
            let third = normal * (pressure / 6.0);
            forces[a] += third;
            forces[b] += third;
            forces[c] += third;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 2 * TOGETHER + 5;

    /// Constraints of one colour: some with one end held, one with both, one without length.
    struct Pairs {
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
                let moves = w > 0.0 && length > 0.0;
                expected_multipliers.push(before - if moves { change * length } else { 0.0 });
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
