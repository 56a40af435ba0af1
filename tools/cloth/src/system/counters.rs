//! The cost of a simulation, counted without a clock.

/// Counts of the work done since the system was created. They measure the cost of a simulation
/// without a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Counters {
    /// The number of evaluations of all forces.
    pub force_evaluations: u64,
    /// The number of products of the stiffness matrix with a vector.
    pub matrix_products: u64,
    /// The number of sums of wind over all faces.
    pub wind_evaluations: u64,
    /// The number of passes of all particles over one collider.
    pub collider_passes: u64,
    /// The number of substeps taken.
    pub substeps: u64,
    /// The number of implicit steps that overshot and were divided.
    pub overshoots: u64,
    /// Counts of visits to single constraints, by purpose.
    pub visits: Visits,
    /// Counts of visits to single elements, by the feature of the model that they belong to.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub features: FeatureVisits,
}

/// Counts of visits to single constraints (springs, bends and triangles alike), by purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Visits {
    /// The number of visits to project or shorten a constraint.
    pub project: u64,
    /// The number of visits for forces, for the stiffness matrix and products with it, and for the
    /// check for blow-up.
    pub force: u64,
    /// The number of visits to find constraints that are about to tear.
    pub detect: u64,
}

/// Counts of visits to single elements, by the feature of the model to which they belong. They
/// measure the cost of each feature of a scene without a clock. Visits to constraints add up to
/// [`Visits::project`] and [`Visits::force`] together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FeatureVisits {
    /// The number of visits to springs along edges.
    pub stretch: u64,
    /// The number of visits to springs and arcs across edges.
    pub bend: u64,
    /// The number of visits to triangles with a modulus.
    pub triangle: u64,
    /// The number of visits to faces, for the force of wind and for the rate at which air slows the
    /// system.
    pub wind: u64,
    /// The number of visits to particles, one for each plane or ball against which a particle is tested, and
    /// of looks of particles and faces at a body.
    pub collider: u64,
}
