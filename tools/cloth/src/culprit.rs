//! Where a blow-up showed: what is not finite, too long, or too large, in a state that is given up.

use std::fmt;

use tearmesh::geometry::{Point, Vector, check_point, dot, length};

use crate::constraint::ConstraintId;
use crate::digits::Digits;
use crate::implicit::triangle;
use crate::system::{Family, Model};

/// Where a blow-up showed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Culprit {
    /// A particle whose position or velocity is not finite.
    Particle(usize),
    /// A particle that is farther off than [`COORDINATE_MAX`](tearmesh::COORDINATE_MAX) metres, or
    /// faster than as many metres in a second.
    Beyond(usize),
    /// A stretch constraint.
    Constraint {
        /// Its particles.
        ends: [usize; 2],
        /// Its length as a multiple of its rest length.
        stretch_ratio: f64,
    },
    /// A bend constraint.
    Bend {
        /// Its particles.
        ends: [usize; 2],
        /// Its length as a multiple of its rest length.
        stretch_ratio: f64,
    },
    /// A triangle.
    Triangle {
        /// Its particles.
        corners: [usize; 3],
        /// The length of its warp or weft as a multiple of the rest length.
        stretch_ratio: f64,
    },
    /// Nothing: the method gave up a system without constraints, in which all numbers are sane.
    Unknown,
}

/// Positions and velocities.
pub(crate) type State<'a> = (&'a [Point], &'a [Vector]);

impl Culprit {
    /// The culprit of a step that was given up, by the states that are known of it, the oldest first:
    /// the first particle that is not finite, or the longest constraint beyond all measure, or the
    /// first particle that is, of the first state that has one.
    pub(crate) fn of(model: &Model, states: &[State<'_>]) -> Culprit {
        let shown = states.iter().find_map(|&state| {
            let too_long = |&(ratio, _): &(f64, Culprit)| ratio > model.stretch_ratio_max;
            let longest = || longest(model, state.0).filter(too_long);
            let named = broken(state).or_else(|| longest().map(|(_, culprit)| culprit));
            named.or_else(|| beyond(state))
        });
        let last = || longest(model, states.last()?.0).map(|(_, culprit)| culprit);
        shown.or_else(last).unwrap_or(Culprit::Unknown)
    }
}

fn broken((positions, velocities): State<'_>) -> Option<Culprit> {
    let mut particles = positions.iter().zip(velocities);
    let bad = |(p, v): (&Point, &Vector)| !p.iter().chain(v.iter()).all(|x| x.is_finite());
    particles.position(bad).map(Culprit::Particle)
}

fn beyond((positions, velocities): State<'_>) -> Option<Culprit> {
    let mut particles = positions.iter().zip(velocities);
    let far =
        |(&p, &v): (&Point, &Vector)| [p, v.into()].map(check_point).iter().any(Result::is_err);
    particles.position(far).map(Culprit::Beyond)
}

/// The constraint or triangle that is longest for its rest length, and by how much.
fn longest(model: &Model, positions: &[Point]) -> Option<(f64, Culprit)> {
    let mut worst: Option<(f64, Culprit)> = None;
    let mut weigh = |ratio: f64, culprit: Culprit| {
        if worst.is_none_or(|(most, _)| ratio > most) {
            worst = Some((ratio, culprit));
        }
    };
    for family in [Family::Stretch, Family::Bend] {
        let constraints = model.family(family);
        let ratio = |id: ConstraintId| {
            let constraint = constraints.get(id);
            let [a, b] = constraint.ends;
            let d = positions[b] - positions[a];
            (constraint, dot(d, d).sqrt() / constraint.rest_length_m)
        };
        for (constraint, stretch_ratio) in constraints.iter().map(ratio) {
            let ends = constraint.ends;
            match family {
                Family::Stretch => weigh(
                    stretch_ratio,
                    Culprit::Constraint {
                        ends,
                        stretch_ratio,
                    },
                ),
                // A bend that buckles and has no stiffness does nothing.
                Family::Bend if model.buckling.is_some() && constraint.stiffness_n_per_m == 0.0 => {
                }
                Family::Bend => weigh(
                    stretch_ratio,
                    Culprit::Bend {
                        ends,
                        stretch_ratio,
                    },
                ),
            }
        }
    }
    for t in model.triangles.as_slice() {
        let derivatives = t.derivatives(triangle::corners(t, positions));
        let stretch_ratio = derivatives.map(length).into_iter().fold(0.0, f64::max);
        let corners = t.vertices.map(|v| v as usize);
        weigh(
            stretch_ratio,
            Culprit::Triangle {
                corners,
                stretch_ratio,
            },
        );
    }
    worst
}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Culprit::Particle(particle) => write!(f, "particle {particle} is not finite"),
            Culprit::Beyond(particle) => write!(f, "particle {particle} is beyond all measure"),
            Culprit::Constraint {
                ends: [a, b],
                stretch_ratio,
            } => write!(
                f,
                "edge {a}-{b} has {} times its rest length",
                Digits(stretch_ratio)
            ),
            Culprit::Bend {
                ends: [a, b],
                stretch_ratio,
            } => write!(
                f,
                "the bend {a}-{b} has {} times its rest length",
                Digits(stretch_ratio)
            ),
            Culprit::Triangle {
                corners: [a, b, c],
                stretch_ratio,
            } => write!(
                f,
                "triangle {a}-{b}-{c} has {} times its size at rest",
                Digits(stretch_ratio)
            ),
            Culprit::Unknown => f.write_str("the method gave up"),
        }
    }
}
