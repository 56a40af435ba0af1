//! The integration tests of the library, in one binary.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod allocation;
mod cloth_air;
mod cloth_answers;
mod cloth_balance;
mod cloth_bending;
mod cloth_cost;
mod cloth_failures;
mod cloth_follow;
mod cloth_limiter;
mod cloth_reaction;
mod cloth_scenes;
mod cloth_stiff;
mod cloth_stiff_held;
mod cloth_strain;
mod cloth_tables;
mod cloth_tearing;
mod cloth_tearing_links;
mod cloth_tearing_order;
mod cloth_tearing_runs;
mod cloth_watch;
mod cloth_weave;
mod cloth_weave_limits;
mod cut_mend;
mod exact;
mod exhaustive;
mod figures;
mod fuzz;
mod house;
mod implicit;
mod lockstep;
mod methods;
mod oracle;
mod pieces;
mod properties;
#[path = "data/random.rs"]
mod random;
mod rays;
mod same_bytes;
mod scissor;
mod straight;
mod straight_polylines;
mod subdivide;
mod tear;
