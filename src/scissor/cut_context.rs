//! The input that every stage of a cut reads, from the trace to the report.

use super::offsets::Offsets;
use super::strip::Strip;
use crate::id::{FaceId, VertexId};

/// The faces and planes that bound a cut.
pub(super) struct CutContext<'w> {
    pub(super) strip: &'w Strip,
    /// The faces that it may cross, ascending.
    pub(super) among: &'w [FaceId],
    /// Where this cut goes on from another, and where it comes back to one: vertices on the plane and
    /// on the first side plane, and on the second.
    pub(super) joints: &'w [Vec<VertexId>; 2],
    pub(super) offsets: &'w Offsets,
}
