//! Why particles, constraints or loads were refused.

use std::fmt;

use tearmesh::geometry::Point;

use crate::Constraint;

/// The reason why particles, constraints, triangles or loads were refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SystemError {
    /// The number of masses differs from the number of points.
    Counts {
        /// The number of points.
        points: usize,
        /// The number of masses.
        masses: usize,
    },
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
    /// A stiffness of a triangle is negative, one of its numbers is not finite, its coordinates in
    /// the material span no area, or its corners are not three different particles.
    Triangle {
        /// The indices of the particles that were given as corners.
        corners: [usize; 3],
    },
    /// A number of a load is not finite, or is negative where it must not be.
    Loads {
        /// The name of the field of [`Loads`](crate::Loads).
        field: &'static str,
        /// The value that was given; for a vector, its unusable component.
        given: f64,
    },
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SystemError::Counts { points, masses } => {
                write!(f, "there are {masses} masses for {points} points")
            }
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
            SystemError::Triangle { corners: [a, b, c] } => write!(
                f,
                "the particles {a}, {b} and {c} make no triangle with these coordinates and this stiffness"
            ),
            SystemError::Loads { field, given } => {
                write!(f, "{field} is {given}, which is not finite, or negative")
            }
        }
    }
}

impl std::error::Error for SystemError {}
