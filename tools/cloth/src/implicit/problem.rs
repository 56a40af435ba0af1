//! What a step is solved for: the one system, and what acts on it from outside.

use tearmesh::geometry::{Point, Vector, dot};

use super::Layout;
use crate::matrix::Hessian;
use crate::system::Model;

/// The equation of motion m a = −∇E(x) + m g − c m v: E and c of a model, and the accelerations g of
/// gravity and of wind, which do not change in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Problem<'a> {
    pub(super) model: &'a Model,
    pub(super) outside: &'a [Vector],
}

impl<'a> Problem<'a> {
    pub(super) fn masses(self) -> &'a [f64] {
        &self.model.masses
    }

    pub(super) fn is_free(self, particle: usize) -> bool {
        self.model.inverse_masses[particle] > 0.0
    }

    /// A vector of a particle, or nothing where that is held.
    #[inline]
    pub(super) fn filter(self, particle: usize, v: Vector) -> Vector {
        if self.is_free(particle) {
            v
        } else {
            Vector::zeros()
        }
    }

    /// The force on each particle, in N, also on those that are held; without drag.
    pub(super) fn forces(self, x: &[Point], forces: &mut Vec<Vector>) {
        forces.clear();
        let weights = self.outside.iter().zip(self.masses());
        forces.extend(weights.map(|(g, m)| g * *m));
        for kind in &self.model.kinds() {
            // Constraints that are far too long are found in the state in which a step ends.
            let _ = kind.forces(x, f64::INFINITY, None, forces);
        }
    }

    /// E − Σ m g · x, and an energy of motion.
    pub(super) fn potential(self, x: &[Point], inertia: f64) -> Potential {
        let inside = self.model.elastic_j(x);
        let particles = self.outside.iter().zip(self.masses()).zip(x);
        let (mut outside, mut size) = (0.0, 0.0);
        for ((g, m), x) in particles {
            let weight = m * dot(*g, x.coords);
            outside -= weight;
            size += weight.abs();
        }
        Potential {
            value: inside + outside + inertia,
            rounding: 64.0 * f64::EPSILON * (inside + size + inertia),
        }
    }

    pub(super) fn hessian(
        self,
        x: &[Point],
        layout: &Layout,
        clamp: bool,
        hessian: &mut Hessian,
    ) -> u64 {
        layout.hessian_at(self.model, x, clamp, hessian)
    }

    /// The forces on free particles that the rounding of their coordinates alone makes, as an rms
    /// acceleration: below it there is nothing to solve.
    pub(super) fn rounding(self, x: &[Point], hessian: &Hessian) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (i, (&m, x)) in self.masses().iter().zip(x).enumerate() {
            total += m;
            if self.is_free(i) {
                let [[a, _, _], [_, b, _], [_, _, c]] = hessian.diagonal[i].0;
                let force = (a + b + c) * (f64::EPSILON * x.coords.amax());
                sum += force * force / m;
            }
        }
        if total > 0.0 {
            (sum / total).sqrt()
        } else {
            0.0
        }
    }

    /// A force on each particle as an rms acceleration, √(rᵀ M⁻¹ r / Σm); zero where nothing has a
    /// mass.
    pub(super) fn residual(self, r: &[Vector]) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (&r, &m) in r.iter().zip(self.masses()) {
            sum += square_per_mass(r, m);
            total += m;
        }
        if total > 0.0 {
            (sum / total).sqrt()
        } else {
            0.0
        }
    }
}

/// r · r / m. What has no mass is held, and leaves no residual.
#[inline]
pub(super) fn square_per_mass(r: Vector, m: f64) -> f64 {
    if m > 0.0 { dot(r, r) / m } else { 0.0 }
}

/// The value of a potential and how much of it is rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Potential {
    pub(super) value: f64,
    pub(super) rounding: f64,
}
