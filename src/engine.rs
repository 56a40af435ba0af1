//! Exchange between a mesh and an engine: draw buffers, the face under a pointer, and normals.
//!
//! * [`DrawBuffers`] turns a mesh into an engine's buffers, with what changed since they were last asked.
//!   [`unsewn::weld`](crate::unsewn::weld) builds a mesh from such buffers.
//! * [`pick`] finds the face that a ray meets first.
//! * [`Normals`] are those of the vertices, for smooth shading, made anew only where something changed.

mod draw;
mod normals;
pub mod pick;

pub use draw::{DrawBuffers, DrawChanges};
pub use normals::Normals;
pub use pick::RayHit;
