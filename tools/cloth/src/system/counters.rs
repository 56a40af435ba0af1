//! What a simulation costs, without a clock.

/// What was computed since the system was made: the cost of a simulation, without a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Evaluations of all forces.
    pub force_evaluations: u64,
    /// Products of the stiffness matrix with a vector.
    pub matrix_products: u64,
    /// Sums over all triangles: of forces, of products with the stiffness matrix, of energy for
    /// line searches, and of stretch for the bound of frequencies.
    pub triangle_evaluations: u64,
    /// Sums of wind over all faces.
    pub wind_evaluations: u64,
    /// Sums of areas over all faces, for the rate at which wind slows the system.
    pub area_evaluations: u64,
    /// Tests of all particles against one collider.
    pub collider_passes: u64,
    /// Substeps.
    pub substeps: u64,
    /// Linearised implicit steps that overshot, and were taken with Newton's method instead.
    pub overshoots: u64,
    /// Visits of single constraints by what they were for.
    pub visits: Visits,
    /// Visits of single elements by which feature of the model they belong to.
    pub features: FeatureVisits,
}

/// Visits of single constraints, springs, bends and triangles alike, by what they were for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// To project them, or to shorten them.
    pub project: u64,
    /// For forces, for products with the stiffness matrix and its entries, for the energy that an
    /// implicit step searches along a line by, and to see that nothing has blown up.
    pub force: u64,
    /// To find those that are about to tear. What is found on the way, while forces are summed up, is
    /// no visit of its own.
    pub detect: u64,
    /// To tell the largest stretch, and energy.
    pub meter: u64,
}

/// Visits of single elements by which feature of the model they belong to: what a scene pays for each
/// feature, without a clock. Those of constraints are the sum of [`Visits::project`] and
/// [`Visits::force`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FeatureVisits {
    /// Of springs along edges.
    pub stretch: u64,
    /// Of springs and arcs across edges.
    pub bend: u64,
    /// Of triangles with a modulus.
    pub triangle: u64,
    /// Of faces, by wind.
    pub wind: u64,
    /// Of particles, by colliders.
    pub collider: u64,
}
