//! The integration tests of the library, in one binary.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod allocation;
mod apart;
mod cut_mend;
mod cuts;
mod engine;
mod exact;
mod exhaustive;
mod figures;
mod followers;
mod foreign;
mod fuzz;
mod garment;
mod geometry;
mod house;
mod hub;
mod insert;
mod layers;
mod lockstep;
mod mass;
mod methods;
mod necks;
mod oracle;
mod pick;
mod planes;
mod polygons;
mod polylines;
mod proof;
mod properties;
mod rational;
mod rays;
mod same_bytes;
mod scissor;
mod script_cuts;
mod scripts;
mod sheet;
mod shrink;
mod snap_move;
mod straight;
mod straight_polylines;
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;
mod surfaces;
mod tear;
mod tips;
mod undo;
mod unsewn;
mod work;

use support::{cases, delaunay, digest, inputs, plain, random};
