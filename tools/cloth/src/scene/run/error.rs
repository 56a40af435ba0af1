//! Why a scene is refused.

use std::fmt;

use tearmesh::{ScissorError, VertexId};

use crate::simulation::error::SimulationError;
use crate::system::error::SettingError;

/// The reason why a scene was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RunError {
    /// The mesh makes no cloth of this fabric, or a number of a load, of the rule for tearing or of
    /// a strength cannot be used.
    Simulation(SimulationError),
    /// The step is not positive and finite, the duration is negative or not finite, or the run
    /// would need more than 2⁴⁰ steps.
    Times {
        /// The step, in seconds.
        step_s: f64,
        /// The duration of the scene, in seconds.
        duration_s: f64,
    },
    /// The wind is not usable at all times: its velocity with the sway is not finite, or its period
    /// is not positive and finite, or is too short.
    Wind(SettingError),
    /// The region of a hold or a strength contains no vertex.
    NoVertices {
        /// The part of the scene that has the region: `hold` or `strength`.
        named_by: &'static str,
        /// The index of that hold or strength in the scene, from 0.
        number: usize,
    },
    /// A hold or a strength names a vertex that the mesh does not have.
    NoVertex {
        /// The part of the scene that names the vertex: `hold` or `strength`.
        named_by: &'static str,
        /// The index of that hold or strength in the scene, from 0.
        number: usize,
        /// The first vertex that the mesh does not have.
        vertex: VertexId,
        /// The number of vertices of the mesh.
        vertices: usize,
    },
    /// The times of a hold are negative, not finite or not ascending, or an offset of its path is
    /// unusable.
    Moves {
        /// The index of the hold in the scene, from 0.
        number: usize,
    },
    /// A seam is unpicked at a time that is negative or not finite, or has another name.
    Unpick {
        /// The index of the entry, from 0.
        number: usize,
    },
    /// The rays of a cut span no plane.
    Cut {
        /// The index of the cut in the scene, from 0.
        number: usize,
        /// The reason why the rays span no plane.
        error: ScissorError,
    },
    /// The time of a cut is negative, not finite, or earlier than that of the cut before it.
    CutTime {
        /// The index of the cut in the scene, from 0.
        number: usize,
        /// The time that was given, in seconds.
        given_s: f64,
    },
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::Simulation(error) => error.fmt(f),
            RunError::Times { step_s, duration_s } => {
                write!(f, "{duration_s} s cannot be taken in steps of {step_s} s")
            }
            RunError::Wind(error) => error.fmt(f),
            RunError::NoVertices { named_by, number } => {
                let verb = match *named_by {
                    "hold" => "holds",
                    _ => "contains",
                };
                write!(f, "{named_by} {} {verb} no vertex", number + 1)
            }
            RunError::NoVertex {
                named_by,
                number,
                vertex,
                vertices,
            } => write!(
                f,
                "{named_by} {} names {vertex}, and the mesh has {vertices} vertices",
                number + 1
            ),
            RunError::Moves { number } => {
                write!(f, "the times of hold {} do not ascend", number + 1)
            }
            RunError::Unpick { number } => write!(
                f,
                "unpick {} has no time that is finite and at least 0, or no seam of its name",
                number + 1
            ),
            RunError::Cut { number, error } => write!(f, "cut {}: {error}", number + 1),
            RunError::CutTime { number, given_s } => write!(
                f,
                "cut {} is at {given_s} s, which is not finite, negative, or before the cut before it",
                number + 1
            ),
        }
    }
}

impl std::error::Error for RunError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            RunError::Simulation(error) => Some(error),
            RunError::Wind(error) => Some(error),
            RunError::Cut { error, .. } => Some(error),
            _ => None,
        }
    }
}
