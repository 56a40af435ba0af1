//! Exchange between a mesh and an engine: draw buffers, the face under a pointer, and normals.
//!
//! * [`DrawBuffers`] turns a mesh into an engine's buffers, with what changed since they were last asked.
//!   [`draw_origin`] is the origin for positions in `f32`, and
//!   [`unsewn::weld`](crate::unsewn::weld) builds a mesh from such buffers.
//! * [`pick`] finds the face that a ray meets first.
//! * [`normals`] are those of the corners, for shading with creases.

mod draw;
mod normals;
pub mod pick;

pub use draw::{DrawBuffers, DrawChanges, draw_origin};
pub use normals::normals;
pub use pick::RayHit;
