//! What a solver did.

/// What was done, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How often all forces were computed.
    pub force_evaluations: u64,
    /// How often all second derivatives were.
    pub hessian_evaluations: u64,
    /// How often the energy was, for line searches.
    pub energy_evaluations: u64,
    /// Products of the matrix and a vector.
    pub matrix_products: u64,
    /// Iterations of conjugate gradients.
    pub solver_iterations: u64,
}

impl Work {
    /// What was done since `before`.
    #[must_use]
    pub fn since(&self, before: &Work) -> Work {
        Work {
            force_evaluations: self.force_evaluations - before.force_evaluations,
            hessian_evaluations: self.hessian_evaluations - before.hessian_evaluations,
            energy_evaluations: self.energy_evaluations - before.energy_evaluations,
            matrix_products: self.matrix_products - before.matrix_products,
            solver_iterations: self.solver_iterations - before.solver_iterations,
        }
    }
}
