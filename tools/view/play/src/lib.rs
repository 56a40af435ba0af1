//! A cloth that a person grabs, rips, cuts and mends in a browser: the module of the page that
//! `tearmesh play` writes.
//!
//! A [`Player`] is a simulation with the file of its cloth. `exports` has the same for WebAssembly: numbers go
//! in and out as such, and texts, files and buffers through blocks of memory.

#[cfg(target_arch = "wasm32")]
mod exports;
mod player;
mod settings;

pub use player::{Facts, Player};
pub use settings::{CELLS_MAX, ClothSource, Plan, Settings, VERTICES_MAX};
