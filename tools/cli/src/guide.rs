//! The guide to the command `tearmesh`.
//!
//! * [`cut`]: cut a file, step by step: rays, layers, gap, pieces, map, mend.
//! * [`codes`]: exit codes, and every error code and warning code.
//! * [`report`]: every key of the JSON report.
//! * [`scenes`]: every key of a scene file.
//! * [`batches`]: process many files at once with GNU parallel.
//! * [`charts`]: which method for what, by experiment.
//! * [`play`]: play with a cloth by hand, and use its module in another page.
//! * [`blender`]: play a simulation in Blender.
//!
//! The guide of the crate `tearmesh` says what a version number promises, how the project compares
//! with other software, and where it differs from the paper: [`tearmesh::guide`]. The guide of the
//! crate `tearmesh-cloth` is about simulating and tearing: [`tearmesh_cloth::guide`].

#[doc = include_str!("guide/cut.md")]
pub mod cut {}

#[doc = include_str!("guide/codes.md")]
pub mod codes {}

#[doc = include_str!("guide/report.md")]
pub mod report {}

#[doc = include_str!("guide/scenes.md")]
pub mod scenes {}

#[doc = include_str!("guide/batches.md")]
pub mod batches {}

#[doc = include_str!("guide/charts.md")]
pub mod charts {}

#[doc = include_str!("guide/play.md")]
pub mod play {}

#[doc = include_str!("guide/blender.md")]
pub mod blender {}
