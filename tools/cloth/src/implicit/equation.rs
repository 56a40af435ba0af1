//! The equation of a step, and where its solution has got to.
//!
//! M (v − v*) = h [ f(x* + h v) − c M v ] for the new velocity v, which is the gradient of the
//! potential Φ = E − Σ m g·x + ½ (1 + h c) Σ m |v − v*/(1 + h c)|².

use tearmesh::geometry::{Point, Vector, dot};

use super::pcg::{End, LinearSolution, Pcg, Stop};
use super::problem::{Potential, Problem};
use super::settings::{Jacobian, Settings, StepError, StepReport, Work};
use super::{Layout, Method};
use crate::matrix::Hessian;

/// The numbers of a step: its length h, and what follows from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    pub(super) method: Method,
    pub(super) time_step_s: f64,
    pub(super) h: f64,
    /// 1 + h c.
    pub(super) dragged: f64,
    /// The weight of M in the matrix, (1 + h c)/h².
    pub(super) inertia: f64,
    /// The rms acceleration of the residual that the tolerance allows.
    pub(super) residual_max: f64,
}

impl Stage {
    /// What an rms acceleration of the residual means for the velocity.
    pub(super) fn velocity_error(&self, acceleration: f64) -> f64 {
        acceleration * self.h / self.dragged
    }
}

/// The matrix and its layout, and the vectors of a step; kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Equation {
    pub(super) layout: Layout,
    pub(super) work: Work,
    /// x*.
    pub(super) start: Vec<Point>,
    /// v*.
    pub(super) start_velocities: Vec<Vector>,
    /// v, as far as it is known.
    pub(super) velocities: Vec<Vector>,
    /// x* + h v, where [`Equation::place`] has been called since.
    pub(super) trial: Vec<Point>,
    /// f where it was asked for last.
    pub(super) forces: Vec<Vector>,
    pub(super) pcg: Pcg,
    /// The rounding of forces where the matrix was made last, as an rms acceleration.
    pub(super) rounding: f64,
    /// Room for velocities.
    pub(super) room: Vec<Vector>,
    hessian: Hessian,
    product: Vec<Vector>,
}

impl Equation {
    /// x* + h v, into `trial`.
    pub(super) fn place(&mut self, stage: Stage) {
        self.trial.clear();
        let ends = self.start.iter().zip(&self.velocities);
        self.trial.extend(ends.map(|(x, v)| x + v * stage.h));
    }

    /// Φ at the trial positions.
    pub(super) fn potential(&mut self, problem: Problem<'_>, stage: Stage) -> Potential {
        self.work.energy_evaluations += 1;
        let mut inertia = 0.0;
        let moving = self.velocities.iter().zip(&self.start_velocities);
        for ((v, s), m) in moving.zip(problem.masses()) {
            let change = v - s / stage.dragged;
            inertia += 0.5 * stage.dragged * m * dot(change, change);
        }
        problem.potential(&self.trial, inertia)
    }

    /// Takes the forces at these positions.
    pub(super) fn pull(&mut self, problem: Problem<'_>, x: &[Point]) {
        problem.forces(x, &mut self.forces);
        self.work.force_evaluations += 1;
    }

    /// Takes the forces at the trial positions.
    pub(super) fn pull_at_trial(&mut self, problem: Problem<'_>) {
        problem.forces(&self.trial, &mut self.forces);
        self.work.force_evaluations += 1;
    }

    /// All that acts on the free particles where the forces were taken last, with drag on these
    /// velocities, as an rms acceleration.
    pub(super) fn load(&mut self, problem: Problem<'_>, v: &[Vector]) -> f64 {
        let drag_per_s = problem.model.drag_per_s();
        self.pcg.b.clear();
        for (i, (&f, &v)) in self.forces.iter().zip(v).enumerate() {
            let all = f - v * (drag_per_s * problem.masses()[i]);
            self.pcg.b.push(problem.filter(i, all));
        }
        problem.residual(&self.pcg.b)
    }

    /// f − M ((1 + h c) v − v*)/h for the present velocities and forces, into `pcg.b`.
    pub(super) fn imbalance(&mut self, problem: Problem<'_>, stage: Stage) {
        self.pcg.b.clear();
        for (i, (&f, &v)) in self.forces.iter().zip(&self.velocities).enumerate() {
            let change = v * stage.dragged - self.start_velocities[i];
            let b = f - change * (problem.masses()[i] / stage.h);
            self.pcg.b.push(problem.filter(i, b));
        }
    }

    /// The imbalance of the equation less H `shift`, with the exact second derivatives.
    fn imbalance_less(&mut self, problem: Problem<'_>, stage: Stage, shift: &[Vector]) {
        self.hessian
            .product(self.layout.pairs(), shift, &mut self.product);
        self.work.matrix_products += 1;
        self.imbalance(problem, stage);
        for (b, p) in self.pcg.b.iter_mut().zip(&self.product) {
            *b -= p;
        }
    }

    /// Newton's direction at `x`, into `pcg.delta`, with the fallback where the matrix is indefinite;
    /// less that of a shift in positions, where there is one.
    pub(super) fn solve(
        &mut self,
        problem: Problem<'_>,
        stage: Stage,
        x: &[Point],
        shift: Option<&[Vector]>,
        settings: &Settings,
        report: &mut StepReport,
    ) -> Result<LinearSolution, StepError> {
        let mut clamp = settings.jacobian == Jacobian::Clamped;
        loop {
            let clamped = problem.hessian(x, &self.layout, clamp, &mut self.hessian);
            self.work.hessian_evaluations += 1;
            self.rounding = problem.rounding(x, &self.hessian);
            match shift {
                Some(shift) => self.imbalance_less(problem, stage, shift),
                None => self.imbalance(problem, stage),
            }
            let newton = settings.newton_iterations_max > 1;
            let stop = Stop {
                residual: (stage.residual_max * if newton { 0.25 } else { 1.0 }).max(self.rounding),
                // No residual can be smaller than the rounding of the right-hand side.
                relative: 1e-14,
                iterations: settings.solver_iterations_max,
            };
            let (pairs, work) = (self.layout.pairs(), &mut self.work);
            let solved = self
                .pcg
                .solve(problem, &self.hessian, pairs, stage.inertia, stop, work);
            if solved.end != End::Indefinite || clamp {
                report.clamped += clamped;
                return Ok(solved);
            }
            report.indefinite += 1;
            if settings.jacobian == Jacobian::Exact {
                let time_step_s = stage.time_step_s;
                return Err(StepError::Indefinite { time_step_s });
            }
            clamp = true;
        }
    }
}
