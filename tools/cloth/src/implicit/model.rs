//! What a solver is given of a piece of cloth, and why it refuses to work with it.

use std::fmt;

use tearmesh::geometry::{Point, Vector, check_point};

use super::{Bend, Filter, Spring, Triangle};

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

    pub(super) fn check_lengths(&self, n: usize) -> Result<(), ModelError> {
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
    pub(super) fn filter(&self, i: usize) -> Filter {
        self.filters.get(i).copied().unwrap_or_default()
    }

    #[inline]
    pub(super) fn acceleration(&self, i: usize) -> Vector {
        self.accelerations.get(i).copied().unwrap_or_default()
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

/// The first particle whose position or velocity is unusable.
pub(super) fn first_bad(x: &[Point], v: &[Vector]) -> Option<usize> {
    let bad = x.iter().position(|&p| check_point(p).is_err());
    let fast = v.iter().position(|v| check_point(Point::from(*v)).is_err());
    bad.or(fast)
}
