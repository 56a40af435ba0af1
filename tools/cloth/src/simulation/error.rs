//! Why a simulation, or an input to one, was refused.

use std::error::Error;
use std::fmt;

use tearmesh::{MassError, PositionError, VertexId};

use super::event::CutId;
use super::hand::HandId;
use crate::sheet::ClothError;
use crate::solver::StepError;
use crate::system::SystemError;
use crate::tearing::TearingError;

/// The reason why a simulation was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulationError {
    /// The density gives no usable masses.
    Mass(MassError),
    /// The mesh or the fabric makes no cloth.
    Cloth(ClothError),
    /// A load cannot be used.
    Loads(SystemError),
    /// The rules for tearing, or the strengths of vertices, cannot be used.
    Tearing(TearingError),
    /// The step is not a positive finite number of seconds.
    Step {
        /// The step that was given, in seconds.
        given_s: f64,
    },
    /// The number of texture coordinates differs from the number of corners.
    Texture {
        /// The number of corners, three per face.
        corners: usize,
        /// The number of texture coordinates that were given.
        given: usize,
    },
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SimulationError::Mass(error) => error.fmt(f),
            SimulationError::Cloth(error) => error.fmt(f),
            SimulationError::Loads(error) => error.fmt(f),
            SimulationError::Tearing(error) => error.fmt(f),
            SimulationError::Step { given_s } => {
                write!(f, "a step of {given_s} s is not positive and finite")
            }
            SimulationError::Texture { corners, given } => {
                write!(
                    f,
                    "there are {given} texture coordinates for {corners} corners"
                )
            }
        }
    }
}

impl Error for SimulationError {}

/// The reason why a simulation refused an input. A refused input changes nothing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// The mesh has no such vertex, or no longer: a merge may have taken it away.
    NoVertex {
        /// The vertex that was given.
        vertex: VertexId,
        /// The number of vertices.
        vertices: usize,
    },
    /// The vertex is held already, and cannot be grabbed.
    Held {
        /// The vertex that was given.
        vertex: VertexId,
    },
    /// The vertex is not held, and cannot be freed.
    Free {
        /// The vertex that was given.
        vertex: VertexId,
    },
    /// A hand has the vertex, which is therefore neither held, freed nor grabbed.
    InHand {
        /// The vertex that was given.
        vertex: VertexId,
        /// The hand that has it.
        hand: HandId,
    },
    /// There is no such hand, or no longer.
    NoHand {
        /// The hand that was given.
        hand: HandId,
    },
    /// There was no such cut.
    NoCut {
        /// The cut that was given.
        cut: CutId,
    },
    /// A number is not finite, is too large, or is a negative radius.
    Number {
        /// The name of the number.
        name: &'static str,
        /// The number that was given.
        given: f64,
    },
    /// The scissor continues another cut, which a simulation does not support.
    Continued,
    /// The cloth has moved to where it cannot be cut.
    Positions(PositionError),
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InputError::NoVertex { vertex, vertices } => {
                write!(f, "there is no {vertex} among {vertices} vertices")
            }
            InputError::Held { vertex } => write!(f, "{vertex} is held, and was not grabbed"),
            InputError::Free { vertex } => write!(f, "{vertex} is not held, and was not freed"),
            InputError::InHand { vertex, hand } => write!(f, "{vertex} is in {hand}"),
            InputError::NoHand { hand } => write!(f, "{hand} does not hold anything"),
            InputError::NoCut { cut } => write!(f, "{cut} was not made"),
            InputError::Number { name, given } => write!(f, "{name} cannot be {given}"),
            InputError::Continued => f.write_str("a scissor that continues a cut was refused"),
            InputError::Positions(error) => error.fmt(f),
        }
    }
}

impl Error for InputError {}

/// The reason why a log could not be replayed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReplayError {
    /// The definition was refused.
    Definition(SimulationError),
    /// The log is that of another mesh or another definition.
    Digest {
        /// The digest of the mesh and the definition that were given.
        own: u64,
        /// The digest in the log.
        logged: u64,
    },
    /// An input of the log was refused, or is none.
    Input {
        /// The number of the input, from 0.
        number: usize,
        /// The reason; `None` if its numbers are not those of its verb, or a step that failed did
        /// not fail.
        error: Option<InputError>,
    },
    /// A step failed that had not.
    Step(StepError),
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReplayError::Definition(error) => error.fmt(f),
            ReplayError::Digest { own, logged } => write!(
                f,
                "the log is of {logged:016x}, and this mesh with its definition is {own:016x}"
            ),
            ReplayError::Input { number, error } => {
                write!(f, "input {number} of the log was refused")?;
                error.iter().try_for_each(|error| write!(f, ": {error}"))
            }
            ReplayError::Step(error) => error.fmt(f),
        }
    }
}

impl Error for ReplayError {}
