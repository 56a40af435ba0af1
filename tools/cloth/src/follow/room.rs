//! The room in which a cloth works out an edit.

use tearmesh::HalfEdgeId;

use crate::constraint::ConstraintId;

/// Room that edits reuse.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    pub(super) ids: Vec<ConstraintId>,
    pub(super) vertices: Vec<usize>,
    pub(super) pieces: Vec<Piece>,
}

/// An edge of a child, from one of its sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The lower particle first. They name the edge: no two edges have the same two.
    pub(super) ends: [usize; 2],
    pub(super) half_edge: HalfEdgeId,
    /// The half-edge of the parent that it lies on; any for one inside.
    pub(super) half_edge_before: HalfEdgeId,
    pub(super) apex: usize,
    pub(super) apex_before: usize,
    /// Whether it is a whole edge of the parent.
    pub(super) is_kept: bool,
    /// Whether it is a part of an edge of the parent.
    pub(super) divided: bool,
    /// The constraint of that edge.
    pub(super) stretch: ConstraintId,
    pub(super) bend: ConstraintId,
    /// What k L shall be.
    pub(super) stiffness_by_length: f64,
    pub(super) length: f64,
}
