//! Constraints between two particles that act along the line between them: sums over all of one
//! family, which are springs, or bends that buckle ([`Buckling`]).
//!
//! A spring has the energy E = ½ k (l − L)², with k the stiffness, l the length and L that at rest. Its
//! force is k (l − L) along the spring; across it the stiffness is k (1 − L/l), which is negative under
//! compression.

use tearmesh::geometry::{Point, Vector, dot, length};

use crate::system::bend::{Axial, Buckling};
use crate::system::constraint::{Colour, Constraint, Constraints};
use crate::system::crush::Crush;
use crate::system::matrix::{Block, Hessian, outer};
use crate::system::pull::{Pass, Pull};

/// Energy, force and slope of one with the ends so far apart.
#[inline]
fn axial(family: &Constraints, rest: f64, stiffness: f64, length: f64) -> Axial {
    if let Some(law) = family.law {
        return law.axial(rest, stiffness, length);
    }
    let force = stiffness * (length - rest);
    Axial {
        energy: 0.5 * (force * (length - rest)),
        force,
        slope: stiffness,
    }
}

/// That of one constraint, whether it is one of them or was.
pub(crate) fn axial_of(family: &Constraints, one: &Constraint, x: &[Point]) -> Axial {
    let (rest, stiffness) = (one.rest_length_m, one.stiffness_n_per_m);
    axial(family, rest, stiffness, span(x, one.ends))
}

/// The largest stiffness at any length of one of this stiffness.
fn stiffest(family: &Constraints, stiffness: f64) -> f64 {
    stiffness * family.law.map_or(1.0, Buckling::stiffest)
}

/// The elastic energy in joules, added to a sum one colour after the other.
pub(crate) fn energy(family: &Constraints, x: &[Point], sum: f64) -> f64 {
    let colours = family.colours.iter();
    colours.fold(sum, |sum, colour| {
        let energies = colour
            .springs()
            .map(|(ends, rest, stiffness)| axial(family, rest, stiffness, span(x, ends)).energy);
        sum + energies.fold(0.0, |sum, energy_j| sum + energy_j)
    })
}

/// The elastic energy of the constraints of a particle.
pub(crate) fn energy_at(family: &Constraints, x: &[Point], particle: usize) -> f64 {
    let ids = family.of(particle);
    ids.map(|id| axial_of(family, &family.get(id), x).energy)
        .sum()
}

/// Adds the forces, in newtons, to those of the particles. In a guarded step springs are damped, and
/// where they are crushed by the guard too: a fold is where it is meant to be short.
pub(crate) fn add_forces(
    family: &Constraints,
    pass: Pass<'_>,
    x: &[Point],
    forces: &mut [Vector],
) -> Pull {
    let colours = family.colours.iter();
    colours.fold(Pull::NOTHING, |found, colour| match family.law {
        None => pass.add_forces(colour, x, forces, found),
        Some(law) => found.and(add_bends(colour, law, x, pass.ratio_max, forces)),
    })
}

/// Adds the forces of bends that buckle.
fn add_bends(
    colour: &Colour,
    law: Buckling,
    x: &[Point],
    ratio_max: f64,
    forces: &mut [Vector],
) -> Pull {
    let mut is_sane = true;
    for ([a, b], rest, stiffness) in colour.springs().filter(|spring| spring.2 > 0.0) {
        let d = x[b] - x[a];
        let length = length(d);
        is_sane &= length <= ratio_max * rest;
        if length > 0.0 {
            let force = d * (law.axial(rest, stiffness, length).force / length);
            forces[a] += force;
            forces[b] -= force;
        }
    }
    Pull {
        is_sane,
        ..Pull::NOTHING
    }
}

/// Adds the forces on one particle, as `exerted` has them by the ends of a constraint, its force by its
/// length, and the multiplier that the last step recorded; and the forces of damping, if the method damps.
pub(crate) fn add_force_at(
    family: &Constraints,
    x: &[Point],
    crush: Option<Crush<'_>>,
    particle: usize,
    exerted: impl Fn([usize; 2], f64, f64) -> f64,
    sum: &mut Vector,
) {
    for id in family.of(particle) {
        let one = family.get(id);
        let [a, b] = one.ends;
        let other = a + b - particle;
        let d = x[other] - x[particle];
        let length = length(d);
        if length > 0.0 {
            let multiplier = family.multiplier(id);
            let mut pull = exerted([a, b], axial_of(family, &one, x).force, multiplier);
            if let Some(crush) = crush.filter(|_| family.law.is_none()) {
                let speed = dot(d, crush.velocities[other] - crush.velocities[particle]) / length;
                let ratio = length / one.rest_length_m;
                pull += family.damping(id) * speed;
                pull += crush.pull(one.stiffness_n_per_m, ratio, speed);
            }
            *sum += d * (pull / length);
        }
    }
}

/// The one that is longest for its rest length: its ends, and the ratio of the two. The length of a bend
/// without stiffness does not matter, which is what an edit leaves where rounding left none at rest.
pub(crate) fn longest(family: &Constraints, x: &[Point]) -> Option<([usize; 2], f64)> {
    let measured = family
        .springs()
        .filter(|one| family.law.is_none() || one.2 > 0.0);
    let ratios = measured.map(|(ends, rest, _)| (ends, span(x, ends) / rest));
    ratios.reduce(|most, one| if one.1 > most.1 { one } else { most })
}

/// Visits springs that together are as stiff as these constraints or stiffer, in every direction and in
/// any state: their particles, their stiffness in N/m, and their damping in N s/m.
pub(crate) fn each_spring(family: &Constraints, mut visit: impl FnMut([usize; 2], [f64; 2])) {
    for colour in &family.colours {
        let numbers = colour.stiffness.iter().zip(&colour.damping);
        for (ends, (&stiffness, &damping)) in colour.ends.iter().zip(numbers) {
            if stiffness > 0.0 {
                let ends = ends.map(|end| end as usize);
                visit(ends, [stiffest(family, stiffness), damping]);
            }
        }
    }
}

/// Visits those springs of a particle: their place among those of [`each_spring`], the other particle, and the
/// numbers.
pub(crate) fn springs_at(
    family: &Constraints,
    particle: usize,
    mut visit: impl FnMut(usize, usize, [f64; 2]),
) {
    for id in family.of(particle) {
        let one = family.get(id);
        if one.stiffness_n_per_m > 0.0 {
            let stiffness = stiffest(family, one.stiffness_n_per_m);
            let other = one.ends[0] + one.ends[1] - particle;
            visit(family.colour(id), other, [stiffness, family.damping(id)]);
        }
    }
}

/// Adds the second derivatives of the energy. With `clamp` every term is positive semidefinite;
/// returns how many had a part dropped for it.
pub(crate) fn add_hessian(family: &Constraints, x: &[Point], clamp: bool, to: &mut Hessian) -> u64 {
    let mut clamped = 0;
    // Edges of a cloth of triangles alone are measured, and pull at nothing.
    for ([a, b], rest, stiffness) in family.springs().filter(|spring| spring.2 > 0.0) {
        let d = x[b] - x[a];
        let length = length(d);
        let Axial { force, slope, .. } = axial(family, rest, stiffness, length);
        // The derivative of the force for a turn.
        let across = match family.law {
            None => stiffness * ((length - rest) / length),
            Some(_) => force / length,
        };
        let (block, dropped) = block(d, [slope, across], clamp);
        clamped += u64::from(dropped);
        let [a, b] = [a, b].map(|end| end as u32);
        to.add([a, a], &block);
        to.add([b, b], &block);
        to.add([a, b], &-block);
    }
    clamped
}

/// How far two particles are apart, in metres.
pub(crate) fn span(x: &[Point], [a, b]: [usize; 2]) -> f64 {
    length(x[b] - x[a])
}

/// The second derivative of the energy by the position of either end (by both it is the negative), and
/// whether a part of it was dropped that is indefinite:
///
/// ```text
/// H = E″ t tᵀ + E′/l (I − t tᵀ),   t the direction, l the length
/// ```
///
/// Under compression the second term is negative; Choi and Ko 2002 §4 drop it there. Where both
/// ends are one point the derivative does not exist, and E″ I is given for it.
fn block(d: Vector, [along, across]: [f64; 2], clamp: bool) -> (Block, bool) {
    let length = length(d);
    if length == 0.0 {
        return (Block::from_diagonal_element(along), false);
    }
    let direction = d / length;
    let clamped = clamp && across < 0.0;
    let across = if clamped { 0.0 } else { across };
    let line = outer(direction, direction) * (along - across);
    (Block::from_diagonal_element(across) + line, clamped)
}
