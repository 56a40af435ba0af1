//! What a kind of constraint has to know of itself, and all that anyone asks it.
//!
//! Springs, arcs and triangles each have energy, force and stiffness in a file of their own, and
//! whoever sums over constraints asks the [`kinds`](crate::system::Model::kinds) of a model, one after
//! the other: forces, energy, the bound of frequencies, the matrix of an implicit step, the blame
//! for a blow-up. So a new kind is a file that implements this, a place in that list, and what
//! becomes of it where the mesh changes.
//!
//! Sums go on from kind to kind in that order, and within a kind in the order of its storage.

use tearmesh::geometry::{Point, Vector};

use crate::blow_up::Longest;
use crate::crush::Crush;
use crate::matrix::Hessian;

/// All constraints of one kind.
pub(crate) trait Element {
    /// How many there are.
    fn len(&self) -> usize;

    /// The elastic energy in joules, added to a sum one after the other.
    fn energy(&self, x: &[Point], sum: f64) -> f64;

    /// That of the constraints of a particle.
    fn energy_at(&self, x: &[Point], particle: usize) -> f64;

    /// Adds the forces, in newtons, to those of the particles, with those of damping where something is
    /// crushed. False where one is longer than `ratio_max` times its rest length, or not a number.
    #[must_use]
    fn forces(
        &self,
        x: &[Point],
        ratio_max: f64,
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
    ) -> bool;

    /// Adds the forces on one particle, as `exerted` has them by the ends of a spring, its force by its
    /// length, and the multiplier that the last step recorded.
    fn force_at(
        &self,
        x: &[Point],
        particle: usize,
        exerted: &dyn Fn([usize; 2], f64, f64) -> f64,
        sum: &mut Vector,
    );

    /// Whether none is longer than `ratio_max` times its rest length, or not a number: what
    /// [`forces`](Element::forces) says.
    fn is_within(&self, x: &[Point], ratio_max: f64) -> bool;

    /// Looks for the one that is longest for its rest length.
    fn find_longest(&self, x: &[Point], longest: &mut Longest);

    /// Visits springs that together are as stiff as these constraints or stiffer, in every direction
    /// and in any state within `reach`: their particles, and their stiffness in N/m.
    fn each_spring(&self, reach: f64, visit: &mut dyn FnMut([usize; 2], f64));

    /// Visits those springs of a particle: the other one, and the stiffness.
    fn springs_at(&self, particle: usize, reach: f64, visit: &mut dyn FnMut(usize, f64));

    /// The pairs of particles that act on each other, each with a number that stays that of its
    /// constraint.
    fn each_pair(&self, visit: &mut dyn FnMut(usize, [u32; 2]));

    /// Adds the second derivatives of the energy, each pair's to its slot by that number. With
    /// `clamp` every term is positive semidefinite; returns how many had a part dropped for it.
    fn hessian(&self, x: &[Point], clamp: bool, slots: &[u32], hessian: &mut Hessian) -> u64;
}
