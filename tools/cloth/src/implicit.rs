//! Implicit time steps and states of rest, as Baraff and Witkin 1998 ("Large steps in cloth
//! simulation") made them: pure functions over slices, with no mesh in sight.
//!
//! * [`triangle`] – stretch and shear of a triangle from `w_u` and `w_v`,
//! * [`spring`] – springs with exact derivatives, [`bend`] – Choi and Ko 2002,
//! * [`Layout`], [`Hessian`] – the sparse matrix, changed in place when something tears,
//! * [`Filter`] – held directions; conjugate gradients that respect them,
//! * [`Implicit`] – backward Euler and BDF2, linearised or with Newton's iterations, and
//!   [`Implicit::rest`], the state of rest,
//! * [`damping`] – how much of an oscillation a method swallows.
//!
//! **When to use it.** When Δt has to be far above the explicit limit 2/ω, or for a state of
//! rest. Backward Euler damps everything that moves ([`damping::factor`] says how much); BDF2 is
//! of order two and damps far less. For uniform cloth an explicit method at its limit is
//! cheaper at the same accuracy.
//!
//! **Never silent.** An indefinite matrix, terms that were dropped because of it, halvings of
//! the line search, and the residual are in the [`StepReport`]; a step that fails is an error
//! and leaves positions and velocities as they were.
//!
//! ```
//! use tearmesh::{Point, Vector};
//! use tearmesh_cloth::implicit::{Filter, Implicit, Model, RestSettings, Settings, Spring};
//!
//! // One spring, held at its upper end.
//! let model = Model {
//!     masses: &[0.1, 0.1],
//!     filters: &[Filter::Fixed, Filter::Free],
//!     accelerations: &[Vector::new(0.0, 0.0, -9.81); 2],
//!     springs: &[Spring { ends: [0, 1], rest_length: 1.0, stiffness: 50.0, tension_only: false }],
//!     drag_per_s: 0.5,
//!     ..Model::default()
//! };
//! let mut x = [Point::origin(), Point::new(0.1, 0.0, -1.0)];
//! let mut v = [Vector::zeros(); 2];
//! let mut solver = Implicit::new(&model)?;
//! let report = solver.step(&model, &mut x, &mut v, 1.0 / 60.0, &Settings::default())?;
//! assert!(report.residual <= report.limit && report.clamped == 0);
//!
//! solver.rest(&model, &mut x, &RestSettings::default())?;
//! assert!((x[1].z + 1.0 + 0.1 * 9.81 / 50.0).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bend;
pub mod damping;
mod layout;
mod matrix;
mod pcg;
mod rest;
mod settings;
pub mod spring;
mod step;
pub mod triangle;

pub use bend::{Bend, BendError, Buckling};
pub use layout::Layout;
pub use matrix::{Block, Hessian};
pub use pcg::Filter;
pub use rest::{RestError, RestReport, RestSettings};
pub use settings::{Jacobian, Method, Settings, StepError, StepReport, Tolerance};
pub use spring::Spring;
pub use step::Implicit;
pub use triangle::Triangle;

use std::fmt;

use tearmesh::geometry::{Point, Vector, check_point, dot};

/// What a solver has to know of a piece of cloth: slices of whoever owns it.
///
/// The equation of motion is m a = −∇E(x) + m g − c m v, with g the acceleration of each
/// particle and c the drag.
#[derive(Clone, Copy, Debug, Default)]
pub struct Model<'a> {
    /// The mass of each particle, in kg: positive, or zero for one whose filter is
    /// [`Filter::Fixed`].
    pub masses: &'a [f64],
    /// Where each particle is held. Empty: nowhere.
    pub filters: &'a [Filter],
    /// Gravity, wind and other accelerations on each particle from outside, in m/s². Empty:
    /// none.
    pub accelerations: &'a [Vector],
    /// Springs.
    pub springs: &'a [Spring],
    /// Triangles that resist stretch and shear.
    pub triangles: &'a [Triangle],
    /// Resistance against bending.
    pub bends: &'a [Bend],
    /// Linear drag c, in 1/s: the acceleration is −c v.
    pub drag_per_s: f64,
}

impl Model<'_> {
    /// Whether a solver can work with this. O(size).
    ///
    /// # Errors
    ///
    /// The first number or index that is unusable, and where it is.
    pub fn check(&self) -> Result<(), ModelError> {
        let n = self.masses.len();
        self.check_lengths(n)?;
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        if !usable(self.drag_per_s) {
            return Err(ModelError::Drag {
                given: self.drag_per_s,
            });
        }
        let at = |part, index| ModelError::Unusable { part, index };
        let require = |holds: bool, part, index| if holds { Ok(()) } else { Err(at(part, index)) };
        for (i, &mass) in self.masses.iter().enumerate() {
            let needless = mass == 0.0 && self.filter(i) == Filter::Fixed;
            require(positive(mass) || needless, Part::Mass, i)?;
        }
        for (i, filter) in self.filters.iter().enumerate() {
            require(filter.is_usable(), Part::Filter, i)?;
        }
        for (i, a) in self.accelerations.iter().enumerate() {
            require(a.iter().all(|x| x.is_finite()), Part::Acceleration, i)?;
        }
        let distinct = |[a, b]: [u32; 2]| a != b && (a as usize) < n && (b as usize) < n;
        for (i, s) in self.springs.iter().enumerate() {
            let numbers = usable(s.rest_length) && usable(s.stiffness);
            require(numbers && distinct(s.ends), Part::Spring, i)?;
        }
        for (i, t) in self.triangles.iter().enumerate() {
            let [a, b, c] = t.vertices;
            let ends = distinct([a, b]) && distinct([b, c]) && distinct([c, a]);
            require(ends && t.fault().is_none(), Part::Triangle, i)?;
        }
        for (i, b) in self.bends.iter().enumerate() {
            require(distinct(b.ends()), Part::Bend, i)?;
        }
        Ok(())
    }

    fn check_lengths(&self, n: usize) -> Result<(), ModelError> {
        let lengths = [
            (Part::Mass, self.masses.len(), n),
            (Part::Filter, self.filters.len(), 0),
            (Part::Acceleration, self.accelerations.len(), 0),
        ];
        for (part, given, other) in lengths {
            if given != n && given != other {
                return Err(ModelError::Length {
                    part,
                    given,
                    particles: n,
                });
            }
        }
        Ok(())
    }

    #[inline]
    fn filter(&self, i: usize) -> Filter {
        self.filters.get(i).copied().unwrap_or_default()
    }

    #[inline]
    fn acceleration(&self, i: usize) -> Vector {
        self.accelerations.get(i).copied().unwrap_or_default()
    }

    /// The energy stored in springs, triangles and bends, in J.
    ///
    /// # Panics
    ///
    /// If an index is beyond the positions.
    #[must_use]
    pub fn energy(&self, x: &[Point]) -> f64 {
        let mut sum = 0.0;
        for s in self.springs {
            let [p, q] = at(x, s.ends);
            sum += spring::energy(s, p, q);
        }
        for t in self.triangles {
            sum += triangle::energy(t, at(x, t.vertices));
        }
        for b in self.bends {
            let [p, q] = at(x, b.ends());
            sum += bend::energy(b, p, q);
        }
        sum
    }

    /// The energy of the accelerations from outside, −Σ m g · x, in J, zero at the origin.
    #[must_use]
    pub fn outside_energy(&self, x: &[Point]) -> f64 {
        let mut sum = 0.0;
        for ((g, m), x) in self.accelerations.iter().zip(self.masses).zip(x) {
            sum -= m * dot(*g, x.coords);
        }
        sum
    }

    /// The force on each particle, in N: of springs, triangles and bends, each of which sums to
    /// zero, and m g. Without drag, and also on held particles.
    ///
    /// # Panics
    ///
    /// If an index is beyond the positions.
    pub fn forces(&self, x: &[Point], out: &mut Vec<Vector>) {
        out.clear();
        out.extend((0..x.len()).map(|i| self.acceleration(i) * self.masses[i]));
        let mut pull = |[i, j]: [u32; 2], force: Vector| {
            out[i as usize] += force;
            out[j as usize] -= force;
        };
        for s in self.springs {
            let [p, q] = at(x, s.ends);
            pull(s.ends, spring::force(s, p, q));
        }
        for b in self.bends {
            let [p, q] = at(x, b.ends());
            pull(b.ends(), bend::force(b, p, q));
        }
        for t in self.triangles {
            let forces = triangle::forces(t, at(x, t.vertices));
            for (v, f) in t.vertices.into_iter().zip(forces) {
                out[v as usize] += f;
            }
        }
    }

    /// The second derivatives of [`Model::energy`], into `out`, and how many terms had a part
    /// dropped. With `clamp` every term is positive semidefinite; without it derivatives are
    /// exact.
    ///
    /// # Panics
    ///
    /// If the layout does not belong to this model (see [`Layout::follow`]).
    pub fn hessian(&self, x: &[Point], layout: &Layout, clamp: bool, out: &mut Hessian) -> u64 {
        assert!(
            (self.springs.len(), self.triangles.len(), self.bends.len())
                == (
                    layout.springs().len(),
                    layout.triangles().len(),
                    layout.bends().len()
                ),
            "the layout has a slot for each constraint"
        );
        out.clear(x.len(), layout.pairs().len());
        let mut clamped = 0;
        for (s, &slot) in self.springs.iter().zip(layout.springs()) {
            let [p, q] = at(x, s.ends);
            let (k, dropped) = spring::hessian(s, p, q, clamp);
            clamped += u64::from(dropped);
            out.add_pair(slot, s.ends, &k);
        }
        for (b, &slot) in self.bends.iter().zip(layout.bends()) {
            let [p, q] = at(x, b.ends());
            let (k, dropped) = bend::hessian(b, p, q, clamp);
            clamped += u64::from(dropped);
            out.add_pair(slot, b.ends(), &k);
        }
        for (t, slots) in self.triangles.iter().zip(layout.triangles()) {
            let (blocks, dropped) = triangle::hessian(t, at(x, t.vertices), clamp);
            clamped += u64::from(dropped);
            for (i, slot) in slots.iter().enumerate() {
                let j = (i + 1) % 3;
                let (a, b) = (t.vertices[i], t.vertices[j]);
                out.add(*slot, [a, a], &blocks[i][i]);
                out.add(*slot, [a, b], &blocks[i][j]);
            }
        }
        clamped
    }
}

#[inline]
fn at<const N: usize>(x: &[Point], particles: [u32; N]) -> [Point; N] {
    particles.map(|i| x[i as usize])
}

/// The first particle whose position or velocity is unusable.
fn first_bad(x: &[Point], v: &[Vector]) -> Option<usize> {
    let bad = x.iter().position(|&p| check_point(p).is_err());
    let fast = v.iter().position(|v| check_point(Point::from(*v)).is_err());
    bad.or(fast)
}

/// What was done, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How often all forces were computed.
    pub force_evaluations: u64,
    /// How often all second derivatives were.
    pub hessian_evaluations: u64,
    /// How often the energy was, for line searches.
    pub energy_evaluations: u64,
    /// Products of the matrix and a vector.
    pub matrix_products: u64,
    /// Iterations of conjugate gradients.
    pub solver_iterations: u64,
}

impl Work {
    /// What was done since `before`.
    #[must_use]
    pub fn since(&self, before: &Work) -> Work {
        Work {
            force_evaluations: self.force_evaluations - before.force_evaluations,
            hessian_evaluations: self.hessian_evaluations - before.hessian_evaluations,
            energy_evaluations: self.energy_evaluations - before.energy_evaluations,
            matrix_products: self.matrix_products - before.matrix_products,
            solver_iterations: self.solver_iterations - before.solver_iterations,
        }
    }
}

/// A part of a [`Model`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A mass is not positive and finite, and no zero of a particle that is fixed.
    Mass,
    /// The direction of a filter is not of length one.
    Filter,
    /// An acceleration is not finite.
    Acceleration,
    /// A spring has one particle twice, one that does not exist, or an unusable number.
    Spring,
    /// A triangle has.
    Triangle,
    /// A bend has.
    Bend,
    /// A position is not finite or beyond [`COORDINATE_MAX`](tearmesh::COORDINATE_MAX).
    Position,
    /// A velocity is.
    Velocity,
}

/// Why a model was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelError {
    /// A slice has another length than there are particles.
    Length {
        /// Which slice.
        part: Part,
        /// Its length.
        given: usize,
        /// How many particles there are.
        particles: usize,
    },
    /// An entry of a slice cannot be used.
    Unusable {
        /// Which slice.
        part: Part,
        /// The index of the entry.
        index: usize,
    },
    /// The drag is negative or not finite.
    Drag {
        /// As given.
        given: f64,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelError::Length {
                part,
                given,
                particles,
            } => {
                write!(f, "{given} entries of {part:?} for {particles} particles")
            }
            ModelError::Unusable { part, index } => {
                write!(f, "{part:?} {index} cannot be used")
            }
            ModelError::Drag { given } => write!(f, "a drag of {given} cannot be used"),
        }
    }
}

impl std::error::Error for ModelError {}
