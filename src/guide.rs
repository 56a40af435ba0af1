//! The guide to the kernel, and to the project as a whole.
//!
//! * [`link`]: build a mesh, split it, walk around it, cut it, and keep your own data in step.
//! * [`paper`]: where this project differs from the paper that it implements, and why.
//! * [`proven`]: what is proven, what is tested, and what is promised.
//! * [`peers`]: how it compares with other software.
//! * [`semver`]: what a version number promises.
//! * [`changes`]: what each version changed.
//!
//! The crate `tearmesh-cloth` has a guide to simulating and tearing cloth. The crate `tearmesh-cli`
//! has a guide to the command line tool: cutting files, error codes, the JSON report, scene files,
//! batches and Blender.

#[doc = include_str!("guide/changes.md")]
pub mod changes {}

#[doc = include_str!("guide/link.md")]
pub mod link {}

#[doc = include_str!("guide/paper.md")]
pub mod paper {}

#[expect(clippy::doc_markdown, reason = "names of other programs are no code")]
#[doc = include_str!("guide/peers.md")]
pub mod peers {}

#[doc = include_str!("guide/proven.md")]
pub mod proven {}

#[doc = include_str!("guide/semver.md")]
pub mod semver {}
