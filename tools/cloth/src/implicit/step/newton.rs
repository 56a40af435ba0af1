//! Newton's method with a line search, for steps that ask for it and for those that overshot.
//!
//! Iterated from x* + h v₀ until the residual is small; the line search is on
//! Φ = E − Σ m g·x + ½ (1 + h c) Σ m |v − v*/(1 + h c)|², of which the equation is the gradient.
//!
//! **Overshoot.** A linearised step trusts its matrix however far it goes. A piece of one or two
//! triangles that spins by ω Δt > 1 flies apart along the tangent, to √(1 + (ω Δt)²) times its size;
//! where something is pushed together the matrix may be all but singular, and the step as
//! long as one likes. Both end above the Φ of where they started, which no solution near by
//! does. Such a step is taken back, and Newton's method goes down from there instead
//! ([`StepReport::overshot`]); so the stretch of what is thrown about is bounded by its energy.

use tearmesh::geometry::{Point, Vector, dot};

use super::{Implicit, Potential, Solver, Stage};
use crate::implicit::Model;
use crate::implicit::pcg::residual;
use crate::implicit::settings::{Settings, StepError, StepReport};

/// Newton's iterations for a step whose linearised answer was taken back.
const RESCUE_ITERATIONS: u32 = 50;

impl Implicit {
    /// Newton's method from the present velocities.
    pub(super) fn newton(
        &mut self,
        model: &Model<'_>,
        stage: Stage,
        settings: &Settings,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        report.newton_iterations = 0;
        self.place(stage);
        let mut phi = self.potential(model, stage);
        loop {
            model.forces(&self.trial, &mut self.forces);
            self.work.force_evaluations += 1;
            self.imbalance(model, stage);
            let left = residual(model, &self.pcg.b);
            report.residual = stage.velocity_error(left);
            let spent = report.newton_iterations >= settings.newton_iterations_max;
            if left <= stage.residual_max || spent || !left.is_finite() {
                return Ok(());
            }
            report.newton_iterations += 1;
            let at = std::mem::take(&mut self.trial);
            let mut solver = Solver {
                stage,
                settings,
                report,
            };
            let solved = solver.solve(model, &at, self, |own| own.imbalance(model, stage));
            self.trial = at;
            solved?;
            match self.search(model, stage, phi, left, report) {
                Search::Taken(next) => phi = next,
                Search::Rounding => {
                    report.limit = report.limit.max(report.residual);
                    return Ok(());
                }
                Search::Failed => return Ok(()),
            }
        }
    }

    /// Halves the step until Φ falls by a small part of what its slope promises (Armijo's rule);
    /// then takes it.
    ///
    /// Near the solution Φ no longer tells, because it is flat to its rounding; there a step
    /// is taken if it makes the residual smaller.
    fn search(
        &mut self,
        model: &Model<'_>,
        stage: Stage,
        phi: Potential,
        left: f64,
        report: &mut StepReport,
    ) -> Search {
        self.imbalance(model, stage);
        let slope = self.pcg.b.iter().zip(&self.pcg.delta);
        let slope: f64 = slope.fold(0.0, |sum, (b, d)| sum + dot(*b, *d));
        let from = std::mem::take(&mut self.trial_velocities);
        self.trial_velocities = std::mem::replace(&mut self.velocities, from);
        let mut part = 1.0;
        for _ in 0..40 {
            self.velocities.clear();
            let moved = self.trial_velocities.iter().zip(&self.pcg.delta);
            self.velocities
                .extend(moved.map(|(v, d)| v + d * (part / stage.h)));
            self.place(stage);
            let next = self.potential(model, stage);
            if next.value <= phi.value - 1e-4 * part * slope {
                return Search::Taken(next);
            }
            if next.value <= phi.value + phi.rounding {
                model.forces(&self.trial, &mut self.forces);
                self.work.force_evaluations += 1;
                self.imbalance(model, stage);
                if residual(model, &self.pcg.b) < left {
                    return Search::Taken(next);
                }
            }
            part *= 0.5;
            report.halvings += 1;
        }
        std::mem::swap(&mut self.velocities, &mut self.trial_velocities);
        self.place(stage);
        if slope <= phi.rounding {
            Search::Rounding
        } else {
            Search::Failed
        }
    }

    /// Φ where the step started: a step that ends above it has overshot.
    pub(super) fn level(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        v: &[Vector],
        stage: Stage,
    ) -> Potential {
        self.stay(model, x, v, stage);
        self.place(stage);
        let level = self.potential(model, stage);
        self.velocities.clear();
        self.velocities.extend_from_slice(v);
        level
    }

    /// Velocities that leave the particles at `x`, where the step started, in the directions in
    /// which they are free.
    pub(super) fn stay(&mut self, model: &Model<'_>, x: &[Point], v: &[Vector], stage: Stage) {
        self.velocities.clear();
        for (i, &v) in v.iter().enumerate() {
            let back = (x[i] - self.start[i]) / stage.h - v;
            self.velocities.push(v + model.filter(i).apply(back));
        }
    }

    /// Newton's method from where the step started, after the linearised step has overshot. True
    /// where it came down from there, if not all the way: that is as good as a linearised step
    /// can be, whose residual nobody asks for, and its stretch is bounded.
    pub(super) fn come_down(
        &mut self,
        model: &Model<'_>,
        stage: Stage,
        level: Potential,
        settings: &Settings,
        report: &mut StepReport,
    ) -> Result<bool, StepError> {
        report.overshot = true;
        let settings = Settings {
            newton_iterations_max: RESCUE_ITERATIONS,
            ..*settings
        };
        self.newton(model, stage, &settings, report)?;
        Ok(self.potential(model, stage).value < level.value)
    }
}

/// How a line search ended.
enum Search {
    Taken(Potential),
    /// What could be gained is below the rounding of the potential.
    Rounding,
    Failed,
}
