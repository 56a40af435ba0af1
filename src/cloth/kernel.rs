//! The solvers' inner loops: pure functions over slices, with no mesh and no system in sight.
//!
//! A family of constraints of one colour comes as three slices of the same length: the two
//! particles of each, its rest length in metres and its stiffness in newtons per metre. No two of
//! one colour share a particle, so the loops have no chain of writes that wait for each other,
//! and the result does not depend on the order within a colour.

use super::implicit::{Triangle, triangle};
use crate::geometry::{Point, Vector, cross, dot};

/// The constraints of one colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch<'a> {
    pub(crate) ends: &'a [[u32; 2]],
    pub(crate) rest: &'a [f64],
    pub(crate) stiffness: &'a [f64],
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

/// Moves the ends of each constraint by the part `fraction` of the way to its rest length, by
/// inverse mass (Müller et al. 2007, §3.3). Multipliers accumulate, as in
/// [`project_compliant`] without compliance.
#[must_use]
pub(crate) fn project(
    batch: Batch<'_>,
    multipliers: &mut [f64],
    inverse_masses: &[f64],
    fraction: f64,
    ratio_max: f64,
    positions: &mut [Point],
) -> bool {
    let mut sane = true;
    for (([a, b], rest, _), multiplier) in batch.iter().zip(multipliers) {
        let d = positions[b] - positions[a];
        let length = dot(d, d).sqrt();
        sane &= length <= ratio_max * rest;
        let (wa, wb) = (inverse_masses[a], inverse_masses[b]);
        let w = wa + wb;
        if w > 0.0 && length > 0.0 {
            *multiplier -= fraction * (length - rest) / w;
            let step = d * (fraction * (length - rest) / (length * w));
            positions[a] += step * wa;
            positions[b] -= step * wb;
        }
    }
    sane
}

/// One sweep of XPBD: C = l − L, α̃ = `scale` / k, and multipliers that accumulate
/// (Macklin et al. 2016, equation 18).
#[must_use]
pub(crate) fn project_compliant(
    batch: Batch<'_>,
    multipliers: &mut [f64],
    inverse_masses: &[f64],
    scale: f64,
    ratio_max: f64,
    positions: &mut [Point],
) -> bool {
    let mut sane = true;
    for (([a, b], rest, stiffness), multiplier) in batch.iter().zip(multipliers) {
        let d = positions[b] - positions[a];
        let length = dot(d, d).sqrt();
        sane &= length <= ratio_max * rest;
        let (wa, wb) = (inverse_masses[a], inverse_masses[b]);
        let w = wa + wb;
        if w > 0.0 && length > 0.0 {
            let compliance = scale / stiffness;
            let change = (rest - length - compliance * *multiplier) / (w + compliance);
            *multiplier += change;
            let step = d * (change / length);
            positions[a] -= step * wa;
            positions[b] += step * wb;
        }
    }
    sane
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
