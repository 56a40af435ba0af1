//! Scenes as plain data: what is held, moved, blown at and cut, and when.
//!
//! A [`Scene`] says what shall happen to a cloth; a [`Run`] makes it happen. Four
//! scenes stand ready, sized to whatever mesh they are given: [`Scene::hang`], [`Scene::flag`],
//! [`Scene::rip`] and [`Scene::trouser`]. Nothing here is read from files: a program fills in a
//! scene's fields from wherever it likes.

mod chronicle;
mod frame;
mod plays;
mod run;

pub use chronicle::{Chronicle, FirstTear, HoldForces, TearEvent};
pub use frame::{Axis, Frame};
pub use run::{
    CutMade, EnergyGain, GuardStats, LimiterStats, Names, NewtonStats, Quality, Run, RunError,
    RunTally, Softness, StableSteps, Step, suggested_step_s,
};

use tearmesh::geometry::{Point, Ray, Vector, length};
use tearmesh::{Mesh, VertexId};

use crate::fabric::Fabric;
use crate::implicit::{Settings, Tolerance};
use crate::load::{Collider, Wind};
use crate::pbd::Pbd;
use crate::provot::Limiter;
use crate::xpbd::Xpbd;

/// A frame of films and screens, in seconds: steps are whole parts of it, forces are means over it, and
/// energy is looked at once in it.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// What shall happen to a cloth.
#[derive(Clone, Debug)]
pub struct Scene {
    /// How long, in seconds.
    pub duration_s: f64,
    /// The method.
    pub solver: Method,
    /// The step in seconds; `None` for one that suits the method, the fabric and the mesh:
    /// see [`Run::step_s`](Run::step_s).
    pub step_s: Option<f64>,
    /// What the cloth is made of.
    pub fabric: Fabric,
    /// Its mass for each square metre, in kg/m².
    pub areal_density_kg_per_m2: f64,
    /// The acceleration of gravity, in m/s².
    pub gravity_m_per_s2: Vector,
    /// The rate at which velocities fade, in 1/s; 0 for none.
    pub drag_per_s: f64,
    /// Wind, if there is any.
    pub wind: Option<SwayingWind>,
    /// What the cloth cannot enter.
    pub colliders: Vec<Collider>,
    /// What is held, and led about.
    pub holds: Vec<HeldVertices>,
    /// What is cut, and when; ascending in time.
    pub cuts: Vec<TimedCut>,
    /// When edges tear by themselves; `None` for never.
    pub tearing: Option<crate::Tearing>,
    /// Where vertices bear so many times the threshold; elsewhere 1. The last that holds a vertex
    /// counts.
    pub strengths: Vec<(Region, f64)>,
}

/// A method to advance a cloth with, and its settings.
#[derive(Clone, Debug)]
pub enum Method {
    /// [`Provot`](crate::Provot): the tearing rule looks before the limiter does.
    Provot(Limiter),
    /// [`Pbd`].
    Pbd(Pbd),
    /// [`Verlet`](crate::Verlet): the default, exact at rest at every step.
    Verlet,
    /// [`Xpbd`].
    Xpbd(Xpbd),
    /// [`Implicit`](crate::Implicit).
    Implicit(Settings),
}

impl Method {
    /// Provot's model as it stands in scenes that say no more of it.
    #[must_use]
    pub fn provot() -> Method {
        Method::Provot(Limiter::default())
    }

    /// [`Pbd`] as it stands in scenes that say no more of it.
    #[must_use]
    pub fn pbd() -> Method {
        Method::Pbd(Pbd::default())
    }

    /// [`Xpbd`] as it stands in scenes that say no more of it: a step is one sweep, so that tears are
    /// looked for after each.
    #[must_use]
    pub fn xpbd() -> Method {
        Method::Xpbd(Xpbd::new(1, 1))
    }

    /// [`Implicit`](crate::Implicit) as it stands in scenes that say no more of it: it may err by 0.2 mm/s
    /// in a step of 1/240 s.
    #[must_use]
    pub fn implicit() -> Method {
        Method::Implicit(Settings {
            tolerance: Tolerance::Tied(10.0),
            ..Settings::default()
        })
    }
}

/// Wind that may turn to and fro: u(t) = steady + sway · triangle(t / period), where the triangle
/// wave starts at 0, rises, and stays within −1 … 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwayingWind {
    /// The wind without its sway.
    pub steady: Wind,
    /// The largest addition to its velocity, in m/s; zero for none.
    pub sway_m_per_s: Vector,
    /// The seconds from one such addition to the next; positive.
    pub period_s: f64,
}

impl SwayingWind {
    /// The wind after so many seconds.
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> Wind {
        let phase = elapsed_s / self.period_s;
        let phase = phase - phase.floor();
        let triangle = if phase < 0.25 {
            4.0 * phase
        } else if phase < 0.75 {
            2.0 - 4.0 * phase
        } else {
            4.0 * phase - 4.0
        };
        Wind {
            velocity_m_per_s: self.steady.velocity_m_per_s + self.sway_m_per_s * triangle,
            ..self.steady
        }
    }

    /// The first number that would not give a usable wind at all times, beyond those of the steady
    /// wind itself: its field, and the number as given.
    pub(super) fn fault(&self) -> Option<(&'static str, f64)> {
        if !(self.period_s > 0.0 && self.period_s.is_finite()) {
            return Some(("wind.period_s", self.period_s));
        }
        let parts = self.steady.velocity_m_per_s.iter().zip(&self.sway_m_per_s);
        let beyond =
            |(u, sway): &(&f64, &f64)| u.is_finite() && !(u.abs() + sway.abs()).is_finite();
        let mut beyond = parts.filter(beyond);
        Some(("wind.sway_m_per_s", *beyond.next()?.1))
    }

    /// Whether it changes with time.
    #[must_use]
    pub fn sways(&self) -> bool {
        self.sway_m_per_s != Vector::zeros()
    }
}

/// Vertices that are held, and maybe led about.
///
/// Where several hold one vertex, the one that took it last leads it. When that lets go, the one
/// before it holds on: where the vertex then is, or along its own way from there on.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldVertices {
    /// Which ones, by where they are at rest.
    pub region: Region,
    /// When they are taken, in seconds: where they then are.
    pub from_s: f64,
    /// When they are let go; `None` for never.
    pub until_s: Option<f64>,
    /// How they are led: at these seconds of the simulation they are so far from where they
    /// were taken, in metres; straight in between. Ascending in time; empty for not at all.
    pub moves: Vec<(f64, Vector)>,
}

impl HeldVertices {
    /// Vertices that are held where they are, all the time.
    #[must_use]
    pub fn still(region: Region) -> HeldVertices {
        HeldVertices {
            region,
            from_s: 0.0,
            until_s: None,
            moves: Vec::new(),
        }
    }
}

/// A part of a cloth, by where it is at rest.
#[derive(Clone, Debug, PartialEq)]
pub enum Region {
    /// All within a distance, a part of the [`Frame::size_m`], of the vertex nearest to a
    /// place, which is given in parts of width and height. With radius 0 just that vertex.
    Near {
        /// The place.
        at: [f64; 2],
        /// The distance.
        radius: f64,
    },
    /// All between these parts of width and height, bounds included.
    Patch {
        /// From left to right.
        across: [f64; 2],
        /// From bottom to top.
        along: [f64; 2],
    },
    /// All within a box, in metres, bounds included.
    Box {
        /// The corner with the least coordinates.
        from: Point,
        /// The corner with the greatest.
        to: Point,
    },
    /// All within a ball, surface included.
    Ball {
        /// The centre.
        centre: Point,
        /// The radius, in metres.
        radius_m: f64,
    },
    /// These.
    Vertices(Vec<VertexId>),
}

impl Region {
    /// The vertices of faces in the region, ascending; those named one by one as they are named,
    /// where the mesh has them.
    #[must_use]
    pub fn vertices(&self, mesh: &Mesh, points: &[Point], frame: &Frame) -> Vec<VertexId> {
        if let Region::Vertices(named) = self {
            let exists = |v: &&VertexId| v.index() < mesh.vertex_count();
            return named.iter().filter(exists).copied().collect();
        }
        let used = mesh.vertices().filter(|&v| mesh.half_edge_of(v).is_some());
        let at = |v: VertexId| points[v.index()];
        let within = |x: f64, [low, high]: [f64; 2]| low <= x && x <= high;
        match *self {
            Region::Near { at: place, radius } => {
                let away = |v: VertexId| {
                    let [across, along] = frame.parts(at(v));
                    let x = (across - place[0]) * frame.extents_m[0];
                    let y = (along - place[1]) * frame.extents_m[1];
                    x * x + y * y
                };
                let mut nearest: Option<(f64, VertexId)> = None;
                for v in used.clone() {
                    let distance = away(v);
                    if nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, v));
                    }
                }
                let Some((_, centre)) = nearest else {
                    return Vec::new();
                };
                let reach = radius * frame.size_m();
                used.filter(|&v| length(at(v) - at(centre)) <= reach)
                    .collect()
            }
            Region::Patch { across, along } => used
                .filter(|&v| {
                    let parts = frame.parts(at(v));
                    within(parts[0], across) && within(parts[1], along)
                })
                .collect(),
            Region::Box { from, to } => used
                .filter(|&v| (0..3).all(|i| within(at(v)[i], [from[i], to[i]])))
                .collect(),
            Region::Ball { centre, radius_m } => used
                .filter(|&v| length(at(v) - centre) <= radius_m)
                .collect(),
            Region::Vertices(_) => Vec::new(),
        }
    }
}

/// A cut at a time, through the cloth as it is then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedCut {
    /// When, in seconds; at 0 the cloth is at rest.
    pub at_s: f64,
    /// Between which rays.
    pub rays: [Ray; 2],
    /// Whether the whole plane cuts, not only what lies between the rays.
    pub through: bool,
    /// How.
    pub method: tearmesh::CutMethod,
}
