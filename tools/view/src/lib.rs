//! Pictures of torn meshes, without a graphics card and without a window.
//!
//! [`render`] draws a mesh into a [`Picture`], which is written as PNG: shaded from both sides, each piece
//! in its colour, torn edges red, the boundary dark. A [`Camera`] is placed by hand, or by [`fit`]. Where a
//! cut would go is the [`trace`] of its scissor. [`write_pc2`] writes a simulation as a point cache.
//!
//! Everything that decides a pixel is computed with + − × ÷ √ alone, so the same mesh gives the same
//! picture on every machine, and a picture can be compared with one that was looked at before.

mod bounds;
mod camera;
mod fit;
mod page;
pub mod palette;
mod pc2;
mod picture;
mod render;
mod shade;
mod strokes;
mod surface;
mod trace;

pub use bounds::Bounds;
pub use camera::{Camera, CameraError};
pub use fit::{ANGLE_OF_VIEW, fit};
pub use page::{CutLine, MOMENTS_PER_S, Moment, Page, PageError, Plot, is_page};
pub use pc2::write_pc2;
pub use picture::{PIXELS_MAX, Picture, PictureSize};
pub use render::{RenderOptions, faces_seen, render};
pub use trace::trace;
