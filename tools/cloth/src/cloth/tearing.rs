//! When a cloth tears, and how far: the loop above the paper's rule for one edge.
//!
//! [`tear::edge`](tearmesh::tear::edge) says what becomes of an edge that is stretched too far
//! (Souza et al. 2014 §III-A). This module says what "too far" is ([`Threshold`]), which edges go
//! first, how many tear at once, and what a tear does to its surroundings ([`Tearing`]); [`Tear`]
//! is the state of a cloth that tears while it runs.
//!
//! Thresholds are held against a *load*: the strain or force that an edge has, as a multiple of
//! what it bears, so that 1 is where it tears. By the paper's rule, a threshold of strain, the
//! force that it takes to tear is proportional to the length of edges: a finer mesh is a weaker
//! cloth. [`Threshold::Toughness`] is an energy per length of tear, G, and does not have that
//! fault: an edge of length h bears the strain √(2 G / (E h)).
//!
//! # What decides, and in which order
//!
//! 1. The edges at or above their threshold are found once, before anything tears: a
//!    split alone moves nothing, so what it relieves shows in the next step, not before.
//! 2. An end can be split where its strength does not bear the load; of two, the rule of the paper
//!    takes the heavier. A vertex that is held cannot be.
//! 3. The worst goes first, by load over the smaller strength of its ends; ids break exact
//!    ties, and nothing else depends on the order of storage.
//! 4. A vertex is split at most once a step, and an edge of a vertex that was split waits for the
//!    next: its length is what it was before the tear only because nothing has moved yet.
//!
//! Every loop is bounded: a split adds a vertex with a face, and there are at most three vertices
//! a face. Cost a step: a pass over edges, without allocation once there was room.
//!
//! How many pieces a cloth tears into depends on the time step, as it does on the mesh: a cascade
//! is the answer of a method to forces that change faster than it steps. The cap bounds how much
//! one step can tear, and [`TearReport::cap_hit`] says whether it was reached.
//!
//! ```
//! use tearmesh_cloth::{Cloth, Fabric, Path, Tear, Tearing, Threshold, Unstable, Verlet};
//! use tearmesh::{shapes, Edits, Masses, Point};
//!
//! let (mut mesh, positions) = shapes::grid(8, 8);
//! let masses = Masses::area(&mesh, &positions, 0.2)?;
//! let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(100.0))?;
//! let system = cloth.system_mut();
//! system.when_unstable(Unstable::Substep);
//! (0..9).for_each(|bottom| system.hold(bottom));
//! for top in 72..81 {
//!     let x = system.positions()[top];
//!     let up = [(0.0, x), (1.0, Point::new(x.x, x.y + 1.0, x.z))];
//!     system.grab(top, Path::new(up).ok_or("a path")?);
//! }
//!
//! let mut tear = Tear::new(&cloth, Tearing::new(Threshold::Stretch(1.5)))?;
//! let mut edits = Edits::new();
//! for _ in 0..60 {
//!     cloth.step(&mut Verlet, 1.0 / 60.0)?;
//!     let report = tear.apply(&mut mesh, &mut cloth, &mut edits);
//!     if report.splits > 0 {
//!         println!("{:.3} m torn", report.tear_length_m);
//!     }
//! }
//! assert!(mesh.components().count() > 1);
//! assert!(cloth.masses().ledger().is_balanced());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Tear`]: crate::Tear
//! [`TearReport::cap_hit`]: crate::TearReport::cap_hit

pub(crate) mod apply;
mod load;

use std::fmt;

use tearmesh::geometry::{Vector, check_point};

use crate::system::error::SettingError;

/// The condition under which an edge tears.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Threshold {
    /// An edge tears when it is this many times as long as at rest, a number above 1. This is the
    /// rule of the paper (Souza et al. 2014 §III-A). With Provot's limiter, the length is taken
    /// before limiting. With [`Xpbd`](crate::Xpbd), it is the length at which a spring would exert
    /// the force of the multiplier. Actual lengths depend on the number and order of sweeps there.
    Stretch(f64),
    /// An edge tears when its length, as a multiple of the rest length, reaches one ratio for edges
    /// along the warp, which is the direction of `axis` at rest, and another for edges along the
    /// weft. A diagonal edge, more than 22.5° from both, never tears by itself: it resists shear,
    /// and shear alone must not tear the cloth.
    WarpWeft {
        /// The ratio at which edges along the warp tear, above 1.
        warp: f64,
        /// The ratio at which edges along the weft tear, above 1.
        weft: f64,
        /// The direction of the warp at rest, as a vector of any length above 0.
        axis: Vector,
    },
    /// An edge tears at the strain √(2 G / (E h)), where G is an energy per length of tear, in J/m,
    /// h the rest length of the edge, and E the modulus of the fabric. E is
    /// [`Fabric::stretch_n_per_m`](crate::Fabric::stretch_n_per_m), the mean of warp and weft of the
    /// [`Orthotropic`](crate::Orthotropic), or the sum of both; for a link without a mesh it is its own
    /// stiffness. At that strain ½ E (l − L)² is G h.
    Toughness(f64),
    /// An edge tears when its force reaches this many newtons, as the method of the last step
    /// exerted it ([`force_n`](crate::force::force_n)). An edge of a membrane with a face on one side
    /// alone bears half that force, and so does a copy with half the stiffness. This is for springs: the edges of a [`Orthotropic`](crate::Orthotropic) have no force,
    /// except with a method that projects.
    Force(f64),
    /// A face tears at its most stretched edge when its largest stretch in any direction
    /// ([`Cloth::principal_stretch`](crate::Cloth::principal_stretch)) reaches this ratio, a number
    /// above 1. This is for triangles rather than springs.
    PrincipalStretch(f64),
}

/// The rules by which a cloth tears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tearing {
    /// The threshold at which an edge tears.
    pub threshold: Threshold,
    /// The largest number of splits per step, the most overloaded edges first. `None` for no cap.
    pub splits_per_step_max: Option<usize>,
    /// A factor on the strength of the tips of a tear, above 0 and at most 1. The tips are the
    /// vertices at which a tear ends: of the vertices to which a split tore links, the one that
    /// lies best along the splitting plane, and, if the vertex was whole before, also the best one
    /// on the other side. A tip is weak against edges that pull across the tear (within 45° at
    /// rest), until it is split itself. A tear then continues where it is instead of starting
    /// elsewhere. `None` for tips that are as strong as before.
    pub weakening: Option<f64>,
}

impl Tearing {
    /// Returns rules with this threshold as in the paper: without a cap, and without weakened
    /// tips.
    #[must_use]
    pub fn new(threshold: Threshold) -> Tearing {
        Tearing {
            threshold,
            splits_per_step_max: None,
            weakening: None,
        }
    }

    /// Checks that all numbers are usable.
    ///
    /// # Errors
    ///
    /// [`TearingError`] names the first number that is not usable.
    pub fn check(&self) -> Result<(), TearingError> {
        let above_1 = |given: f64| {
            let holds = given > 1.0 && given.is_finite();
            SettingError::unless(holds, "threshold", given, "finite and above 1")
        };
        let threshold = match self.threshold {
            Threshold::Stretch(ratio) | Threshold::PrincipalStretch(ratio) => above_1(ratio),
            Threshold::WarpWeft { warp, weft, .. } => above_1(warp).and(above_1(weft)),
            Threshold::Toughness(given) | Threshold::Force(given) => {
                SettingError::unless_above_0("threshold", given)
            }
        };
        let given = self.weakening.unwrap_or(1.0);
        let holds = given > 0.0 && given <= 1.0;
        let weakening = SettingError::unless(holds, "weakening", given, "above 0 and at most 1");
        threshold.and(weakening).map_err(TearingError::Number)?;
        match self.threshold {
            Threshold::WarpWeft { axis: given, .. }
                if given == Vector::zeros() || check_point(given.into()).is_err() =>
            {
                Err(TearingError::Axis { given })
            }
            _ => Ok(()),
        }
    }
}

impl Default for Tearing {
    /// Returns rules by which an edge tears at one and a half times its rest length.
    fn default() -> Tearing {
        Tearing::new(Threshold::Stretch(1.5))
    }
}

/// The reason why a cloth cannot tear by given rules or strengths.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TearingError {
    /// A threshold or the weakening cannot be used.
    Number(SettingError),
    /// The axis of the warp is zero, not finite or too large.
    Axis {
        /// The axis that was given.
        given: Vector,
    },
    /// The number of strengths differs from the number of vertices.
    Strengths {
        /// The number of strengths.
        given: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A strength is not positive and finite. The first such vertex is named.
    Strength {
        /// The index of the vertex, from 0.
        vertex: usize,
        /// The strength that was given.
        given: f64,
    },
}

impl fmt::Display for TearingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TearingError::Number(error) => error.fmt(f),
            TearingError::Axis { given: a } => {
                write!(
                    f,
                    "the axis ({}, {}, {}) of the warp has no direction",
                    a.x, a.y, a.z
                )
            }
            TearingError::Strengths { given, vertices } => {
                write!(f, "there are {given} strengths for {vertices} vertices")
            }
            TearingError::Strength { vertex, given } => {
                write!(
                    f,
                    "the strength {given} of v{vertex} is not positive and finite"
                )
            }
        }
    }
}

impl std::error::Error for TearingError {}
