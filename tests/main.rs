//! The integration tests of the library, in one binary.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod allocation;
mod apart;
#[path = "support/cases.rs"]
mod cases;
mod cut_mend;
mod cuts;
#[path = "support/delaunay.rs"]
mod delaunay;
#[path = "support/digest.rs"]
mod digest;
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
#[path = "support/inputs.rs"]
mod inputs;
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
mod proof;
mod properties;
#[path = "support/random.rs"]
mod random;
mod rational;
mod rays;
mod same_bytes;
mod scissor;
mod scripts;
mod sheet;
mod shrink;
mod straight;
mod straight_polylines;
mod surfaces;
mod tear;
mod tips;
mod undo;
mod work;
