//! What a cut of any method hands on to whoever measures it.

use crate::geometry::Side;
use crate::id::VertexId;

/// What a method has to tell for the report.
pub(super) struct Outcome {
    /// The side on which the method meant each face to be; `None` for one that may lie on both,
    /// beyond a tip.
    pub(super) labels: Vec<Option<Side>>,
    /// The splits that were tried in vain.
    pub(super) refused: usize,
    pub(super) ends: Ends,
    /// Vertices of the seam that leave the plane inside a face, so that no face gets thin.
    pub(super) off_plane: Vec<VertexId>,
}

/// The vertices at which each side plane ended a cut of the method `exact`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Ends(pub(super) [Vec<VertexId>; 2]);
