//! What engines exchange with a mesh: buffers in and out, the face under a pointer, and normals.
//!
//! * [`weld`] builds a mesh from an engine's buffers, and [`DrawBuffers`] turns it back into such buffers,
//!   with what changed since they were last asked.
//! * [`pick`] finds the face that a ray meets first.
//! * [`Normals`] are those of the vertices, for smooth shading, made anew only where something changed.

mod draw;
mod normals;
pub mod pick;
pub mod weld;

pub use draw::{DrawBuffers, DrawChanges};
pub use normals::Normals;
pub use pick::RayHit;
