//! What can be asked of a run.

use serde::{Deserialize, Serialize};

/// The observables of a run, by which errors are measured. Errors are relative to the reference. Of
/// positions and strains the largest error of all checkpoints counts. An edge is *loaded* if it bears more
/// than 0.3 of the largest strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Observable {
    /// The mass-weighted L2 norm of the position errors, divided by that of the displacements from the start.
    Displacement,
    /// The rms over all loaded edges of the relative error of their strain by length.
    StrainRms,
    /// The 99th percentile over all loaded edges of the relative error of their strain by length.
    Strain99,
    /// The relative error of the largest strain by length of any edge.
    StrainLargest,
    /// The rms over all loaded edges of the relative error of their strain by force, f/(kL).
    ForceRms,
    /// The 99th percentile over all loaded edges of the relative error of their strain by force, f/(kL).
    Force99,
    /// The relative error of the largest strain by force, f/(kL), of any edge.
    ForceLargest,
    /// The force at the held particles, as a mean over the scene; in a scene that ends at rest, at its end.
    ReactionMean,
    /// The largest mean over 1/60 s of the force at the held particles.
    ReactionLargest,
    /// The time at which an edge first reaches [`TEAR_RATIO`](super::TEAR_RATIO).
    TearTime,
    /// The force at the clamps at [`TearTime`](Observable::TearTime), as a mean over the last 1/60 s.
    TearForce,
    /// The time at which an edge first reaches [`TOUGHNESS_J_PER_M`](super::TOUGHNESS_J_PER_M).
    ToughTime,
    /// The force at the clamps at [`ToughTime`](Observable::ToughTime), as a mean over the last 1/60 s.
    ToughForce,
    /// The rate at which the slowest mode decays, in 1/s.
    Decay,
    /// The frequency of the slowest mode, in rad/s.
    Frequency,
    /// The largest unexplained gain of energy, divided by the energy put in. The true value is 0.
    EnergyMade,
    /// The largest unexplained loss of energy, divided by the energy put in. The true value is 0.
    EnergyLost,
}

/// What charts and tables in words are of; CSV and JSON have all.
pub(super) const TOLD: [Observable; 9] = [
    Observable::Displacement,
    Observable::StrainRms,
    Observable::ReactionLargest,
    Observable::Decay,
    Observable::EnergyMade,
    Observable::EnergyLost,
    Observable::TearTime,
    Observable::TearForce,
    Observable::ToughForce,
];

/// What several observables are read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Raw {
    Positions,
    Strains,
    Forces,
    Reaction,
    Tears,
    Mode,
    Energy,
}

/// How many there are.
pub(super) const RAWS: usize = 7;

impl Observable {
    /// Returns the name of the observable in tables and captions.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Observable::Displacement => "displacement",
            Observable::StrainRms => "strain-rms",
            Observable::Strain99 => "strain-99",
            Observable::StrainLargest => "strain-largest",
            Observable::ForceRms => "edge-force-rms",
            Observable::Force99 => "edge-force-99",
            Observable::ForceLargest => "edge-force-largest",
            Observable::ReactionMean => "reaction-mean",
            Observable::ReactionLargest => "reaction-largest",
            Observable::TearTime => "tear-time",
            Observable::TearForce => "tear-force",
            Observable::ToughTime => "toughness-time",
            Observable::ToughForce => "toughness-force",
            Observable::Decay => "decay-rate",
            Observable::Frequency => "frequency",
            Observable::EnergyMade => "energy-made",
            Observable::EnergyLost => "energy-lost",
        }
    }

    /// Returns whether the true value is zero, so that no reference is needed.
    #[must_use]
    pub fn is_energy(self) -> bool {
        matches!(self, Observable::EnergyMade | Observable::EnergyLost)
    }

    /// What it is read from, and the place in it of what is a number.
    pub(super) fn raw(self) -> (Raw, usize) {
        match self {
            Observable::Displacement => (Raw::Positions, 0),
            Observable::StrainRms | Observable::Strain99 | Observable::StrainLargest => {
                (Raw::Strains, 0)
            }
            Observable::ForceRms | Observable::Force99 | Observable::ForceLargest => {
                (Raw::Forces, 0)
            }
            Observable::ReactionMean => (Raw::Reaction, 0),
            Observable::ReactionLargest => (Raw::Reaction, 1),
            Observable::TearTime => (Raw::Tears, 0),
            Observable::TearForce => (Raw::Tears, 1),
            Observable::ToughTime => (Raw::Tears, 2),
            Observable::ToughForce => (Raw::Tears, 3),
            Observable::Decay => (Raw::Mode, 0),
            Observable::Frequency => (Raw::Mode, 1),
            Observable::EnergyMade => (Raw::Energy, 0),
            Observable::EnergyLost => (Raw::Energy, 1),
        }
    }
}
