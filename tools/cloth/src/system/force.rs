//! The forces in constraints, and what it takes to hold a particle.
//!
//! A method with physical stiffness has the force of a spring in its length. [`Pbd`] and
//! [`Xpbd`] move particles instead, and their force is what they accumulated as multipliers;
//! [`Provot`] has both, the spring's and the limiter's. A step leaves behind which it was, so that
//! tear thresholds in newtons and force probes need not know the method.
//!
//! [`Pbd`]: crate::Pbd
//! [`Xpbd`]: crate::Xpbd
//! [`Provot`]: crate::Provot

use tearmesh::geometry::Vector;

use super::{Family, System};
use crate::constraint::ConstraintId;

impl System {
    /// The force in a stretch constraint by its length, k (l − L), in newtons; tension is
    /// positive.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn tension_n(&self, id: ConstraintId) -> f64 {
        let constraint = self.model.stretch.get(id);
        self.model
            .axial(Family::Stretch, &constraint, &self.positions)[1]
    }

    /// The force in a stretch constraint by the multiplier of the last step of
    /// [`Xpbd`](crate::Xpbd) or [`Pbd`](crate::Pbd), −λ/Δt², in newtons; tension is
    /// positive. Of [`Provot`](crate::Provot), the share of the limiter. Zero before one.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn multiplier_n(&self, id: ConstraintId) -> f64 {
        -self.model.stretch.memory(id).multiplier
    }

    /// The force in a stretch constraint by the method of the last step, in newtons; tension is
    /// positive. By the length for methods with physical stiffness and before any step
    /// ([`System::tension_n`]), by the multiplier for those that project
    /// ([`System::multiplier_n`]), and the sum of both where a limiter helped the springs.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn force_n(&self, id: ConstraintId) -> f64 {
        let by_multiplier = self.multiplier_n(id);
        self.model.forces.read(|| self.tension_n(id), by_multiplier)
    }

    /// The length of a stretch constraint as a multiple of its rest length, as it was in the last
    /// step before a limiter shortened it; [`System::stretch_ratio`] where there was none.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn unlimited_ratio(&self, id: ConstraintId) -> f64 {
        if self.model.is_limited {
            self.model.stretch.memory(id).ratio
        } else {
            self.stretch_ratio(id)
        }
    }

    /// The force, in newtons, that whoever holds or leads a particle exerts on it: minus the sum of
    /// the constraints' forces ([`System::force_n`]), those of triangles, gravity, wind and drag.
    /// Of a grabbed particle that is a force probe; for a free one it is minus the force that
    /// accelerates it, which vanishes at rest. Inertia of a path's corners is not in it, nor are
    /// colliders. Costs the valence; linear with wind.
    ///
    /// After a step of a projecting method forces are means over the last substep, which is the
    /// more exact the more sweeps there were.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    ///
    /// ```
    /// use tearmesh_cloth::{Loads, System};
    /// use tearmesh::{Point, Vector};
    ///
    /// let points = [Point::origin(), Point::new(0.0, 0.0, -1.1)];
    /// let mut spring = System::new(points, vec![0.5; 2])?;
    /// spring.stretch([0, 1], 1.0, 50.0)?;
    /// spring.hold(0);
    /// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -10.0));
    /// spring.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
    /// let hand = spring.reaction_n(0);
    /// assert!((hand.z - (50.0 * 0.1 + 0.5 * 10.0)).abs() < 1e-12); // The spring, and its own weight.
    /// assert!(spring.reaction_n(1).norm() < 1e-12); // At rest.
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn reaction_n(&self, particle: usize) -> Vector {
        let drag = self.velocities[particle] * self.model.drag_per_s();
        -(self.inner_n(particle) + self.wind_n(particle) - drag * self.model.masses[particle])
    }

    /// The force of constraints, triangles and gravity on a particle, in newtons.
    pub(crate) fn inner_n(&self, particle: usize) -> Vector {
        let model = &self.model;
        let mut sum = model.gravity() * model.masses[particle];
        for kind in &model.kinds() {
            kind.force_at(&self.positions, particle, model.forces, &mut sum);
        }
        sum
    }

    fn wind_n(&self, particle: usize) -> Vector {
        let mut sum = Vector::zeros();
        let Some(wind) = self.model.loads.wind else {
            return sum;
        };
        for face in self.model.faces.chunks_exact(3) {
            let Some(corner) = face.iter().position(|&v| v as usize == particle) else {
                continue;
            };
            let corners = [0, 1, 2].map(|i| face[i] as usize);
            let mut sums = [Vector::zeros(); 3];
            let (x, v) = (
                corners.map(|v| self.positions[v]),
                corners.map(|v| self.velocities[v]),
            );
            wind.press(&[0, 1, 2], &x, &v, &mut sums);
            sum += sums[corner];
        }
        sum
    }
}
