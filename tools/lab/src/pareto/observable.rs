//! Observables: the quantities by which runs are compared.

use serde::{Deserialize, Serialize};

/// The observables of a run, by which errors are measured. Errors are relative to the reference. For
/// positions and strains the largest error of all checkpoints counts. An edge is *loaded* if it bears more
/// than 0.3 of the largest strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Observable {
    /// The mass-weighted L2 norm of the position errors, divided by that of the displacements from the start.
    Displacement,
    /// The rms over all loaded edges of the relative error of their strain by length.
    StrainRms,
    /// The relative error of the largest strain by length of any edge.
    StrainLargest,
    /// The rms over all loaded edges of the relative error of their strain by force, f/(kL).
    EdgeForceRms,
    /// The largest mean over 1/60 s of the force at the held particles; in a scene that ends at rest, the force
    /// at its end.
    ReactionLargest,
    /// The time at which an edge first reaches [`TEAR_RATIO`](super::TEAR_RATIO).
    TearTime,
    /// The force at the clamps at [`TearTime`](Observable::TearTime), as a mean over the last 1/60 s.
    TearForce,
    /// The time at which an edge first reaches [`TOUGHNESS_J_PER_M`](super::TOUGHNESS_J_PER_M).
    ToughnessTime,
    /// The force at the clamps at [`ToughnessTime`](Observable::ToughnessTime), as a mean over the last 1/60 s.
    ToughnessForce,
    /// The largest unexplained gain of energy, divided by the energy put in. The true value is 0.
    EnergyMade,
    /// The largest unexplained loss of energy, divided by the energy put in. The true value is 0.
    EnergyLost,
}

/// The records that observables are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Record {
    Positions,
    Strains,
    Forces,
    Reaction,
    Tears,
    Energy,
}

/// The number of kinds of records.
pub(super) const RECORDS: usize = 6;

impl Observable {
    /// The observables that have panels and lines of a summary. Tables have all.
    pub const DRAWN: [Observable; 8] = [
        Observable::Displacement,
        Observable::StrainRms,
        Observable::ReactionLargest,
        Observable::EnergyMade,
        Observable::EnergyLost,
        Observable::TearTime,
        Observable::TearForce,
        Observable::ToughnessForce,
    ];

    /// Returns the name of the observable in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Observable::Displacement => "displacement",
            Observable::StrainRms => "strain of edges (rms)",
            Observable::StrainLargest => "largest strain",
            Observable::EdgeForceRms => "force of edges (rms)",
            Observable::ReactionLargest => "force at the holds",
            Observable::TearTime => "time of first tear",
            Observable::TearForce => "force at first tear",
            Observable::ToughnessTime => "time of first tear by toughness",
            Observable::ToughnessForce => "force at first tear by toughness",
            Observable::EnergyMade => "energy made",
            Observable::EnergyLost => "energy lost",
        }
    }

    /// Returns whether the true value is zero, so that no reference is needed.
    #[must_use]
    pub fn is_energy(self) -> bool {
        matches!(self, Observable::EnergyMade | Observable::EnergyLost)
    }

    /// The record that the observable is read from, and the index in it of one that is a single number.
    pub(super) fn record(self) -> (Record, usize) {
        match self {
            Observable::Displacement => (Record::Positions, 0),
            Observable::StrainRms | Observable::StrainLargest => (Record::Strains, 0),
            Observable::EdgeForceRms => (Record::Forces, 0),
            Observable::ReactionLargest => (Record::Reaction, 0),
            Observable::TearTime => (Record::Tears, 0),
            Observable::TearForce => (Record::Tears, 1),
            Observable::ToughnessTime => (Record::Tears, 2),
            Observable::ToughnessForce => (Record::Tears, 3),
            Observable::EnergyMade => (Record::Energy, 0),
            Observable::EnergyLost => (Record::Energy, 1),
        }
    }
}
