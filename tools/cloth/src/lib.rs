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
//! ([`Weave`]), or by both. Bending is resisted by springs across edges, or by arcs that buckle
//! ([`Bending`]). [`Pbd`] and [`Xpbd`] project springs alone, and are refused if there are
//! triangles or arcs.
//!
//! [`guide`] introduces all of this by examples.
//!
//! Units are SI: metres, kilograms, seconds, newtons. Results depend on `+ − × ÷ √` in a
//! fixed order; no step allocates once its solver has seen a system of that size.

#![forbid(unsafe_code)]

pub use tearmesh;

pub mod air;
mod balance;
mod bend;
mod blow_up;
mod body;
mod collide;
mod constraint;
mod contact;
mod crush;
mod damping;
#[cfg(feature = "serde")]
mod data;
pub mod energy;
mod fabric;
mod follow;
pub mod force;
mod guard;
pub mod guide;
mod held_set;
pub mod implicit;
mod incidence;
mod load;
mod mass_scaling;
mod matrix;
mod method;
mod motion;
mod pair;
mod path;
mod provot;
pub mod scene;
mod seam;
mod sheet;
mod simulation;
mod solver;
mod spring;
mod stability;
pub mod statistics;
mod step;
mod system;
mod tearing;
mod triangle;
mod verlet;
mod weave;
mod xpbd;

pub use air::AirRate;
pub use balance::{Balance, EnergyBalance};
pub use bend::Buckling;
pub use blow_up::BlowUpSite;
pub use body::{Body, BodyError};
pub use constraint::{Constraint, ConstraintId, Constraints};
pub use fabric::{Bending, Copies, Fabric, Stretch, Unbend, Weave};
pub use guard::Frequency;
pub use implicit::Implicit;
pub use load::{Collider, ColliderShape, Loads, Wind};
pub use method::{FRAME_S, Method, Softness};
pub use path::{Path, Pose, RigidMotion};
pub use provot::{Limiter, Provot};
pub use seam::{Seam, SeamError, SeamFault};
pub use sheet::{Cloth, ClothError};
pub use simulation::{
    BufferChanges, ClothBuffers, CutId, Event, HandId, InputError, InputLog, LogError, Picked,
    Reached, ReplayError, Simulation, SimulationDef, SimulationError, Wounds,
};
pub use solver::{Abilities, Failure, LimiterStats, Quality, Solver, StepError, StepLimit};
pub use stability::{frequency_bound, recommended_step_s, stable_step_s};
pub use system::{Counters, FeatureVisits, SettingError, System, SystemError, Unstable, Visits};
pub use tearing::{Tear, TearReport, Tearing, TearingError, Threshold};
pub use triangle::Triangle;
pub use verlet::Verlet;
pub use xpbd::{Pbd, Xpbd};

/// The library's example in the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
