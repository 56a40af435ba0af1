//! Cloth on the kernel [`tearmesh`]: particles, constraints, solvers, a follower of the log, rules
//! for tearing, and whole [`scene`]s.
//!
//! The kernel is re-exported, so that a game needs this one dependency: `tearmesh_cloth::tearmesh`.
//! It knows nothing of this crate, and a simulation of your own can follow its log in the same way.
//!
//! A [`Simulation`] is a cloth to hold in the hand: a game or a page calls its verbs (hold, grab,
//! lead, cut, heal), lets time pass, and draws it. What it is made of can be used by itself.
//!
//! A [`System`] is particles, springs and triangles over slices, with no mesh in sight. A
//! [`Solver`] advances it. [`System::step`] checks stability, detects blow-up and steps that miss
//! their tolerance, and keeps the last good state. A [`Cloth`] is a system built from a mesh, and a
//! follower of its log. A [`Tear`] tears it where it is overstretched, by the rules of a
//! [`Tearing`] with a [`Threshold`].
//!
//! | method | purpose | cost of a step |
//! |---|---|---|
//! | [`Provot`] | the mass-spring model of the paper: a baseline | one force evaluation, and passes of the limiter |
//! | [`Pbd`] | the second model of the paper: a baseline | sweeps of projections |
//! | [`Verlet`] | the default: exact at rest at every step, with guards for light and crushed cloth | one force evaluation |
//! | [`Xpbd`] | stiff scenes that have to look right; too soft at long steps | substeps of one sweep |
//! | [`Implicit`] | stiff and accurate at once, one sliver among good faces | conjugate gradients |
//!
//! Explicit Euler (never stable) and the one-step midpoint rule (gains energy) are not offered.
//!
//! Stretch is resisted by springs along edges ([`Stretch`]), by triangles with a modulus for warp, weft and shear
//! ([`Orthotropic`]), or by both. Bending is resisted by springs across edges, or by arcs that buckle
//! ([`Bending`]). [`Pbd`] and [`Xpbd`] project springs alone, and are refused if there are
//! triangles or arcs.
//!
//! [`guide`] introduces all of this by examples.
//!
//! Units are SI: metres, kilograms, seconds, newtons. Results depend on `+ − × ÷ √` in a
//! fixed order; no step allocates once its solver has seen a system of that size.

#![forbid(unsafe_code)]

pub use tearmesh;

mod cloth;
#[doc(hidden)]
pub mod digest;
pub mod guide;
mod method;
pub mod scene;
mod simulation;
mod system;
#[doc(hidden)]
pub mod text;

pub use cloth::fabric::{BendRemoval, Bending, Fabric, Orthotropic, Stretch, TornStiffness};
pub use cloth::seam::{Seam, SeamError, SeamFault};
pub use cloth::tearing::apply::{Tear, TearReport};
pub use cloth::tearing::{Tearing, TearingError, Threshold};
pub use cloth::{Cloth, ClothError};
pub use method::implicit::{self, Implicit};
pub use method::provot::{Limiter, Provot};
pub use method::solver::{Abilities, Failure, Quality, Solver, StepError, StepLimit};
pub use method::stability::{frequency_bound, recommended_step_s, stable_step_s};
pub use method::verlet::Verlet;
pub use method::xpbd::{Pbd, Xpbd};
pub use method::{FRAME_S, Method};
pub use simulation::{
    BufferChanges, ClothBuffers, CutId, Event, HandId, InputError, InputLog, LogError, PairTally,
    Picked, Reached, ReplayError, Simulation, SimulationDef, SimulationError, Wounds,
};
pub use system::air;
pub use system::balance::{Balance, EnergyBalance};
pub use system::bend::Buckling;
pub use system::blow_up::BlowUpSite;
pub use system::body::{Body, BodyError};
pub use system::constraint::{Constraint, ConstraintId, Constraints};
pub use system::counters::{Counters, FeatureVisits, Visits};
pub use system::error::{SettingError, SystemError};
pub use system::guard::Frequency;
pub use system::load::{Collider, ColliderShape, Loads, Wind};
pub use system::path::{Path, Pose, RigidMotion};
pub use system::triangle::Triangle;
pub use system::{System, Unstable};
pub use system::{energy, force};

/// The library's example in the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
