//! Why a cloth was refused.

use std::fmt;

use tearmesh::geometry::Vector;
use tearmesh::{FaceId, MassError, VertexId};

use crate::system::error::SettingError;

/// The reason why a cloth was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClothError {
    /// The masses were refused.
    Mass(MassError),
    /// A number of the [`Fabric`](crate::Fabric) cannot be used, or would make a bend too stiff.
    Number(SettingError),
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
}

impl fmt::Display for ClothError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClothError::Mass(error) => error.fmt(f),
            ClothError::Number(error) => error.fmt(f),
            ClothError::Length {
                ends: [a, b],
                given,
            } => write!(f, "the edge {a}-{b} has the rest length {given} m"),
            ClothError::Face { face, warp } => write!(
                f,
                "the face {face} has no area at rest, or the warp ({}, {}, {}) no direction in it",
                warp.x, warp.y, warp.z
            ),
        }
    }
}

impl std::error::Error for ClothError {}
