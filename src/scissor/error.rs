//! The reasons for which a scissor is not made, or does not cut.

use std::fmt;

use crate::edit::Cursor;
use crate::geometry::Point;
use crate::id::VertexId;

/// The reason why two rays do not give a scissor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ScissorError {
    /// The two rays lie on one line, so they span no plane.
    OneLine,
    /// The ray passes through the vertex from which the cut should continue.
    NoLength,
}

impl fmt::Display for ScissorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ScissorError::OneLine => {
                "the two rays are the same line, so they span no cutting plane"
            }
            ScissorError::NoLength => "the cut would end at the point from which it continues",
        })
    }
}

impl std::error::Error for ScissorError {}

/// The reason why a cut was refused. A refused cut changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CutError {
    /// The mesh and the positions have different numbers of vertices.
    Positions {
        /// The number of vertices of the mesh.
        vertices: usize,
        /// The number of positions given.
        positions: usize,
    },
    /// The positions have not replayed all edits of the log.
    Unreplayed {
        /// The place in the log up to which the positions have been replayed.
        seen: Cursor,
        /// The end of the log that was passed to the cut.
        made: Cursor,
    },
    /// The end from which the cut should continue has not replayed all edits of the log.
    End {
        /// The place in the log up to which the end has been replayed.
        seen: Cursor,
        /// The end of the log that was passed to the cut.
        made: Cursor,
    },
    /// The rays cross in front of both origins, and their plane meets the mesh before the crossing
    /// and beyond it. Which part should be cut is ambiguous.
    RaysCross {
        /// The point of crossing, on the first ray.
        at: Point,
    },
    /// The second ray meets a face of the vertex from which the cut should continue, closer to that
    /// vertex than the [snap](super::Scissor::with_snap) as a part of the way through the face.
    TooShort {
        /// The vertex from which the cut should continue.
        joint: VertexId,
    },
}

impl fmt::Display for CutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CutError::Positions {
                vertices,
                positions,
            } => {
                write!(f, "{positions} positions for a mesh of {vertices} vertices")
            }
            CutError::Unreplayed { seen, made } => unreplayed(f, "positions have", *seen, *made),
            CutError::End { seen, made } => unreplayed(f, "end of a cut has", *seen, *made),
            CutError::RaysCross { at } => write!(
                f,
                "the rays cross at ({}, {}, {}), and the mesh is on both sides of the crossing",
                at.x, at.y, at.z
            ),
            CutError::TooShort { joint } => write!(
                f,
                "the cut would end closer to {joint}, from which it continues, than the snap"
            ),
        }
    }
}

fn unreplayed(f: &mut fmt::Formatter<'_>, who: &str, seen: Cursor, made: Cursor) -> fmt::Result {
    let (seen, made) = (seen.number(), made.number());
    if seen == made {
        return write!(f, "the {who} followed another log, of {seen} edits too");
    }
    write!(
        f,
        "the {who} seen {seen} edits, and the log has {made}: replay first"
    )
}

impl std::error::Error for CutError {}
