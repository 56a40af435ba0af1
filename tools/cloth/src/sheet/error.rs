//! Why a cloth was refused.

use std::fmt;

use tearmesh::geometry::Vector;
use tearmesh::{FaceId, MassError, VertexId};

/// The reason why a cloth was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClothError {
    /// The masses were refused.
    Mass(MassError),
    /// A stiffness is not a positive finite number, or the stiffness of a bend constraint would not
    /// be one.
    Stiffness {
        /// The name of the field of [`Fabric`](crate::Fabric).
        field: &'static str,
        /// The value that was given.
        given: f64,
    },
    /// The time of damping is negative or not finite.
    Damping {
        /// The time that was given, in seconds.
        given: f64,
    },
    /// Two vertices that a constraint joins are at the same place, or have coordinates that are not
    /// finite.
    Length {
        /// The two vertices.
        ends: [VertexId; 2],
        /// The rest length between them, in metres.
        given: f64,
    },
    /// A face of a cloth with a [`Weave`](crate::Weave) has no area at rest, or the direction of
    /// warp is perpendicular to it.
    Face {
        /// The face that cannot be used.
        face: FaceId,
        /// The direction of warp that was given, in space.
        warp: Vector,
    },
    /// The number of positions or masses differs from the number of vertices.
    Counts {
        /// The number of vertices.
        vertices: usize,
        /// The number of positions.
        positions: usize,
        /// The number of masses.
        masses: usize,
    },
}

impl From<MassError> for ClothError {
    fn from(error: MassError) -> ClothError {
        ClothError::Mass(error)
    }
}

impl fmt::Display for ClothError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClothError::Mass(error) => error.fmt(f),
            ClothError::Stiffness { field, given } => write!(
                f,
                "{field} is {given}, which makes no positive finite stiffness"
            ),
            ClothError::Damping { given } => write!(
                f,
                "damping_s is {given}, which is no finite time of 0 or more"
            ),
            ClothError::Length {
                ends: [a, b],
                given,
            } => write!(f, "the edge {a}-{b} has the rest length {given} m"),
            ClothError::Face { face, warp } => write!(
                f,
                "the face {face} has no area at rest, or the warp ({}, {}, {}) no direction in it",
                warp.x, warp.y, warp.z
            ),
            ClothError::Counts {
                vertices,
                positions,
                masses,
            } => write!(
                f,
                "there are {positions} positions and {masses} masses for {vertices} vertices"
            ),
        }
    }
}

impl std::error::Error for ClothError {}
