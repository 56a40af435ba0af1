//! placeholder
mod attribute;
pub mod classify;
mod edit;
mod exact;
mod geometry;
mod id;
mod mass;
mod mesh;
mod place;
mod scissor;
#[cfg(feature = "script")]
pub mod script;
pub mod shapes;
pub mod split;

pub use attribute::{PerCorner, PerVertex};
pub use edit::{Edit, Edits, Follower, Split, TornLink};
pub use exact::ExactSum;
pub use geometry::{COORDINATE_MAX, Plane, PlaneError, Point, Ray, RayError, Side, Vector};
pub use id::{FaceId, HalfEdgeId, VertexId};
pub use mass::{Ledger, MassError, Masses};
pub use mesh::{
    BoundaryLoop, BuildError, Components, Corners, Defect, Fan, Invariant, Mesh, Violation,
};
pub use place::{Place, PositionError, Positions};
pub use scissor::{CutError, CutReport, Method, Scissor, ScissorError, Tips};
