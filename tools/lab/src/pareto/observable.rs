//! What can be asked of a run.

use serde::Serialize;

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Observable {
    /// Displacements, relative L2 by mass, the largest of the checkpoints.
    Displacement,
    /// Strains by lengths of the edges that bear more than .3 of the largest: the rms of what each is
    /// off by, as a part of its own; as in all strains the largest of the checkpoints.
    StrainRms,
    /// The 99th percentile of the same.
    Strain99,
    /// The largest strain by lengths.
    StrainLargest,
    /// Strains by the forces of the method, f/kL: the rms.
    ForceRms,
    /// The 99th percentile of the same.
    Force99,
    /// The largest strain by forces.
    ForceLargest,
    /// The force of those who hold, as a mean over the scene.
    ReactionMean,
    /// The largest of its means over 1/60 s.
    ReactionLargest,
    /// When an edge first reaches the stretch ratio.
    TearTime,
    /// The force of the clamps then, as a mean over the last 1/60 s.
    TearForce,
    /// When an edge first reaches the toughness.
    ToughTime,
    /// The force of the clamps then.
    ToughForce,
    /// The rate at which the slowest mode decays.
    Decay,
    /// Its frequency.
    Frequency,
    /// The most energy that was made, over what was put in.
    EnergyMade,
    /// The most that was lost, over the same.
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
    /// As it stands in tables and captions.
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

    /// Whether the truth is zero, so that no reference is asked.
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
