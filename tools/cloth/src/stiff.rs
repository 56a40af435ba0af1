//! A system, stepped implicitly.
//!
//! The adapter between [`System`] and [`implicit`]: it hands the particles, the springs of both
//! families, the bends that buckle, the triangles, gravity, wind and drag over as slices, and takes
//! back positions and velocities.

use tearmesh::geometry::Vector;

use crate::bend::Buckling;
use crate::constraint::Constraints;
use crate::implicit::{
    self, Bend, Filter, Implicit, ModelError, Part, Settings, Spring, Tolerance,
};
use crate::solver::{Failure, SettingError, Solver};
use crate::system::System;

/// Implicit steps of a system: backward Euler or BDF2. Of springs, triangles, bends and drag they
/// are stable at any step; wind is taken in as it is where a step begins, and is stable up to
/// λ Δt = 2 ([`System::wind_rate`]).
///
/// ```
/// use tearmesh_cloth::implicit::{self, Settings, Tolerance};
/// use tearmesh_cloth::{ImplicitCloth, Loads, StepError, System};
/// use tearmesh::{Point, Vector};
///
/// let mut spring = System::new([Point::origin(), Point::new(0.0, 0.0, -1.0)], vec![0.1; 2])?;
/// spring.stretch([0, 1], 1.0, 50.0)?;
/// spring.hold(0);
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -9.81));
/// spring.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// let tolerance = Tolerance::Fixed(1e-10);
/// let mut solver = ImplicitCloth::new(Settings { tolerance, ..Settings::default() });
/// for _ in 0..200 {
///     spring.step(&mut solver, 0.5)?; // Far beyond the limit of an explicit method.
/// }
/// assert!((spring.positions()[1].z + 1.0 + 0.1 * 9.81 / 50.0).abs() < 1e-8);
///
/// // A step that misses its tolerance is not taken, and says by how much it misses.
/// let (x, _) = spring.state_mut();
/// x[1] = Point::new(0.3, 0.0, -1.0);
/// let settings = Settings { tolerance, newton_iterations_max: 2, ..Settings::default() };
/// let error = spring.step(&mut ImplicitCloth::new(settings), 0.5).unwrap_err();
/// let StepError::Implicit { error, .. } = error else { unreachable!() };
/// let implicit::StepError::NotConverged { residual, limit, .. } = error else { unreachable!() };
/// assert!(residual > limit && limit == 1e-10);
/// assert_eq!(spring.positions()[1], Point::new(0.3, 0.0, -1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ImplicitCloth {
    /// How to take a step.
    pub settings: Settings,
    solver: Implicit,
    filters: Vec<Filter>,
    accelerations: Vec<Vector>,
    springs: Vec<Spring>,
    bends: Vec<Bend>,
    triangles: Vec<implicit::Triangle>,
    report: Option<implicit::StepReport>,
}

impl ImplicitCloth {
    /// The method with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> ImplicitCloth {
        ImplicitCloth {
            settings,
            ..ImplicitCloth::default()
        }
    }

    /// What the last step that was taken did and cost.
    #[must_use]
    pub fn report(&self) -> Option<implicit::StepReport> {
        self.report
    }

    /// Forgets the previous step: for BDF2, after particles were renumbered by a merge. Where their
    /// number changed that is noticed.
    pub fn forget(&mut self) {
        self.solver.forget();
    }

    /// Gathers what the solver has to know.
    fn gather(&mut self, system: &mut System) {
        let System {
            positions,
            velocities,
            model,
            counters,
            ..
        } = system;
        self.accelerations.clear();
        self.accelerations.resize(positions.len(), Vector::zeros());
        model.external(positions, velocities, &mut self.accelerations, counters);
        let filter = |&w: &f64| if w > 0.0 { Filter::Free } else { Filter::Fixed };
        self.filters.clear();
        self.filters.extend(model.inverse_masses.iter().map(filter));
        self.springs.clear();
        self.bends.clear();
        self.gather_pairs(&model.stretch, None);
        self.gather_pairs(&model.bend, model.buckling);
        let triangles = model.triangles.as_slice().iter();
        self.triangles.clear();
        self.triangles.extend(triangles.map(|t| implicit::Triangle {
            vertices: t.vertices,
            rest_inverse: t.rest_inverse,
            area: t.area,
            stiffness: t.stiffness,
        }));
    }

    fn gather_pairs(&mut self, constraints: &Constraints, law: Option<Buckling>) {
        let law = law.and_then(|law| implicit::Buckling::new(law.buckles_below()));
        for batch in constraints.batches() {
            let numbers = batch.ends.iter().zip(batch.rest).zip(batch.stiffness);
            // Edges of a cloth of triangles alone are measured, and pull at nothing.
            let acting = numbers.filter(|(_, stiffness)| **stiffness > 0.0);
            for ((&ends, &rest_length), &stiffness) in acting {
                match law {
                    Some(law) => self.bends.push(law.bend(ends, rest_length, stiffness)),
                    None => self.springs.push(Spring {
                        ends,
                        rest_length,
                        stiffness,
                        tension_only: false,
                    }),
                }
            }
        }
    }
}

impl Solver for ImplicitCloth {
    fn check(&self) -> Result<(), SettingError> {
        let (Tolerance::Tied(given) | Tolerance::Fixed(given)) = self.settings.tolerance;
        let holds = given > 0.0 && given.is_finite();
        SettingError::unless(holds, "tolerance", given, "any above 0")
    }

    /// That of backward Euler, with which BDF2 begins, and begins anew after an edit.
    fn air_limit(&self) -> Option<f64> {
        Some(2.0)
    }

    fn takes_triangles(&self) -> bool {
        true
    }

    fn takes_buckling(&self) -> bool {
        true
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        self.gather(system);
        system.scratch.is_fresh = false;
        let model = implicit::Model {
            masses: &system.model.masses,
            filters: &self.filters,
            accelerations: &self.accelerations,
            springs: &self.springs,
            bends: &self.bends,
            triangles: &self.triangles,
            drag_per_s: system.model.drag_per_s(),
        };
        let (positions, velocities) = (&mut system.positions, &mut system.velocities);
        let settings = &self.settings;
        let before = self.solver.work();
        let step = self
            .solver
            .step(&model, positions, velocities, dt_s, settings);
        // What a step cost, whether it is taken or not.
        let work = self.solver.work().since(&before);
        system.counters.force_evaluations += work.force_evaluations;
        system.counters.matrix_products += work.matrix_products;
        if !system.model.triangles.as_slice().is_empty() {
            system.counters.triangle_evaluations +=
                work.force_evaluations + work.hessian_evaluations + work.energy_evaluations;
        }
        let report = step.map_err(failure)?;
        if !system.model.is_within_limit(&system.positions) {
            // The system goes back, and history must not tell of a step that was not taken.
            self.solver.forget();
            return Err(Failure::BlowUp);
        }
        self.report = Some(report);
        system.counters.overshoots += u64::from(report.overshot);
        system.collide();
        Ok(())
    }
}

/// A state that is beyond all measure already is no matter of the method.
fn failure(error: implicit::StepError) -> Failure {
    match error {
        implicit::StepError::Model(ModelError::Unusable {
            part: Part::Position | Part::Velocity,
            ..
        }) => Failure::BlowUp,
        error => Failure::Implicit(error),
    }
}
