//! The place where a blow-up showed: a number that is not finite, too long or too large in a state
//! that was discarded.

use std::fmt;

use tearmesh::geometry::{Point, Vector, check_point};

/// The particle or constraint at which a blow-up was noticed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BlowUpSite {
    /// The index of a particle whose position or velocity is not finite.
    Particle(usize),
    /// The index of a particle that is farther than [`COORDINATE_MAX`](tearmesh::COORDINATE_MAX)
    /// metres from the origin, or faster than that many metres per second.
    Beyond(usize),
    /// A stretch constraint that became too long: its particles, and its length as a multiple of its rest
    /// length.
    Constraint([usize; 2], f64),
    /// A bend constraint that became too long: its particles, and its length as a multiple of its rest length.
    Bend([usize; 2], f64),
    /// A triangle that was stretched too far: its particles, and the larger of the ratios of length to rest
    /// length along warp and along weft.
    Triangle([usize; 3], f64),
    /// No place was found: the method failed in a system without constraints in which all numbers
    /// are finite.
    Unknown,
}

impl BlowUpSite {
    /// The particles there.
    pub(crate) fn particles(&self) -> Vec<usize> {
        match *self {
            BlowUpSite::Constraint(ends, _) | BlowUpSite::Bend(ends, _) => ends.to_vec(),
            BlowUpSite::Triangle(corners, _) => corners.to_vec(),
            BlowUpSite::Particle(particle) | BlowUpSite::Beyond(particle) => vec![particle],
            BlowUpSite::Unknown => Vec::new(),
        }
    }

    /// The length of what became too long, as a multiple of its rest length.
    pub(crate) fn stretch_ratio(&self) -> f64 {
        match *self {
            BlowUpSite::Constraint(_, ratio)
            | BlowUpSite::Bend(_, ratio)
            | BlowUpSite::Triangle(_, ratio) => ratio,
            BlowUpSite::Particle(_) | BlowUpSite::Beyond(_) | BlowUpSite::Unknown => f64::NAN,
        }
    }
}

impl fmt::Display for BlowUpSite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ratio = Digits(self.stretch_ratio());
        match *self {
            BlowUpSite::Particle(particle) => write!(f, "particle {particle} is not finite"),
            BlowUpSite::Beyond(particle) => {
                write!(f, "particle {particle} is too far away or too fast")
            }
            BlowUpSite::Constraint([a, b], _) => {
                write!(f, "edge {a}-{b} is {ratio} times its rest length")
            }
            BlowUpSite::Bend([a, b], _) => {
                write!(f, "the bend {a}-{b} is {ratio} times its rest length")
            }
            BlowUpSite::Triangle([a, b, c], _) => {
                write!(f, "triangle {a}-{b}-{c} is {ratio} times its size at rest")
            }
            BlowUpSite::Unknown => f.write_str("the method gave up"),
        }
    }
}

/// The first particle with a bad position or velocity. A velocity is judged as a point would be.
pub(crate) fn first(is_bad: fn(Point) -> bool, x: &[Point], v: &[Vector]) -> Option<usize> {
    let mut particles = x.iter().zip(v);
    particles.position(|(&x, &v)| is_bad(x) || is_bad(v.into()))
}

/// Whether a point is farther away than is usable, or a velocity too fast.
pub(crate) fn is_beyond(point: Point) -> bool {
    check_point(point).is_err()
}

/// A number to three digits or all of those before the point.
pub(crate) struct Digits(pub(crate) f64);

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0.abs();
        if x >= 100.0 || x == 0.0 {
            write!(f, "{:.0}", self.0)
        } else if x < 1e-6 {
            write!(f, "{:.2e}", self.0)
        } else {
            let digits = (2.0 - x.log10().floor()) as usize;
            write!(f, "{:.digits$}", self.0)
        }
    }
}
