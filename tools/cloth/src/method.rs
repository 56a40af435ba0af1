//! The methods that advance a cloth, as data with their settings, the solver of each, and what that
//! reports about its own steps.

use crate::implicit::{Implicit, Settings, StepReport};
use crate::provot::{Limiter, LimiterReport, Provot};
use crate::solver::{Abilities, Failure, SettingError, Solver};
use crate::stability::carried_count;
use crate::system::System;
use crate::verlet::Verlet;
use crate::xpbd::{Pbd, Xpbd};

/// A method that advances a cloth, with its settings.
///
/// ```
/// use tearmesh_cloth::{Method, System};
/// use tearmesh::Point;
///
/// let mut stone = System::new([Point::origin()], vec![1.0])?;
/// stone.step(&mut Method::implicit().solver(), 0.01)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub enum Method {
    /// Provot's mass-spring model with its limiter ([`Provot`]). The tearing rule
    /// uses lengths before the limiter changes them.
    Provot(Limiter),
    /// Position based dynamics ([`Pbd`]).
    Pbd(Pbd),
    /// Velocity Verlet with guards ([`Verlet`]). This is the default, and exact at
    /// rest at every step.
    Verlet,
    /// Extended position based dynamics ([`Xpbd`]).
    Xpbd(Xpbd),
    /// An implicit method ([`Implicit`]).
    Implicit(Settings),
}

impl Method {
    /// Returns Provot's model with the settings that scenes use by default.
    #[must_use]
    pub fn provot() -> Method {
        Method::Provot(Limiter::default())
    }

    /// Returns [`Pbd`] with the settings that scenes use by default.
    #[must_use]
    pub fn pbd() -> Method {
        Method::Pbd(Pbd::default())
    }

    /// Returns [`Xpbd`] with the settings that scenes use by default. A step is one sweep, so that
    /// the cloth can tear after each sweep.
    #[must_use]
    pub fn xpbd() -> Method {
        Method::Xpbd(Xpbd::new(1, 1))
    }

    /// Returns [`Implicit`] with the settings that scenes use by default: an error
    /// of at most 0.2 mm/s in a step of 1/240 s.
    #[must_use]
    pub fn implicit() -> Method {
        Method::Implicit(Settings {
            tolerance: 10.0,
            ..Settings::default()
        })
    }

    /// Returns a solver with these settings, before its first step.
    #[must_use]
    pub fn solver(&self) -> impl Solver + Send + Sync + use<> {
        MethodSolver::new(self)
    }
}

/// A method with its state.
pub(crate) enum MethodSolver {
    /// The tearing rule sees lengths as they were before the limiter.
    Provot(Provot, LimiterStats),
    Pbd(Pbd),
    Verlet(Verlet),
    Xpbd(Xpbd),
    Implicit(Box<Implicit>, ImplicitStats),
    /// One that is no [`Method`], of the caller.
    Own(Box<dyn Solver + Send + Sync>),
}

impl MethodSolver {
    pub(crate) fn new(method: &Method) -> MethodSolver {
        match *method {
            Method::Provot(limiter) => {
                MethodSolver::Provot(Provot::new(limiter), LimiterStats::default())
            }
            Method::Pbd(pbd) => MethodSolver::Pbd(pbd),
            Method::Verlet => MethodSolver::Verlet(Verlet::new()),
            Method::Xpbd(xpbd) => MethodSolver::Xpbd(xpbd),
            Method::Implicit(settings) => {
                MethodSolver::Implicit(Box::new(Implicit::new(settings)), ImplicitStats::default())
            }
        }
    }

    fn solver(&self) -> &dyn Solver {
        match self {
            MethodSolver::Provot(provot, _) => provot,
            MethodSolver::Pbd(pbd) => pbd,
            MethodSolver::Verlet(verlet) => verlet,
            MethodSolver::Xpbd(xpbd) => xpbd,
            MethodSolver::Implicit(implicit, _) => &**implicit,
            MethodSolver::Own(solver) => &**solver,
        }
    }

    pub(crate) fn quality(&self, system: &System) -> Quality {
        match self {
            MethodSolver::Provot(_, limited) => Quality::Limiter(*limited),
            MethodSolver::Pbd(_) => Quality::Strain(system.strain_rms()),
            MethodSolver::Verlet(_) => Quality::Carried(carried_count(system)),
            MethodSolver::Xpbd(xpbd) => Quality::Residual(xpbd.residual_n(system)),
            MethodSolver::Implicit(_, solved) => Quality::Implicit(*solved),
            MethodSolver::Own(_) => Quality::Unknown,
        }
    }
}

impl Solver for MethodSolver {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        match self {
            MethodSolver::Provot(provot, limited) => {
                provot.advance(system, dt_s)?;
                limited.note(&provot.report());
                Ok(())
            }
            MethodSolver::Pbd(pbd) => pbd.advance(system, dt_s),
            MethodSolver::Verlet(verlet) => verlet.advance(system, dt_s),
            MethodSolver::Xpbd(xpbd) => xpbd.advance(system, dt_s),
            MethodSolver::Implicit(implicit, solved) => {
                implicit.advance(system, dt_s)?;
                implicit
                    .report()
                    .iter()
                    .for_each(|report| solved.note(report));
                Ok(())
            }
            MethodSolver::Own(solver) => solver.advance(system, dt_s),
        }
    }

    fn abilities(&self) -> Abilities {
        self.solver().abilities()
    }

    fn check(&self) -> Result<(), SettingError> {
        self.solver().check()
    }
}

/// A measure of how far the steps of a run's method fell short of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Quality {
    /// For Verlet: the number of vertices that are too light for the step, and so are carried by
    /// their neighbours at present.
    Carried(usize),
    /// The report of the limiter of Provot's method.
    Limiter(LimiterStats),
    /// For PBD: the root mean square of the present strains. PBD treats constraints as rigid, so
    /// all strain is an error that its sweeps left.
    Strain(f64),
    /// For XPBD: the largest difference, in newtons, between the force on a particle that the last
    /// substep used and the one that the springs have now
    /// ([`Xpbd::residual_n`](crate::Xpbd::residual_n)).
    Residual(f64),
    /// The report of an implicit method.
    Implicit(ImplicitStats),
    /// The solver is the caller's own, and reports nothing here.
    Unknown,
}

/// The report of Provot's limiter over all steps of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimiterStats {
    /// The number of passes over all constraints.
    pub passes: u64,
    /// The number of steps (or substeps) after which some edge was still longer than the limit.
    pub steps_short: u64,
    /// The number of steps (or substeps) in which further passes no longer helped, because held
    /// vertices are too far apart.
    pub steps_infeasible: u64,
    /// The largest excess of a stretch ratio over the limit after a step; 0 if the limit was always
    /// met.
    pub excess_max: f64,
    /// The number of steps (or substeps) in which some edge was longer than the limit and was
    /// shortened.
    pub steps_limited: u64,
}

/// The report of an implicit method over all steps of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImplicitStats {
    /// The number of matrices that proved to be indefinite, which happens to cloth under
    /// compression.
    pub indefinite: u64,
    /// The number of matrix terms that had a part dropped because the matrix was indefinite.
    pub clamped: u64,
    /// The largest residual of a step, as a bound on the rms error of the velocity in m/s.
    pub residual_max_m_per_s: f64,
}

impl LimiterStats {
    fn note(&mut self, report: &LimiterReport) {
        self.passes += u64::from(report.passes);
        self.steps_limited += u64::from(report.has_shortened);
        // Rounding leaves some 1e-14 of an edge that was shortened to the limit.
        self.steps_short += u64::from(report.excess > 1e-9);
        self.steps_infeasible += u64::from(report.is_infeasible);
        self.excess_max = self.excess_max.max(report.excess);
    }
}

impl ImplicitStats {
    fn note(&mut self, report: &StepReport) {
        self.indefinite += u64::from(report.indefinite);
        self.clamped += report.clamped;
        self.residual_max_m_per_s = self.residual_max_m_per_s.max(report.residual);
    }
}
