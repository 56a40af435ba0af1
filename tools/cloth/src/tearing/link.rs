//! Links without a mesh: chains and nets whose constraints go when they are overloaded.

use super::{Tearing, TearingError};
use crate::constraint::{Constraint, ConstraintId};
use crate::system::{Family, System};

/// A link that was cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutLink {
    /// Its id, which another constraint may get.
    pub id: ConstraintId,
    /// The constraint as it was.
    pub constraint: Constraint,
    /// Its load: at least 1.
    pub load: f64,
    /// The elastic energy that went with it, in joules.
    pub energy_j: f64,
}

impl Tearing {
    /// Cuts the links of a system without a mesh whose load has reached the threshold, the worst
    /// first, ids breaking ties, up to the cap. Weakening, delay and holds need a mesh and play no
    /// part here.
    ///
    /// # Errors
    ///
    /// Those of [`Tearing::check`], and nothing is cut.
    ///
    /// # Panics
    ///
    /// If the system is that of a cloth.
    pub fn cut_links(&self, system: &mut System) -> Result<Vec<CutLink>, TearingError> {
        self.check()?;
        let load = |id| Some((self.threshold.load(system, id)?, id));
        let loads = system.stretches().iter().filter_map(load);
        let mut torn: Vec<_> = loads.filter(|&(load, _)| load >= 1.0).collect();
        torn.sort_unstable_by(|(one, a), (other, b)| other.total_cmp(one).then(a.cmp(b)));
        torn.truncate(self.splits_per_step_max.unwrap_or(usize::MAX));
        let cut = |(load, id)| {
            let constraint = system.cut(id);
            let energy_j = system.elastic_of(Family::Stretch, &constraint);
            CutLink {
                id,
                constraint,
                load,
                energy_j,
            }
        };
        Ok(torn.into_iter().map(cut).collect())
    }
}
