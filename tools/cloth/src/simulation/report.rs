//! The reports of a simulation: events, how far it got, and the place that a pointer is on.

use tearmesh::engine::RayHit;
use tearmesh::{HalfEdgeId, VertexId};

/// The id of a cut that a [`Simulation`](super::Simulation) made. Cuts are numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CutId(pub(super) u32);

/// Something that happened to the cloth of a [`Simulation`](super::Simulation). Ids of vertices are
/// those of the time of the event: a later merge may give them to others.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// An edge was overstretched, and a vertex at one of its ends was split.
    Tore {
        /// The overstretched edge, as one of its half-edges. The edges that came apart are others
        /// as a rule: the cloth tears across the pull.
        edge: HalfEdgeId,
        /// The vertex that was split.
        vertex: VertexId,
        /// The simulated time at the end of the step, in seconds.
        time_s: f64,
        /// The tension of the edge before the split, by the method, in newtons; `None` for a fabric of triangles
        /// alone, whose edges have none.
        force_n: Option<f64>,
    },
    /// The cloth was cut.
    Cut {
        /// The cut.
        cut: CutId,
        /// The number of vertices that were split; 0 if the scissor met nothing.
        splits: usize,
        /// The simulated time, in seconds.
        time_s: f64,
    },
    /// Healing came to its end.
    Healed {
        /// The number of pairs of copies that were sewn together.
        sewn: usize,
        /// The number of pairs that a load, a hold or a body kept apart, or at which a step failed.
        left: usize,
        /// The number of pairs that were let go, unpicked, or torn or cut away.
        ended: usize,
        /// The simulated time, in seconds.
        time_s: f64,
    },
}

/// What became of the pairs of copies that were drawn together: see [`Run::pairs`](crate::scene::Run::pairs).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairTally {
    /// The number of pairs that were ever open.
    pub opened: usize,
    /// The number of pairs that were sewn together, unpicked since or not.
    pub sewn: usize,
    /// The number of pairs that a load, a hold or a body kept apart, or at which a step failed.
    pub left: usize,
    /// The number of pairs that were unpicked, sewn or not, or cut away.
    pub unpicked: usize,
    /// The number of pairs that are still drawn together.
    pub open: usize,
}

/// The vertex that a pointer is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// The corner of the face that is nearest to the point, by its weight.
    pub vertex: VertexId,
    /// The face, and the point in it.
    pub hit: RayHit,
}

/// How far a simulation got: the result of [`Simulation::advance`](super::Simulation::advance).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The number of steps that were taken.
    pub steps: u64,
    /// The time in seconds that the budget of steps left out. It is not made up for later.
    pub dropped_s: f64,
}
