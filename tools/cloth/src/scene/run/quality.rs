//! What the method of a run says of its own steps.

use crate::implicit::StepReport;
use crate::provot::LimiterReport;

/// What the method of a run says of its own steps: where they fell short of the model, and by how
/// much.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Quality {
    /// The guards of velocity Verlet.
    Guards(GuardStats),
    /// Provot's limiter.
    Limiter(LimiterStats),
    /// PBD: constraints are rigid to it, so all strain is what its sweeps have left. The root mean
    /// square now.
    Strain(f64),
    /// XPBD: the largest difference, in newtons, between the force on a particle that the last
    /// substep used and the one that the springs have now
    /// ([`Xpbd::residual_n`](crate::Xpbd::residual_n)).
    Residual(f64),
    /// An implicit method.
    Newton(NewtonStats),
}

/// What the guards of velocity Verlet did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuardStats {
    /// The vertices that are carried by their neighbours now, as they are too light for the step.
    pub carried: usize,
    /// The energy that damping took from what was crushed in all steps, in joules.
    pub damped_j: f64,
}

/// What Provot's limiter did in all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimiterStats {
    /// The passes over all constraints.
    pub passes: u64,
    /// The steps (or substeps) after which some edge was still longer than the limit.
    pub steps_short: u64,
    /// Of these, the ones in which passes had stopped helping: what is held is too far apart.
    pub steps_infeasible: u64,
    /// What the largest stretch ratio had above the limit, at most.
    pub excess_max: f64,
    /// The steps (or substeps) in which some edge was longer than the limit, and was shortened.
    pub steps_limited: u64,
}

/// What the implicit method did in all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NewtonStats {
    /// Newton's iterations; one a step if linearised.
    pub newton_iterations: u64,
    /// Halvings of the line search.
    pub halvings: u64,
    /// Matrices that showed that they are indefinite: cloth under compression.
    pub indefinite: u64,
    /// Terms of matrices that had a part dropped for it.
    pub clamped: u64,
    /// The largest residual of a step, as a bound on the rms error of the velocity in m/s.
    pub residual_max_m_per_s: f64,
    /// The steps (or substeps) that were taken with a residual above what the tolerance allows:
    /// linearised ones that overshot, and from which Newton's method did not come down all the way.
    pub unsolved: u64,
    /// The largest residual of a step as a multiple of what the tolerance allowed in that.
    pub excess_max: f64,
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

impl NewtonStats {
    pub(super) fn note(&mut self, report: &StepReport) {
        self.newton_iterations += u64::from(report.newton_iterations);
        self.halvings += u64::from(report.halvings);
        self.indefinite += u64::from(report.indefinite);
        self.clamped += report.clamped;
        self.residual_max_m_per_s = self.residual_max_m_per_s.max(report.residual);
        if report.residual > report.limit {
            self.unsolved += 1;
        }
        if report.residual > 0.0 {
            self.excess_max = self.excess_max.max(report.residual / report.limit);
        }
    }
}
