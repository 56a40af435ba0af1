//! The largest frequency of a system, and how it stays known while the cloth tears.
//!
//! Two numbers, the cheap one first:
//!
//! * **A bound** that holds in every configuration: a spring is at most as stiff as k in each
//!   direction, so by Gershgorin's rows of √k Bᵀ M⁻¹ B √k every ω² is at most
//!   √k (w S + w′ S′) of some spring, where w and w′ are the inverse masses of its ends, and S the
//!   sum of √k over the springs of a particle. An edit raises it by the rows it touches, in
//!   the time that their valence takes. It never falls on the way, so it stays a bound.
//! * **A measure** by power iteration on M⁻¹ K in the present configuration, from below, used
//!   with a margin. It is made only where the bound does not clear the step, starts from the
//!   vector it found last, and is kept until topology, a mass or a stiffness change.
//!
//! The rows of K itself, which are cheaper, give 0.657 of the true limit or less.

use super::constraint::{ConstraintId, Constraints};
use super::kernel;
use super::system::{Model, System};
use crate::geometry::{Point, Vector, dot};

/// The largest frequency of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequency {
    /// The angular frequency ω, in rad/s.
    pub omega_rad_per_s: f64,
    /// How well ω² and the vector fit: |M⁻¹ K u − ω² u| / ω², weighed by mass.
    pub residual: f64,
    /// The particles of the constraint that moves most in it, by energy.
    pub ends: Option<[usize; 2]>,
}

/// What is known about frequencies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spectrum {
    /// A bound of ω²; `None` until it is asked for.
    bound: Option<f64>,
    measured: Option<Frequency>,
    /// The vector that the power iteration found last.
    vector: Vec<Vector>,
    product: Vec<Vector>,
}

impl Spectrum {
    pub(crate) fn touched(&mut self, model: &Model, particles: &[usize]) {
        self.measured = None;
        if let Some(bound) = self.bound {
            let rows = particles.iter().map(|&particle| rows_at(model, particle));
            self.bound = Some(rows.fold(bound, f64::max));
        }
    }

    /// The vector follows a particle that gets the last index, as a copy.
    pub(crate) fn push_particle(&mut self, like: Option<usize>) {
        if !self.vector.is_empty() {
            let value = like.map_or_else(Vector::zeros, |particle| self.vector[particle]);
            self.vector.push(value);
        }
    }

    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        if !self.vector.is_empty() {
            self.vector.swap_remove(particle);
        }
    }
}

/// The sum of √k over the springs of a particle.
fn root_sum(model: &Model, particle: usize) -> f64 {
    let of = |family: &Constraints| -> f64 {
        let root = |id: ConstraintId| family.get(id).stiffness_n_per_m.sqrt();
        family.of(particle).map(root).sum()
    };
    of(&model.stretch) + of(&model.bend)
}

/// The largest row among the springs of the neighbours of a particle and its own: all rows that
/// its mass and springs have a part in.
fn rows_at(model: &Model, particle: usize) -> f64 {
    let mut largest = 0.0_f64;
    let own = model.inverse_masses[particle] * root_sum(model, particle);
    for family in [&model.stretch, &model.bend] {
        for id in family.of(particle) {
            let constraint = family.get(id);
            let [a, b] = constraint.ends;
            let other = a + b - particle;
            let far = model.inverse_masses[other] * root_sum(model, other);
            largest = largest.max(constraint.stiffness_n_per_m.sqrt() * (own + far));
        }
    }
    largest
}

impl System {
    /// A bound of ω, in rad/s, that holds in every configuration. Linear the first time, then
    /// known.
    pub fn frequency_bound(&mut self) -> f64 {
        if self.spectrum.bound.is_none() {
            let model = &self.model;
            let sums: Vec<f64> = (0..self.positions.len())
                .map(|particle| model.inverse_masses[particle] * root_sum(model, particle))
                .collect();
            let mut bound = 0.0_f64;
            for batch in model.batches() {
                for (&[a, b], &k) in batch.ends.iter().zip(batch.stiffness) {
                    bound = bound.max(k.sqrt() * (sums[a as usize] + sums[b as usize]));
                }
            }
            self.spectrum.bound = Some(bound);
        }
        self.spectrum.bound.unwrap_or_default().sqrt()
    }

    /// The bound if it is known: no more than a look.
    #[must_use]
    pub fn known_frequency_bound(&self) -> Option<f64> {
        self.spectrum.bound.map(f64::sqrt)
    }

    /// The largest frequency in the present configuration, to 1 % of ω², kept until topology,
    /// a mass or a stiffness change.
    pub fn frequency(&mut self) -> Frequency {
        if let Some(frequency) = self.spectrum.measured {
            return frequency;
        }
        let frequency = self.measure_frequency(0.01, 200);
        self.spectrum.measured = Some(frequency);
        frequency
    }

    /// The largest frequency in the present configuration, by power iteration until
    /// the residual is at most `tolerance`, or so many products. From below: the true one is
    /// larger by about the residual.
    pub fn measure_frequency(&mut self, tolerance: f64, products: u32) -> Frequency {
        self.start_vector();
        let (model, x) = (&self.model, &self.positions);
        let Spectrum {
            vector: u, product, ..
        } = &mut self.spectrum;
        let mut frequency = Frequency {
            omega_rad_per_s: 0.0,
            residual: 0.0,
            ends: None,
        };
        for _ in 0..products.max(1) {
            let norm = inner(model, u, u).sqrt();
            if norm == 0.0 {
                return frequency;
            }
            u.iter_mut().for_each(|u| *u /= norm);
            self.counters.matrix_products += 1;
            accelerations_by(model, x, u, product);
            let square = inner(model, u, product);
            let misses = product.iter().zip(u.iter()).zip(&model.masses);
            let miss = misses.map(|((&p, &u), m)| {
                let rest = p - u * square;
                m * dot(rest, rest)
            });
            frequency.residual = miss.sum::<f64>().sqrt() / square.max(f64::MIN_POSITIVE);
            frequency.omega_rad_per_s = square.max(0.0).sqrt();
            if square <= 0.0 || frequency.residual <= tolerance {
                break;
            }
            std::mem::swap(u, product);
        }
        frequency.ends = busiest(model, x, u);
        frequency
    }

    /// Begins with the last vector, and some of every direction.
    fn start_vector(&mut self) {
        let count = self.positions.len();
        let vector = &mut self.spectrum.vector;
        let known = vector.len() == count;
        vector.resize(count, Vector::zeros());
        let share = if known {
            1e-3 / (count as f64).sqrt()
        } else {
            1.0
        };
        let mut state = 0u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for (q, &w) in vector.iter_mut().zip(&self.model.inverse_masses) {
            let noise = Vector::new(random(), random(), random());
            *q = if w > 0.0 {
                *q + noise * share
            } else {
                Vector::zeros()
            };
        }
        self.spectrum.product.resize(count, Vector::zeros());
    }
}

/// Σ m u · v.
fn inner(model: &Model, u: &[Vector], v: &[Vector]) -> f64 {
    let pairs = u.iter().zip(v).zip(&model.masses);
    pairs.map(|((&u, &v), m)| m * dot(u, v)).sum()
}

/// M⁻¹ K u.
fn accelerations_by(model: &Model, x: &[Point], u: &[Vector], product: &mut [Vector]) {
    product.fill(Vector::zeros());
    for batch in model.batches() {
        kernel::stiffness_times(batch, x, u, product);
    }
    for (p, &w) in product.iter_mut().zip(&model.inverse_masses) {
        *p *= w;
    }
}

/// The ends of the constraint with the most energy in a vector.
fn busiest(model: &Model, x: &[Point], u: &[Vector]) -> Option<[usize; 2]> {
    let mut most = None;
    for batch in model.batches() {
        for ((&ends, &rest), &k) in batch.ends.iter().zip(batch.rest).zip(batch.stiffness) {
            let [a, b] = ends.map(|end| end as usize);
            let between = u[b] - u[a];
            let energy = dot(between, kernel::pull(x[b] - x[a], rest, k, between));
            if most.is_none_or(|(largest, _)| energy > largest) {
                most = Some((energy, [a, b]));
            }
        }
    }
    most.map(|(_, ends)| ends)
}
