//! All of a system but its state: what its particles weigh, what joins them, and what acts on them.

use std::ops::Deref;

use tearmesh::geometry::{Point, Vector};

use super::counters::Counters;
use crate::bend::Buckling;
use crate::blow_up::{BlowUpSite, Longest};
use crate::carry::Carry;
use crate::constraint::{Constraint, Constraints};
use crate::crush::Crush;
use crate::element::Element;
use crate::load::{Loads, Path};
use crate::pair::{Law, Link, Pairs, length};
use crate::spring::Hooke;
use crate::triangle::Triangles;

/// All but positions and velocities.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) masses: Vec<f64>,
    /// Zero for a particle that is held.
    pub(crate) inverse_masses: Vec<f64>,
    pub(crate) held: Vec<bool>,
    pub(crate) stretch: Constraints,
    pub(crate) bend: Constraints,
    /// The law of all bend constraints; `None` where they are springs.
    pub(crate) buckling: Option<Buckling>,
    pub(crate) triangles: Triangles,
    /// The corners of faces, three each, where wind may blow.
    pub(crate) faces: Vec<u32>,
    pub(crate) loads: Loads,
    pub(super) paths: Vec<Path>,
    /// Particles and their paths.
    pub(crate) grabbed: Vec<(u32, u32)>,
    pub(crate) stretch_ratio_max: f64,
    pub(crate) recorded: Recorded,
}

/// What the method of the last step recorded in constraints, because their lengths do not tell it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Recorded {
    /// Nothing: forces and strains are those of lengths.
    #[default]
    Nothing,
    /// Multipliers of rigid constraints, which are forces and say nothing of a strain (PBD).
    RigidForces,
    /// Multipliers of springs: their forces, and so their strains (XPBD).
    SpringForces,
    /// The forces of a limiter beside those of springs, and lengths before it (Provot).
    Limiter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Stretch,
    Bend,
}

impl Model {
    pub(crate) fn family_mut(&mut self, family: Family) -> &mut Constraints {
        match family {
            Family::Stretch => &mut self.stretch,
            Family::Bend => &mut self.bend,
        }
    }

    /// All kinds of constraints, in the order of every sum.
    pub(crate) fn kinds(&self) -> [Kind<'_>; 3] {
        let stretch: fn([usize; 2], f64) -> BlowUpSite =
            |ends, stretch_ratio| BlowUpSite::Constraint {
                ends,
                stretch_ratio,
            };
        let bend: fn([usize; 2], f64) -> BlowUpSite = |ends, stretch_ratio| BlowUpSite::Bend {
            ends,
            stretch_ratio,
        };
        [
            Kind::Springs(Pairs::new(&self.stretch, Hooke, stretch)),
            match self.buckling {
                None => Kind::Springs(Pairs::new(&self.bend, Hooke, bend)),
                Some(law) => Kind::Bends(Pairs::new(&self.bend, law, bend)),
            },
            Kind::Triangles(&self.triangles),
        ]
    }

    /// Appends a particle without mass and constraints.
    pub(crate) fn push_particle(&mut self, is_held: bool) {
        self.masses.push(0.0);
        self.inverse_masses.push(0.0);
        self.held.push(is_held);
        self.stretch.push_particle();
        self.bend.push_particle();
        self.triangles.push_particle();
    }

    /// Forgets a particle without constraints; the last one takes its index.
    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        self.masses.swap_remove(particle);
        self.inverse_masses.swap_remove(particle);
        self.held.swap_remove(particle);
        self.stretch.swap_remove_particle(particle);
        self.bend.swap_remove_particle(particle);
        self.triangles.swap_remove_particle(particle);
    }

    /// The energy in joules and the pull in newtons of a constraint of a family, whether it is one
    /// of this model or was.
    pub(crate) fn axial(&self, family: Family, constraint: &Constraint, x: &[Point]) -> [f64; 2] {
        let (rest, stiffness) = (constraint.rest_length_m, constraint.stiffness_n_per_m);
        let length = length(x, constraint.ends);
        let both = match (family, self.buckling) {
            (Family::Bend, Some(law)) => law
                .link(rest, stiffness)
                .map(|link| [link.twice_energy(length), link.force(length)]),
            _ => Hooke
                .link(rest, stiffness)
                .map(|link| [link.twice_energy(length), link.force(length)]),
        };
        let [twice, force] = both.unwrap_or_default();
        [0.5 * twice, force]
    }

    /// How many constraints and triangles there are.
    pub(crate) fn constraint_count(&self) -> u64 {
        self.kinds().iter().map(|kind| kind.len() as u64).sum()
    }

    /// Counts so many visits of each constraint for forces.
    pub(crate) fn count_visits(&self, times: u64, counters: &mut Counters) {
        let features = &mut counters.features;
        features.stretch += times * self.stretch.len() as u64;
        features.bend += times * self.bend.len() as u64;
        features.triangle += times * self.triangles.len() as u64;
        counters.visits.force += times * self.constraint_count();
    }

    /// The elastic energy of all constraints, in joules.
    pub(crate) fn elastic_j(&self, x: &[Point]) -> f64 {
        let kinds = self.kinds();
        kinds.iter().fold(0.0, |sum, kind| kind.energy(x, sum))
    }

    /// That of all constraints that a particle has a part in.
    pub(crate) fn elastic_at_j(&self, x: &[Point], particle: usize) -> f64 {
        let kinds = self.kinds();
        kinds
            .iter()
            .fold(0.0, |sum, kind| sum + kind.energy_at(x, particle))
    }

    /// The constraint that is longest for its rest length.
    pub(crate) fn longest(&self, x: &[Point]) -> Longest {
        let mut longest = Longest::default();
        self.kinds()
            .iter()
            .for_each(|kind| kind.find_longest(x, &mut longest));
        longest
    }

    pub(crate) fn drag_per_s(&self) -> f64 {
        self.loads.drag_per_s.unwrap_or(0.0)
    }

    pub(crate) fn gravity(&self) -> Vector {
        self.loads.gravity_m_per_s2.unwrap_or_else(Vector::zeros)
    }

    /// Takes a particle off its path, and forgets a path that leads no other.
    pub(crate) fn unlead(&mut self, particle: usize) {
        let led = |&(led, _): &(u32, u32)| led as usize == particle;
        let Some(place) = self.grabbed.iter().position(led) else {
            return;
        };
        let (_, path) = self.grabbed.remove(place);
        if self.grabbed.iter().all(|&(_, other)| other != path) {
            self.paths.swap_remove(path as usize);
            let last = self.paths.len() as u32;
            let renumbered = self.grabbed.iter_mut().filter(|(_, other)| *other == last);
            renumbered.for_each(|(_, other)| *other = path);
        }
    }

    /// Fills in the accelerations by springs, triangles, wind and gravity; held particles have
    /// none. False where a spring has blown up.
    #[must_use]
    pub(crate) fn accelerate(
        &self,
        positions: &[Point],
        velocities: &[Vector],
        accelerations: &mut [Vector],
        counters: &mut Counters,
    ) -> bool {
        let sane = self.inner(positions, None, accelerations, counters);
        self.external(positions, velocities, accelerations, counters);
        sane
    }

    /// Fills in the forces of springs, triangles and wind. False where a spring has blown up.
    #[must_use]
    pub(crate) fn pull(
        &self,
        positions: &[Point],
        velocities: &[Vector],
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
        counters: &mut Counters,
    ) -> bool {
        let sane = self.inner(positions, crush, forces, counters);
        self.blow(positions, velocities, forces, counters);
        sane
    }

    /// Makes accelerations of forces, with gravity, and with what is carried as heavy as that makes it;
    /// held particles have none.
    pub(crate) fn weigh(&self, carry: Option<&Carry>, forces: &mut [Vector]) {
        let gravity = self.gravity();
        let Some(carry) = carry.filter(|carry| carry.len() > 0) else {
            for (a, &w) in forces.iter_mut().zip(&self.inverse_masses) {
                *a = accelerated(*a, w, gravity);
            }
            return;
        };
        for (a, &mass) in forces.iter_mut().zip(&self.masses) {
            *a += gravity * mass;
        }
        carry.accelerate(forces);
    }

    /// Fills in the forces of springs and triangles. False where one has blown up.
    fn inner(
        &self,
        positions: &[Point],
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
        counters: &mut Counters,
    ) -> bool {
        counters.force_evaluations += 1;
        self.count_visits(1, counters);
        counters.triangle_evaluations += u64::from(self.triangles.len() > 0);
        forces.fill(Vector::zeros());
        let mut sane = true;
        for kind in &self.kinds() {
            sane &= kind.forces(positions, self.stretch_ratio_max, crush, forces);
        }
        sane
    }

    /// Adds the forces of wind.
    fn blow(
        &self,
        positions: &[Point],
        velocities: &[Vector],
        forces: &mut [Vector],
        counters: &mut Counters,
    ) {
        if let Some(wind) = self.loads.wind {
            counters.wind_evaluations += 1;
            counters.features.wind += self.faces.len() as u64 / 3;
            wind.press(&self.faces, positions, velocities, forces);
        }
    }

    /// Whether nothing is stretched beyond the limit, nor not a number: what [`Model::pull`]
    /// says of the same positions, for methods that do not ask it.
    #[must_use]
    pub(crate) fn is_within_limit(&self, positions: &[Point]) -> bool {
        let ratio_max = self.stretch_ratio_max;
        self.kinds()
            .iter()
            .all(|kind| kind.is_within(positions, ratio_max))
    }

    /// Adds the force of wind, and makes accelerations of forces, with gravity.
    pub(crate) fn external(
        &self,
        positions: &[Point],
        velocities: &[Vector],
        accelerations: &mut [Vector],
        counters: &mut Counters,
    ) {
        self.blow(positions, velocities, accelerations, counters);
        self.weigh(None, accelerations);
    }

    /// The force of a spring as the method of the last step exerted it, by its length and its
    /// multiplier. What no method can move has the force of its length.
    pub(crate) fn exerted_n(&self, ends: [usize; 2], by_length: f64, multiplier: f64) -> f64 {
        let is_free = |end: usize| self.inverse_masses[end] > 0.0;
        match self.recorded {
            Recorded::Nothing => by_length,
            Recorded::Limiter => by_length - multiplier,
            Recorded::RigidForces | Recorded::SpringForces => {
                if ends.into_iter().any(is_free) {
                    -multiplier
                } else {
                    by_length
                }
            }
        }
    }

    /// Sets all multipliers to zero.
    pub(crate) fn clear_multipliers(&mut self) {
        for family in [&mut self.stretch, &mut self.bend] {
            for (_, memories) in family.batches_mut() {
                memories.multipliers.fill(0.0);
            }
        }
    }

    /// Makes forces of multipliers.
    pub(crate) fn scale_multipliers(&mut self, scale: f64) {
        for family in [&mut self.stretch, &mut self.bend] {
            for (_, memories) in family.batches_mut() {
                let multipliers = memories.multipliers.iter_mut();
                multipliers.for_each(|lambda| *lambda *= scale);
            }
        }
    }
}

/// The acceleration of a particle by a force beside its weight; none of one that is held.
#[inline]
fn accelerated(force: Vector, inverse_mass: f64, gravity: Vector) -> Vector {
    if inverse_mass > 0.0 {
        force * inverse_mass + gravity
    } else {
        Vector::zeros()
    }
}

/// A kind of constraints, as [`Model::kinds`] lists it.
#[derive(Debug)]
pub(crate) enum Kind<'a> {
    Springs(Pairs<'a, Hooke>),
    Bends(Pairs<'a, Buckling>),
    Triangles(&'a Triangles),
}

impl<'a> Deref for Kind<'a> {
    type Target = dyn Element + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            Kind::Springs(springs) => springs,
            Kind::Bends(bends) => bends,
            Kind::Triangles(triangles) => *triangles,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{System, Xpbd};

    #[test]
    fn a_path_is_kept_as_long_as_it_leads_someone() {
        let mut system = System::new([Point::origin(); 3], vec![1.0; 3]).unwrap();
        let to = |x: f64| Path::new([(0.0, Point::origin()), (1.0, Point::new(x, 0.0, 0.0))]);
        for turn in 0..10 {
            for particle in 0..3 {
                system.grab(particle, to((turn * particle) as f64).unwrap());
            }
            assert_eq!(system.model.paths.len(), 3);
        }
        system.release(0);
        assert_eq!(system.model.paths.len(), 2);
        system.step(&mut Xpbd::default(), 1.0).unwrap();
        let x: Vec<f64> = system.positions().iter().map(|p| p.x).collect();
        assert_eq!(x, [0.0, 9.0, 18.0]);
    }
}
