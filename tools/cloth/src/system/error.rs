//! Why particles, constraints or loads were refused.

use std::fmt;

use tearmesh::geometry::Point;

use crate::Constraint;

/// A setting, such as one of a method, a fabric or a load, with a value that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingError {
    /// The name of the setting.
    pub setting: &'static str,
    /// The value that was given; for a vector, its unusable component.
    pub given: f64,
    /// The values that are allowed, in words.
    pub allowed: &'static str,
}

impl SettingError {
    pub(crate) fn unless(
        holds: bool,
        setting: &'static str,
        given: f64,
        allowed: &'static str,
    ) -> Result<(), SettingError> {
        let error = SettingError {
            setting,
            given,
            allowed,
        };
        if holds { Ok(()) } else { Err(error) }
    }

    /// Refuses a number that is negative or not finite.
    pub(crate) fn unless_positive(setting: &'static str, given: f64) -> Result<(), SettingError> {
        let holds = given >= 0.0 && given.is_finite();
        SettingError::unless(holds, setting, given, "finite and at least 0")
    }

    /// Refuses a number that is not above 0, or not finite.
    pub(crate) fn unless_above_0(setting: &'static str, given: f64) -> Result<(), SettingError> {
        let holds = given > 0.0 && given.is_finite();
        SettingError::unless(holds, setting, given, "finite and above 0")
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (given, allowed) = (self.given, self.allowed);
        write!(f, "{} is {given}, and has to be {allowed}", self.setting)
    }
}

impl std::error::Error for SettingError {}

/// The reason why particles or constraints were refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SystemError {
    /// A mass is not positive and finite. The first such particle is named.
    Mass {
        /// The index of the particle with the unusable mass.
        particle: usize,
        /// The mass that was given, in kilograms.
        given: f64,
    },
    /// A coordinate is not finite or is too large. The first such particle is named.
    Position {
        /// The index of the particle with the unusable position.
        particle: usize,
        /// The position that was given, in metres.
        given: Point,
    },
    /// The rest length or the stiffness of a constraint is not positive and finite, or its ends are
    /// not two different particles.
    Constraint {
        /// The constraint as given.
        given: Constraint,
    },
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SystemError::Mass { particle, given } => write!(
                f,
                "particle {particle} has the mass {given} kg, which is not positive and finite"
            ),
            SystemError::Position { particle, given } => write!(
                f,
                "particle {particle} is at ({}, {}, {}), which is not usable",
                given.x, given.y, given.z
            ),
            SystemError::Constraint { given } => {
                let [a, b] = given.ends;
                write!(
                    f,
                    "a constraint between the particles {a} and {b} cannot have the rest length \
                     {} m and the stiffness {} N/m",
                    given.rest_length_m, given.stiffness_n_per_m
                )
            }
        }
    }
}

impl std::error::Error for SystemError {}
