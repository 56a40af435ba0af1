//! States of rest: the positions where every force is balanced.
//!
//! Newton's method on the potential energy, with a line search. Where the energy has no
//! second derivative to hold on to – a flat sheet has none across its plane, a slack thread
//! none at all – or a wrong one, the step is bounded by a term σ M beside the matrix (Levenberg's
//! method): σ is the rms acceleration that is left over the length that a step may reach, so it
//! vanishes at rest and Newton's speed comes back. It grows after halvings and shrinks
//! after full steps. An indefinite matrix is assembled again without the terms that make it so.

use std::fmt;

use tearmesh::geometry::{Point, Vector, dot, max_abs};

use super::model::first_bad;
use super::pcg::{End, Stop, residual};
use super::step::Potential;
use super::{Implicit, Model, ModelError, Work};

/// When a state counts as being at rest, and how far to go for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestSettings {
    /// The largest component of force on any particle, in N, where it is free.
    pub force_tolerance_n: f64,
    /// How far a step may move particles where nothing else bounds it, in m.
    pub reach_m: f64,
    /// Newton's iterations.
    pub iterations_max: u32,
    /// Iterations of conjugate gradients in each of them.
    pub solver_iterations_max: u32,
}

impl Default for RestSettings {
    /// 1e-11 N, 0.1 m, 1000, 5000.
    fn default() -> RestSettings {
        RestSettings {
            force_tolerance_n: 1e-11,
            reach_m: 0.1,
            iterations_max: 1000,
            solver_iterations_max: 5000,
        }
    }
}

/// How a state of rest was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestReport {
    /// Newton's iterations.
    pub iterations: u32,
    /// Halvings of the line search.
    pub halvings: u32,
    /// How many matrices showed that they are indefinite.
    pub indefinite: u32,
    /// How many terms of matrices that were used had a part dropped.
    pub clamped: u64,
    /// The largest component of force that is left, in N.
    pub residual: f64,
    /// What it cost.
    pub work: Work,
}

/// Why no state of rest was found. Positions are as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestError {
    /// The model or a position cannot be used.
    Model(ModelError),
    /// The iterations were spent, or no step lowered the energy.
    NotConverged {
        /// The largest component of force that was left, in N.
        residual: f64,
        /// What was asked for, in N.
        limit: f64,
        /// Newton's iterations.
        iterations: u32,
    },
}

impl fmt::Display for RestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RestError::Model(error) => error.fmt(f),
            RestError::NotConverged {
                residual,
                limit,
                iterations,
            } => write!(
                f,
                "after {iterations} iterations a force of {residual} N is left, above {limit} N"
            ),
        }
    }
}

impl std::error::Error for RestError {}

impl From<ModelError> for RestError {
    fn from(error: ModelError) -> RestError {
        RestError::Model(error)
    }
}

impl Implicit {
    /// Moves the positions to a state of rest near by. Drag has no part in it; what is held
    /// stays where it is in the directions in which it is held.
    ///
    /// The history for BDF2 is forgotten.
    ///
    /// # Errors
    ///
    /// See [`RestError`]. Positions are not changed then.
    pub fn rest(
        &mut self,
        model: &Model<'_>,
        positions: &mut [Point],
        settings: &RestSettings,
    ) -> Result<RestReport, RestError> {
        let still = vec![Vector::zeros(); positions.len()];
        self.prepare(model, positions, &still)?;
        let before = self.work;
        let mut x = positions.to_vec();
        let mut report = RestReport {
            iterations: 0,
            halvings: 0,
            indefinite: 0,
            clamped: 0,
            residual: f64::INFINITY,
            work: Work::default(),
        };
        let mut damping = 1.0;
        let mut phi = self.rest_potential(model, &x);
        loop {
            let left = self.unbalanced(model, &x);
            report.residual = self.pcg.b.iter().fold(0.0, |most, b| max_abs(*b).max(most));
            // Written so that a NaN goes on to the error.
            if report.residual <= settings.force_tolerance_n {
                break;
            }
            let spent = report.iterations >= settings.iterations_max || !left.is_finite();
            let stuck = damping > 1e12;
            if spent || stuck {
                return Err(RestError::NotConverged {
                    residual: report.residual,
                    limit: settings.force_tolerance_n,
                    iterations: report.iterations,
                });
            }
            report.iterations += 1;
            let sigma = damping * left / settings.reach_m;
            self.rest_direction(model, &x, sigma, settings, &mut report);
            let halvings = report.halvings;
            if let Some(next) = self.descend(model, &mut x, phi, left, &mut report) {
                phi = next;
                damping *= if report.halvings > halvings {
                    4.0
                } else {
                    0.25
                };
                damping = damping.max(1e-6);
            } else {
                damping = (damping * 16.0).max(1.0);
            }
        }
        positions.copy_from_slice(&x);
        self.forget();
        report.work = self.work.since(&before);
        Ok(report)
    }

    /// The forces at `x` where particles are free, into `pcg.b`; returns their rms acceleration.
    fn unbalanced(&mut self, model: &Model<'_>, x: &[Point]) -> f64 {
        model.forces(x, &mut self.forces);
        self.work.force_evaluations += 1;
        self.pcg.b.clear();
        let forces = self.forces.iter().enumerate();
        self.pcg
            .b
            .extend(forces.map(|(i, &f)| model.filter(i).apply(f)));
        residual(model, &self.pcg.b)
    }

    /// Newton's direction at `x`, into `pcg.delta`, with σ M beside the matrix.
    fn rest_direction(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        sigma: f64,
        settings: &RestSettings,
        report: &mut RestReport,
    ) {
        let stop = Stop {
            residual: 0.0,
            relative: 1e-4,
            iterations: settings.solver_iterations_max,
        };
        for clamp in [false, true] {
            let clamped = model.hessian(x, &self.layout, clamp, &mut self.hessian);
            self.work.hessian_evaluations += 1;
            self.unbalanced(model, x);
            let pairs = self.layout.pairs();
            let solved = self
                .pcg
                .solve(model, &self.hessian, pairs, sigma, stop, &mut self.work);
            if solved.end != End::Indefinite {
                report.clamped += clamped;
                return;
            }
            report.indefinite += 1;
        }
    }

    /// Halves the step until the potential falls enough, and takes it. `None`, and `x` as it
    /// was, if it never does.
    fn descend(
        &mut self,
        model: &Model<'_>,
        x: &mut Vec<Point>,
        phi: Potential,
        left: f64,
        report: &mut RestReport,
    ) -> Option<Potential> {
        self.unbalanced(model, x);
        let slope = self.pcg.b.iter().zip(&self.pcg.delta);
        let slope: f64 = slope.fold(0.0, |sum, (b, d)| sum + dot(*b, *d));
        let mut part = 1.0;
        for _ in 0..40 {
            let mut trial = std::mem::take(&mut self.trial);
            trial.clear();
            trial.extend(x.iter().zip(&self.pcg.delta).map(|(x, d)| x + d * part));
            let usable = first_bad(&trial, &[]).is_none();
            let next = self.rest_potential(model, &trial);
            let mut taken = usable && next.value <= phi.value - 1e-4 * part * slope;
            if !taken && usable && next.value <= phi.value + phi.rounding {
                taken = self.unbalanced(model, &trial) < left;
            }
            if taken {
                self.trial = std::mem::replace(x, trial);
                return Some(next);
            }
            self.trial = trial;
            part *= 0.5;
            report.halvings += 1;
        }
        None
    }

    fn rest_potential(&mut self, model: &Model<'_>, x: &[Point]) -> Potential {
        self.work.energy_evaluations += 1;
        Potential::of(model, x, 0.0)
    }
}
