//! What can be measured of a system: lengths, energies, accelerations.

use tearmesh::geometry::{Vector, dot};

use super::{Family, System};
use crate::constraint::{Constraint, ConstraintId};
use crate::element::Slope;
use crate::pair;

impl System {
    /// The length of a stretch constraint as a multiple of its rest length.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn stretch_ratio(&self, id: ConstraintId) -> f64 {
        let constraint = self.model.stretch.get(id);
        self.length_m(&constraint) / constraint.rest_length_m
    }

    pub(crate) fn length_m(&self, constraint: &Constraint) -> f64 {
        pair::length(&self.positions, constraint.ends)
    }

    /// The elastic energy of all constraints and triangles, in joules.
    #[must_use]
    pub fn elastic_energy_j(&self) -> f64 {
        self.model.elastic_j(&self.positions)
    }

    /// The elastic energy of a constraint of a family, in joules, whether it is one of this system
    /// or was.
    pub(crate) fn elastic_of(&self, family: Family, constraint: &Constraint) -> f64 {
        self.model.axial(family, constraint, &self.positions)[0]
    }

    /// The elastic energy of all that a particle has a part in, in joules.
    pub(crate) fn elastic_at_j(&self, particle: usize) -> f64 {
        self.model.elastic_at_j(&self.positions, particle)
    }

    /// The kinetic energy of the particles that are not held, in joules.
    #[must_use]
    pub fn kinetic_energy_j(&self) -> f64 {
        let particles = 0..self.positions.len();
        particles.map(|particle| self.kinetic_j(particle)).sum()
    }

    pub(crate) fn kinetic_j(&self, particle: usize) -> f64 {
        if self.model.held[particle] {
            return 0.0;
        }
        let v = self.velocities[particle];
        0.5 * self.model.masses[particle] * dot(v, v)
    }

    /// The accelerations of all particles, in m/s², without drag. Counts as a force evaluation. False
    /// where something is stretched beyond all measure ([`System::set_stretch_ratio_max`]).
    pub fn accelerations(&mut self, accelerations: &mut Vec<Vector>) -> bool {
        accelerations.clear();
        accelerations.resize(self.positions.len(), Vector::zeros());
        self.model.accelerate(
            &self.positions,
            &self.velocities,
            accelerations,
            &mut self.counters,
        )
    }

    /// The root mean square of the strains l/L − 1 of all stretch constraints.
    #[must_use]
    pub fn strain_rms(&self) -> f64 {
        let squares = self.model.stretch.iter().map(|id| {
            let strain = self.stretch_ratio(id) - 1.0;
            strain * strain
        });
        (squares.sum::<f64>() / self.model.stretch.len().max(1) as f64).sqrt()
    }

    /// The product K u of the stiffness matrix with displacements in metres, in newtons: minus
    /// the change of forces, to first order. Negative stiffness, which springs under
    /// compression have across, counts as zero (the indefinite terms are dropped); that of bends
    /// which buckle does as well.
    ///
    /// # Panics
    ///
    /// Unless there is one displacement a particle.
    #[must_use]
    pub fn stiffness_times(&mut self, displacements: &[Vector]) -> Vec<Vector> {
        assert_eq!(
            displacements.len(),
            self.positions.len(),
            "one displacement a particle"
        );
        let mut product = vec![Vector::zeros(); displacements.len()];
        let (model, counters) = (&self.model, &mut self.counters);
        let x = &self.positions;
        model.stiffness_times(Slope::Now, x, displacements, &mut product, counters);
        product
    }
}
