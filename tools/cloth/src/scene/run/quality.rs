//! What the method of a run reports about its own steps.

use crate::implicit::StepReport;
use crate::provot::LimiterReport;

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
    pub(super) fn note(&mut self, report: &LimiterReport) {
        self.passes += u64::from(report.passes);
        self.steps_limited += u64::from(report.has_shortened);
        // Rounding leaves some 1e-14 of an edge that was shortened to the limit.
        self.steps_short += u64::from(report.excess > 1e-9);
        self.steps_infeasible += u64::from(report.is_infeasible);
        self.excess_max = self.excess_max.max(report.excess);
    }
}

impl ImplicitStats {
    pub(super) fn note(&mut self, report: &StepReport) {
        self.indefinite += u64::from(report.indefinite);
        self.clamped += report.clamped;
        self.residual_max_m_per_s = self.residual_max_m_per_s.max(report.residual);
    }
}
