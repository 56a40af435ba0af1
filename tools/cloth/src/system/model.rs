//! All of a system but its state: what its particles weigh, what joins them, and what acts on them.

use tearmesh::geometry::{Point, Vector};

use super::counters::Counters;
use crate::system::blow_up::BlowUpSite;
use crate::system::constraint::Constraints;
use crate::system::crush::Crush;
use crate::system::drawn::Drawn;
use crate::system::load::Loads;
use crate::system::mass_scaling::MassScaling;
use crate::system::matrix::{Hessian, Weights};
use crate::system::pair;
use crate::system::path::Path;
use crate::system::pull::{Pass, Pull};
use crate::system::triangle::Triangles;

/// All but positions and velocities.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    pub(crate) masses: Vec<f64>,
    /// Zero for a particle that is held.
    pub(crate) inverse_masses: Vec<f64>,
    pub(crate) held: Vec<bool>,
    pub(crate) stretch: Constraints,
    pub(crate) bend: Constraints,
    pub(crate) triangles: Triangles,
    /// The time τ of the damping of stretch constraints ([`damping`](crate::system::damping)).
    pub(crate) damping_s: f64,
    /// Whether the method of the last step damps.
    pub(crate) is_damped: bool,
    /// The corners of faces, three each, where wind may blow.
    pub(crate) faces: Vec<u32>,
    pub(crate) loads: Loads,
    /// Particles and their paths.
    pub(crate) grabbed: Vec<(u32, Path)>,
    /// The pairs that the next step draws together.
    pub(crate) drawn: Vec<Drawn>,
    pub(crate) stretch_ratio_max: f64,
    /// The ratio of length to rest length from which on stretch constraints are watched for.
    pub(crate) ratio_watched: f64,
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

impl Model {
    /// Appends a particle without constraints.
    pub(crate) fn push_particle(&mut self, mass: f64, is_held: bool) {
        self.masses.push(mass);
        self.inverse_masses.push(inverse(mass, is_held));
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

    /// Counts so many visits of each constraint for forces.
    pub(crate) fn count_visits(&self, times: u64, counters: &mut Counters) {
        let [stretch, bend] = [&self.stretch, &self.bend].map(|family| times * family.len() as u64);
        let triangle = times * self.triangles.list.len() as u64;
        counters.features.stretch += stretch;
        counters.features.bend += bend;
        counters.features.triangle += triangle;
        counters.visits.force += stretch + bend + triangle;
    }

    /// The constraint that is longest for its rest length, if that is beyond `ratio_max`.
    pub(crate) fn longest_beyond(&self, x: &[Point], ratio_max: f64) -> Option<BlowUpSite> {
        let [stretch, bend] = [&self.stretch, &self.bend].map(|family| pair::longest(family, x));
        let triangle = self.triangles.longest(x);
        let sites = [
            stretch.map(|(ends, ratio)| BlowUpSite::Constraint(ends, ratio)),
            bend.map(|(ends, ratio)| BlowUpSite::Bend(ends, ratio)),
            triangle.map(|(corners, ratio)| BlowUpSite::Triangle(corners, ratio)),
        ];
        // Of those that are as long the first one counts.
        let by_ratio =
            |a: &BlowUpSite, b: &BlowUpSite| a.stretch_ratio().total_cmp(&b.stretch_ratio());
        let longest = sites.into_iter().flatten().rev().max_by(by_ratio);
        longest.filter(|site| site.stretch_ratio() > ratio_max)
    }

    /// Visits springs that together are as stiff as all constraints, or stiffer, in every direction and in
    /// any state in which triangles are stretched within `reach`: their particles, their stiffness in N/m,
    /// and their damping in N s/m.
    pub(crate) fn each_spring(&self, reach: f64, mut visit: impl FnMut([usize; 2], [f64; 2])) {
        pair::each_spring(&self.stretch, &mut visit);
        pair::each_spring(&self.bend, &mut visit);
        self.triangles.each_spring(reach, visit);
    }

    /// Visits those springs of a particle: their place in that order, as far as springs of one particle go, the
    /// other particle, and the numbers.
    pub(crate) fn springs_at(
        &self,
        particle: usize,
        reach: f64,
        mut visit: impl FnMut([usize; 2], usize, [f64; 2]),
    ) {
        let stretch = |place, other, numbers| visit([0, place], other, numbers);
        pair::springs_at(&self.stretch, particle, stretch);
        let bend = |place, other, numbers| visit([1, place], other, numbers);
        pair::springs_at(&self.bend, particle, bend);
        let side = |place, other, numbers| visit([2, place], other, numbers);
        self.triangles.springs_at(particle, reach, side);
    }

    /// Computes the damping of all that these particles have, by the present masses.
    pub(crate) fn damp(&mut self, particles: &[u32]) {
        let (time_s, w) = (self.damping_s, &self.inverse_masses);
        for particle in particles.iter().map(|&particle| particle as usize) {
            self.stretch.damp(particle, time_s, w);
            self.triangles.damp(particle, time_s, w);
        }
    }

    /// The pairs of particles that act on each other, once for each constraint and each side of a triangle.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + Clone + '_ {
        let colours = [&self.stretch, &self.bend].into_iter();
        let colours = colours.flat_map(|family| &family.colours);
        let springs = colours.flat_map(|colour| colour.ends.iter().copied());
        let triangles = self.triangles.list.iter();
        let sides =
            triangles.flat_map(|t| [0, 1, 2].map(|i| [t.vertices[i], t.vertices[(i + 1) % 3]]));
        springs.chain(sides)
    }

    /// Adds the second derivatives of the energy. With `clamp` every term is positive semidefinite; returns how
    /// many had a part dropped for it.
    pub(crate) fn add_hessian(&self, x: &[Point], clamp: bool, to: &mut Hessian) -> u64 {
        pair::add_hessian(&self.stretch, x, clamp, to)
            + pair::add_hessian(&self.bend, x, clamp, to)
            + self.triangles.add_hessian(x, clamp, to)
    }

    pub(crate) fn weights(&self) -> Weights<'_> {
        Weights {
            masses: &self.masses,
            inverse_masses: &self.inverse_masses,
        }
    }

    /// Adds the forces of constraints and triangles, in a guarded step with damping.
    pub(crate) fn add_forces(
        &self,
        x: &[Point],
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
    ) -> Pull {
        let ratio_max = self.stretch_ratio_max;
        let stretch = Pass {
            ratio_max,
            ratio_watched: self.ratio_watched,
            crush,
            is_damped: self.damping_s > 0.0,
        };
        let bend = Pass {
            ratio_watched: f64::INFINITY,
            is_damped: false,
            ..stretch
        };
        let passes = [(&self.stretch, stretch), (&self.bend, bend)];
        let [stretch, bend] =
            passes.map(|(family, pass)| pair::add_forces(family, pass, x, forces));
        let triangles = self.triangles.add_forces(x, ratio_max, crush, forces);
        stretch.and(bend).and(triangles)
    }

    /// The elastic energy of all constraints and triangles, in joules.
    pub(crate) fn elastic_j(&self, x: &[Point]) -> f64 {
        let sum = pair::energy(&self.bend, x, pair::energy(&self.stretch, x, 0.0));
        self.triangles.energy(x, sum)
    }

    pub(crate) fn drag_per_s(&self) -> f64 {
        self.loads.drag_per_s.unwrap_or(0.0)
    }

    pub(crate) fn gravity(&self) -> Vector {
        self.loads.gravity_m_per_s2.unwrap_or_else(Vector::zeros)
    }

    /// Takes a particle off its path.
    pub(crate) fn unlead(&mut self, particle: usize) {
        self.grabbed.retain(|(led, _)| *led as usize != particle);
    }

    /// Makes accelerations of forces, with gravity; held particles have none.
    pub(crate) fn weigh(&self, forces: &mut [Vector]) {
        for (a, &w) in forces.iter_mut().zip(&self.inverse_masses) {
            *a = self.acceleration(*a, w);
        }
    }

    /// As [`weigh`](Model::weigh), beside the forces, and with what is carried as heavy as that makes it.
    pub(crate) fn weigh_carried(
        &self,
        carry: Option<&MassScaling>,
        forces: &[Vector],
        accelerations: &mut [Vector],
    ) {
        let pulled = accelerations.iter_mut().zip(forces);
        let Some(carry) = carry.filter(|carry| carry.len() > 0) else {
            for ((a, force), &w) in pulled.zip(&self.inverse_masses) {
                *a = self.acceleration(*force, w);
            }
            return;
        };
        let gravity = self.gravity();
        for ((a, force), &mass) in pulled.zip(&self.masses) {
            *a = force + gravity * mass;
        }
        carry.accelerate(accelerations);
    }

    #[inline]
    fn acceleration(&self, force: Vector, inverse_mass: f64) -> Vector {
        match inverse_mass > 0.0 {
            true => force * inverse_mass + self.gravity(),
            false => Vector::zeros(),
        }
    }

    /// Adds the forces of wind.
    pub(crate) fn blow(
        &self,
        x: &[Point],
        v: &[Vector],
        forces: &mut [Vector],
        counters: &mut Counters,
    ) {
        if let Some(wind) = self.loads.wind {
            counters.wind_evaluations += 1;
            counters.features.wind += self.faces.len() as u64 / 3;
            wind.press(&self.faces, x, v, forces);
        }
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

    /// The multipliers of all constraints.
    pub(crate) fn multipliers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let families = [&mut self.stretch, &mut self.bend].into_iter();
        let colours = families.flat_map(|family| &mut family.colours);
        colours.flat_map(|colour| &mut colour.multipliers)
    }
}

/// The inverse mass of a particle: zero for one that is held or has no mass.
pub(crate) fn inverse(mass: f64, is_held: bool) -> f64 {
    if is_held || mass == 0.0 {
        0.0
    } else {
        1.0 / mass
    }
}
