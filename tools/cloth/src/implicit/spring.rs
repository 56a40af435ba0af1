//! Springs between two particles: energy, force, second derivative.
//!
//! E = ½ k (l − L₀)². The force along the spring is k (l − L₀), the second derivative
//!
//! ```text
//! H = k [ d dᵀ + (1 − L₀/l) (I − d dᵀ) ],   d the direction, l the length
//! ```
//!
//! Under compression the second term is negative and H indefinite; Choi and Ko 2002 §4 drop
//! it there. What is dropped is counted, because the step is then no longer Newton's.

use tearmesh::geometry::{Point, Vector, dot};

use super::matrix::Block;

/// A spring, or a thread that only pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// The two particles.
    pub ends: [u32; 2],
    /// The length without force, in m; zero or more.
    pub rest_length: f64,
    /// N/m.
    pub stiffness: f64,
    /// Whether it gives way under compression, as the edges of Choi and Ko 2002 §4.1 do.
    pub tension_only: bool,
}

/// The energy of a spring, in J, with its ends at `p` and `q`.
#[inline]
#[must_use]
pub fn energy(spring: &Spring, p: Point, q: Point) -> f64 {
    let stretch = Line::between(p, q).length - spring.rest_length;
    if spring.tension_only && stretch < 0.0 {
        return 0.0;
    }
    0.5 * spring.stiffness * (stretch * stretch)
}

/// The force on the end at `p`, in N; the other end has its negative. Zero where both ends are
/// one point, which has no direction.
#[inline]
#[must_use]
pub fn force(spring: &Spring, p: Point, q: Point) -> Vector {
    let line = Line::between(p, q);
    let stretch = line.length - spring.rest_length;
    if spring.tension_only && stretch < 0.0 {
        return Vector::zeros();
    }
    line.direction * (spring.stiffness * stretch)
}

/// The second derivative of the energy by the position of either end (by both it is the
/// negative), in N/m, and whether something was dropped to keep it from being indefinite.
///
/// Where both ends are one point the derivative does not exist; k I is given for it.
#[inline]
#[must_use]
pub fn hessian(spring: &Spring, p: Point, q: Point, clamp: bool) -> (Block, bool) {
    let line = Line::between(p, q);
    let stretch = line.length - spring.rest_length;
    if spring.tension_only && stretch < 0.0 {
        return (Block::ZERO, false);
    }
    if line.length == 0.0 {
        return (Block::identity_times(spring.stiffness), false);
    }
    line.hessian(
        spring.stiffness,
        spring.stiffness * (stretch / line.length),
        clamp,
    )
}

/// The length and the direction from one point to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) length: f64,
    /// Of length one, or zero where the points are one.
    pub(super) direction: Vector,
}

impl Line {
    #[inline]
    pub(super) fn between(p: Point, q: Point) -> Line {
        let span = q - p;
        let length = dot(span, span).sqrt();
        let direction = if length > 0.0 {
            span / length
        } else {
            Vector::zeros()
        };
        Line { length, direction }
    }

    /// The second derivative of an energy E(l): `slope` = E″ along the line, `transverse` =
    /// E′/l across it, zero instead if that is negative and to be clamped.
    #[inline]
    pub(super) fn hessian(&self, slope: f64, transverse: f64, clamp: bool) -> (Block, bool) {
        let clamped = clamp && transverse < 0.0;
        let across = if clamped { 0.0 } else { transverse };
        let along = Block::outer(self.direction, self.direction);
        (
            Block::identity_times(across).plus(slope - across, &along),
            clamped,
        )
    }
}
