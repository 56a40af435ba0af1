//! The guide to cloth: hold it, simulate it, tear it, and cut it while it moves.
//!
//! * [`hold`]: a cloth in the hand: verbs, events, draw buffers, and a log that replays.
//! * [`simulate`]: a cloth from a mesh, its fabric, its loads, and the choice of a method.
//! * [`tear`]: thresholds, the rules for the course of a tear, and reports.
//! * [`cut`]: cutting a cloth that is in motion.
//!
//! [`tearmesh::guide`] has the guide to the kernel below this crate.

#[doc = include_str!("guide/hold.md")]
pub mod hold {}

#[doc = include_str!("guide/simulate.md")]
pub mod simulate {}

#[doc = include_str!("guide/tear.md")]
pub mod tear {}

#[doc = include_str!("guide/cut.md")]
pub mod cut {}
