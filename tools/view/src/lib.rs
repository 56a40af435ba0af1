//! Pictures of torn meshes, without a graphics card and without a window, and pages that show them in a browser.
//!
//! [`render`] draws a mesh into a [`Picture`], which is written as PNG: shaded from both sides, each piece
//! in its colour, torn edges red, the boundary dark. A [`Camera`] is placed by hand, or by [`fit`]. Where a
//! cut would go is the [`trace`] of its scissor. [`write_pc2`] writes a simulation as a point cache.
//!
//! A [`Page`] is one HTML file that shows meshes by WebGL 2, and needs no network: what stands still can be
//! turned and cuts planned on it, and what moves or tears is played. What runs in the browser lies in
//! `src/page` as it is sent: scripts without a library, in the order in which they use each other.
//!
//! Everything that decides a pixel is computed with + − × ÷ √ alone, so the same mesh gives the same
//! picture on every machine, and a picture can be compared with one that was looked at before. A page has the same
//! bytes everywhere, too; what a graphics card makes of them is its own.

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
