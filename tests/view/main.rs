//! Tests of pictures: which face is seen, what lines are drawn, and what strange meshes do.

mod coverage;
#[path = "../support/digest.rs"]
mod digest;
mod lines;
mod meshes;
mod page;
mod pictures;
