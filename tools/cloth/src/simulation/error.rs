//! Why a simulation, an input to one, or the replay of its log was refused.

use std::error::Error;
use std::fmt;

use tearmesh::{CutError, PositionError, VertexId};

use super::hand::HandId;
use super::report::CutId;
use crate::cloth::ClothError;
use crate::cloth::seam::SeamError;
use crate::cloth::tearing::TearingError;
use crate::method::solver::StepError;
use crate::system::error::SettingError;

/// The reason why a simulation was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulationError {
    /// The mesh, the density or the fabric makes no cloth.
    Cloth(ClothError),
    /// The seams cannot be sewn.
    Seams(SeamError),
    /// A load cannot be used.
    Loads(SettingError),
    /// The rules for tearing, or the strengths of vertices, cannot be used.
    Tearing(TearingError),
    /// The number of places at rest is not that of corners.
    Rest {
        /// The number of places.
        given: usize,
        /// The number of corners.
        corners: usize,
    },
    /// The number of texture coordinates is not that of corners.
    Texture {
        /// The number of texture coordinates.
        given: usize,
        /// The number of corners.
        corners: usize,
    },
    /// The step, in seconds, is not positive and finite.
    Step(f64),
    /// The amplitude of the ripple, in metres, is negative, not finite or too large.
    Ripple(f64),
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SimulationError::Cloth(error) => error.fmt(f),
            SimulationError::Seams(error) => error.fmt(f),
            SimulationError::Loads(error) => error.fmt(f),
            SimulationError::Tearing(error) => error.fmt(f),
            SimulationError::Rest { given, corners } => {
                write!(f, "there are {given} places at rest for {corners} corners")
            }
            SimulationError::Texture { given, corners } => {
                write!(
                    f,
                    "there are {given} texture coordinates for {corners} corners"
                )
            }
            SimulationError::Step(s) => write!(f, "a step of {s} s is not positive and finite"),
            SimulationError::Ripple(m) => {
                write!(f, "a ripple of {m} m is negative, not finite or too large")
            }
        }
    }
}

impl Error for SimulationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            SimulationError::Cloth(error) => Some(error),
            SimulationError::Seams(error) => Some(error),
            SimulationError::Loads(error) => Some(error),
            SimulationError::Tearing(error) => Some(error),
            _ => None,
        }
    }
}

/// The reason why a simulation refused an input. A refused input changes nothing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// The mesh has no such vertex, or no longer: a merge may have taken it away.
    NoVertex(VertexId),
    /// The vertex is held already, and cannot be grabbed.
    Held(VertexId),
    /// A hand has the vertex, which therefore is neither held, freed nor grabbed.
    InHand(VertexId, HandId),
    /// There is no such hand, or no longer.
    NoHand(HandId),
    /// There was no such cut.
    NoCut(CutId),
    /// There is no seam of this name, or of this number.
    NoSeam(String),
    /// A number of this name is not finite, is too large, or is a negative radius.
    Number(&'static str, f64),
    /// The scissor continues another cut, which a simulation does not support.
    Continued,
    /// The cloth has moved to where it cannot be cut.
    Positions(PositionError),
    /// The cut is refused: its rays cross, and the cloth is on both sides of the crossing.
    Cut(CutError),
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InputError::NoVertex(v) => write!(f, "the mesh has no vertex {v}"),
            InputError::Held(v) => write!(f, "{v} is held, and cannot be grabbed"),
            InputError::InHand(v, hand) => write!(f, "{v} is in hand {}", hand.0),
            InputError::NoHand(hand) => write!(f, "hand {} does not hold anything", hand.0),
            InputError::NoCut(cut) => write!(f, "cut {} was not made", cut.0),
            InputError::NoSeam(seam) => write!(f, "there is no seam `{seam}`"),
            InputError::Number(name, given) => write!(f, "{name} cannot be {given}"),
            InputError::Continued => f.write_str("the scissor continues another cut"),
            InputError::Positions(error) => error.fmt(f),
            InputError::Cut(error) => error.fmt(f),
        }
    }
}

impl Error for InputError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            InputError::Positions(error) => Some(error),
            InputError::Cut(error) => Some(error),
            _ => None,
        }
    }
}

/// The reason why a log could not be replayed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReplayError {
    /// The definition was refused.
    Definition(SimulationError),
    /// The log is that of another mesh or another definition.
    Digest,
    /// The input of this number, from 0, was refused, or its numbers are not those of its verb.
    Input(usize, Option<InputError>),
    /// A step failed that had not, or the other way round: the log is from another version.
    Step(Option<StepError>),
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReplayError::Definition(error) => error.fmt(f),
            ReplayError::Digest => f.write_str("the log is of another mesh or definition"),
            ReplayError::Input(number, Some(error)) => write!(f, "input {number}: {error}"),
            ReplayError::Input(number, None) => write!(f, "input {number} is not one"),
            ReplayError::Step(Some(error)) => write!(f, "a step failed that had not: {error}"),
            ReplayError::Step(None) => f.write_str("a step did not fail that had"),
        }
    }
}

impl Error for ReplayError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            ReplayError::Definition(error) => Some(error),
            ReplayError::Input(_, Some(error)) => Some(error),
            ReplayError::Step(Some(error)) => Some(error),
            _ => None,
        }
    }
}
