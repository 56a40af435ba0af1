//! All of a system but its state: what its particles weigh, what joins them, and what acts on them.

use tearmesh::geometry::{Point, Vector};

use super::Counters;
use crate::buckle::{self, Bends, Slope};
use crate::constraint::{Constraint, Constraints};
use crate::implicit::Buckling;
use crate::kernel;
use crate::load::{Loads, Path};
use crate::triangles::Triangles;

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
    /// Where the forces of the last step are to be read.
    pub(crate) forces: Forces,
    /// Whether a limiter left ratios behind.
    pub(crate) is_limited: bool,
    /// Whether what the step before left in constraints is put aside.
    pub(super) is_aside: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Stretch,
    Bend,
}

/// Where the forces of the last step are to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Forces {
    /// In the lengths.
    #[default]
    Lengths,
    /// In the multipliers.
    Multipliers,
    /// The sum of both.
    Both,
}

/// What says how that is to be read which a step left behind in constraints.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Left {
    forces: Forces,
    is_limited: bool,
}

impl Model {
    pub(crate) fn family(&self, family: Family) -> &Constraints {
        match family {
            Family::Stretch => &self.stretch,
            Family::Bend => &self.bend,
        }
    }

    pub(crate) fn family_mut(&mut self, family: Family) -> &mut Constraints {
        match family {
            Family::Stretch => &mut self.stretch,
            Family::Bend => &mut self.bend,
        }
    }

    /// The springs of both families, colour by colour.
    pub(crate) fn springs(&self) -> impl Iterator<Item = kernel::Batch<'_>> {
        let bends = self.bend.batches().filter(|_| self.buckling.is_none());
        self.stretch.batches().chain(bends)
    }

    /// The bends that buckle, colour by colour.
    pub(crate) fn buckles(&self) -> impl Iterator<Item = Bends<'_>> {
        let batches = self.buckling.map(|law| (law, self.bend.batches()));
        let batches = batches.into_iter();
        batches.flat_map(|(law, batches)| batches.map(move |batch| Bends { batch, law }))
    }

    /// The largest stiffness of a constraint in any state, by the one that it has.
    pub(crate) fn stiffest(&self, family: Family) -> f64 {
        match (family, self.buckling) {
            (Family::Bend, Some(law)) => law.stiffest(),
            _ => 1.0,
        }
    }

    /// The energy in joules and the pull in newtons of a bend of this length.
    pub(crate) fn bend_axial(&self, constraint: &Constraint, length_m: f64) -> [f64; 2] {
        let (rest_length_m, k) = (constraint.rest_length_m, constraint.stiffness_n_per_m);
        match self.buckling {
            Some(law) => {
                let axial = buckle::axial(law, rest_length_m, k, length_m);
                [axial.energy, axial.force]
            }
            None => {
                let extension = length_m - rest_length_m;
                [0.5 * k * extension * extension, k * extension]
            }
        }
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
        counters.force_evaluations += 1;
        accelerations.fill(Vector::zeros());
        let mut sane = true;
        for batch in self.springs() {
            sane &= kernel::forces(batch, positions, self.stretch_ratio_max, accelerations);
        }
        for bends in self.buckles() {
            sane &= bends.forces(positions, self.stretch_ratio_max, accelerations);
        }
        let triangles = self.triangles.as_slice();
        if !triangles.is_empty() {
            counters.triangle_evaluations += 1;
            let ratio_max = self.stretch_ratio_max;
            sane &= kernel::triangle_forces(triangles, positions, ratio_max, accelerations);
        }
        self.external(positions, velocities, accelerations, counters);
        sane
    }

    /// Whether nothing is stretched beyond the limit, nor not a number: what [`Model::accelerate`]
    /// says of the same positions, for methods that do not ask it.
    #[must_use]
    pub(crate) fn is_within_limit(&self, positions: &[Point]) -> bool {
        let ratio_max = self.stretch_ratio_max;
        let triangles = self.triangles.as_slice();
        self.springs()
            .all(|batch| kernel::is_within(batch, positions, ratio_max))
            && self
                .buckles()
                .all(|bends| bends.are_within(positions, ratio_max))
            && kernel::triangles_are_within(triangles, positions, ratio_max)
    }

    /// Adds K u; see [`System::stiffness_times`](super::System::stiffness_times).
    pub(crate) fn stiffness_times(
        &self,
        slope: Slope,
        positions: &[Point],
        displacements: &[Vector],
        product: &mut [Vector],
        counters: &mut Counters,
    ) {
        counters.matrix_products += 1;
        for batch in self.springs() {
            kernel::stiffness_times(batch, positions, displacements, product);
        }
        for bends in self.buckles() {
            bends.stiffness_times(slope, positions, displacements, product);
        }
        let triangles = self.triangles.as_slice();
        if !triangles.is_empty() {
            counters.triangle_evaluations += 1;
            kernel::triangle_stiffness_times(triangles, positions, displacements, product);
        }
    }

    /// Adds the force of wind, and makes accelerations of forces, with gravity.
    pub(crate) fn external(
        &self,
        positions: &[Point],
        velocities: &[Vector],
        accelerations: &mut [Vector],
        counters: &mut Counters,
    ) {
        if let Some(wind) = self.loads.wind {
            counters.wind_evaluations += 1;
            kernel::wind(
                &self.faces,
                wind.coefficient,
                wind.velocity_m_per_s,
                positions,
                velocities,
                accelerations,
            );
        }
        let gravity = self.gravity();
        for (a, &w) in accelerations.iter_mut().zip(&self.inverse_masses) {
            *a = if w > 0.0 {
                *a * w + gravity
            } else {
                Vector::zeros()
            };
        }
    }

    /// Forgets what the last step left behind in constraints.
    pub(crate) fn forget(&mut self) {
        self.forces = Forces::Lengths;
        self.is_limited = false;
    }

    /// Begins a step: forgets what the last one left behind, and returns what it takes to
    /// [`go back`](Model::back_to).
    pub(crate) fn begin(&mut self) -> Left {
        let left = Left {
            forces: self.forces,
            is_limited: self.is_limited,
        };
        self.forget();
        self.is_aside = false;
        left
    }

    /// For a method that is about to write all multipliers, and maybe all ratios: puts those of the
    /// last step aside.
    pub(crate) fn set_aside(&mut self) {
        if !self.is_aside {
            self.stretch.set_aside();
            self.bend.set_aside();
            self.is_aside = true;
        }
    }

    /// Remembers what the step before the one that failed left behind.
    pub(crate) fn back_to(&mut self, left: Left) {
        if self.is_aside {
            self.stretch.take_back();
            self.bend.take_back();
            self.is_aside = false;
        }
        self.forces = left.forces;
        self.is_limited = left.is_limited;
    }

    /// Sets all multipliers to zero.
    pub(crate) fn clear_multipliers(&mut self) {
        self.set_aside();
        for family in [&mut self.stretch, &mut self.bend] {
            for (_, multipliers) in family.batches_mut() {
                multipliers.fill(0.0);
            }
        }
    }

    /// Makes forces of multipliers.
    pub(crate) fn scale_multipliers(&mut self, scale: f64) {
        for family in [&mut self.stretch, &mut self.bend] {
            for (_, multipliers) in family.batches_mut() {
                multipliers.iter_mut().for_each(|lambda| *lambda *= scale);
            }
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
