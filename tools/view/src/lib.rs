//! Pictures of torn meshes, without a graphics card or a window, and pages that show meshes in a browser.
//!
//! [`render`] draws a mesh into a [`Picture`], which can be written as a PNG file. Faces are shaded from
//! both sides, each piece has its own colour, torn edges are red, and the boundary is dark. A [`Camera`] is
//! placed by hand or by [`fit`]. [`trace`] computes where a cut would go. [`write_pc2`] writes a simulation
//! as a point cache.
//!
//! A [`Page`] is one HTML file that shows meshes by WebGL 2 and needs no network. The viewer can turn a
//! mesh, plan cuts on it, and play a mesh that moves or tears. The scripts of the page are in `src/page`,
//! exactly as the browser receives them. They use no library, and each uses only those before it.
//!
//! A [`PlayPage`] is an HTML file on which a cloth is grabbed, ripped, cut and mended by hand. It contains a
//! simulation as WebAssembly. Its scripts are in `src/play`, and come after those that all pages share.
//!
//! All operations that determine a pixel are + − × ÷ √, so the same mesh gives the same picture on every
//! machine, and a test can compare a picture with an earlier one. A page also has the same bytes on every
//! machine, but graphics cards may draw it differently.

#![forbid(unsafe_code)]

mod bounds;
mod camera;
mod figure;
mod fit;
mod page;
pub mod palette;
mod pc2;
mod picture;
mod pieces;
mod play;
mod render;
mod shade;
mod sky;
mod strokes;
mod surface;
mod trace;

pub use camera::{Camera, CameraError};
pub use fit::{ANGLE_OF_VIEW, fit, fit_all};
pub use page::{CutLine, MOMENTS_PER_S, Moment, Page};
pub use pc2::write_pc2;
pub use picture::{PIXELS_MAX, Picture, PictureSize};
pub use play::{PlayPage, is_page};
pub use render::{RenderOptions, faces_seen, render, write_drawn};
pub use trace::trace;
