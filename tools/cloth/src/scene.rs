//! Scenes: holds, paths, wind, cuts and their times.
//!
//! A [`Scene`] is the plan of a simulation, and a [`Run`] carries it out. Four scenes are built in,
//! and are sized to the mesh: [`Scene::hang`], [`Scene::flag`], [`Scene::rip`] and
//! [`Scene::trouser`]. A program fills in a scene's fields from any source. With the feature `serde`,
//! the module `file` has scenes as people write them in files.

#[cfg(feature = "serde")]
pub mod file;
mod frame;
mod opening;
mod presets;
mod rest;
mod run;
mod tear_log;
mod warning;
mod warnings;

pub use frame::{Axis, Frame};
pub use opening::Opening;
pub use presets::Preset;
pub use rest::{TextureError, TextureFault, rest_from_texture};
pub use run::error::RunError;
pub use run::{Run, RunTally};
pub use tear_log::{HoldForces, TearEvent, TearLog};
pub use warning::{Warning, Wording};

use tearmesh::geometry::{Point, Ray, Vector, length};
use tearmesh::{Mesh, Scissor, ScissorError, VertexId};

use crate::cloth::fabric::Fabric;
use crate::cloth::seam::Seam;
use crate::cloth::tearing::Tearing;
use crate::method::Method;
use crate::system::error::SettingError;
use crate::system::load::{Collider, Loads, Wind};

/// The plan of a simulation: the fabric, the method, and the timed events.
#[must_use]
#[derive(Clone, Debug)]
pub struct Scene {
    /// The duration of the scene, in seconds.
    pub duration_s: f64,
    /// The method that advances the cloth.
    pub solver: Method,
    /// The time step in seconds; `None` for a step that suits the method, the fabric and the mesh:
    /// see [`Run::step_s`](Run::step_s).
    pub step_s: Option<f64>,
    /// The material of the cloth.
    pub fabric: Fabric,
    /// The mass of the cloth per area, in kg/m².
    pub areal_density_kg_per_m2: f64,
    /// The acceleration of gravity, in m/s².
    pub gravity_m_per_s2: Vector,
    /// The rate at which drag slows velocities, in 1/s; 0 for no drag.
    pub drag_per_s: f64,
    /// The wind; `None` for no wind.
    pub wind: Option<SwayingWind>,
    /// The obstacles that the cloth cannot enter.
    pub colliders: Vec<Collider>,
    /// The vertices that are held or led.
    pub holds: Vec<HeldVertices>,
    /// The rest shape of faces: a place in metres for each corner, face by face. Empty for where they are.
    pub rest: Vec<Point>,
    /// The amplitude in metres of the [ripple](crate::SimulationDef::ripple_m) of a flat cloth; 0 for none, and `None` for
    /// a millionth of its size.
    pub ripple_m: Option<f64>,
    /// The seams of a garment, whose panels are the mesh. They are sewn from the beginning.
    pub seams: Vec<Seam>,
    /// The times in seconds at which seams are unpicked, and their names.
    pub unpicks: Vec<(f64, String)>,
    /// The cuts, in ascending order of their times.
    pub cuts: Vec<TimedCut>,
    /// The rule by which edges tear; `None` if they never tear by themselves.
    pub tearing: Option<Tearing>,
    /// Regions with a strength, as a multiple of the tearing threshold. The strength is 1
    /// elsewhere. If regions overlap, the last one counts.
    pub strengths: Vec<(Region, f64)>,
}

impl Scene {
    /// Returns the loads with which the scene begins; but a wind that begins later blows already, since the step has
    /// to suit it.
    #[must_use]
    pub fn loads(&self) -> Loads {
        Loads {
            gravity_m_per_s2: Some(self.gravity_m_per_s2)
                .filter(|gravity| *gravity != Vector::zeros()),
            drag_per_s: Some(self.drag_per_s).filter(|drag| *drag != 0.0),
            wind: self.wind.map(|wind| wind.at(wind.from_s)),
            colliders: self.colliders.clone(),
        }
    }

    /// Gives every vertex that a region or a seam names another id.
    pub fn rename_vertices(&mut self, mut name: impl FnMut(VertexId) -> VertexId) {
        let holds = self.holds.iter_mut().map(|hold| &mut hold.region);
        let strengths = self.strengths.iter_mut().map(|(region, _)| region);
        let named = holds.chain(strengths).filter_map(|region| match region {
            Region::Vertices(named) => Some(named),
            _ => None,
        });
        let sides = self.seams.iter_mut();
        let sides = sides.flat_map(|seam| [&mut seam.one, &mut seam.other]);
        for vertex in named.chain(sides).flatten() {
            *vertex = name(*vertex);
        }
    }
}

/// Wind that begins at a time, and whose velocity may sway: u(t) = steady + sway · triangle((t − from) / period).
/// The triangle wave starts at 0, rises, and stays within −1 … 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwayingWind {
    /// The wind without its sway.
    pub steady: Wind,
    /// The time in seconds at which the wind begins. Before, air exerts no force.
    pub from_s: f64,
    /// The largest velocity that the sway adds to the steady wind, in m/s; zero for no sway.
    pub sway_m_per_s: Vector,
    /// The period of the sway, in seconds; positive.
    pub period_s: f64,
}

impl SwayingWind {
    /// Creates a wind that blows from the beginning and does not sway.
    #[must_use]
    pub fn steady(wind: Wind) -> SwayingWind {
        SwayingWind {
            steady: wind,
            from_s: 0.0,
            sway_m_per_s: Vector::zeros(),
            period_s: 1.0,
        }
    }

    /// Returns whether the wind is the same at all times.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.from_s == 0.0 && self.sway_m_per_s == Vector::zeros()
    }

    /// Returns the wind at `elapsed_s` seconds.
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> Wind {
        if elapsed_s < self.from_s {
            return Wind {
                coefficient: 0.0,
                ..self.steady
            };
        }
        let phase = (elapsed_s - self.from_s) / self.period_s;
        let triangle = match phase - phase.floor() {
            phase if phase < 0.25 => 4.0 * phase,
            phase if phase < 0.75 => 2.0 - 4.0 * phase,
            phase => 4.0 * phase - 4.0,
        };
        Wind {
            velocity_m_per_s: self.steady.velocity_m_per_s + self.sway_m_per_s * triangle,
            ..self.steady
        }
    }

    /// Refuses the first number that would not give a usable wind at all times.
    pub(super) fn check(&self) -> Result<(), SettingError> {
        self.steady.check()?;
        SettingError::unless_at_least_0("wind.from_s", self.from_s)?;
        SettingError::unless_above_0("wind.period_s", self.period_s)?;
        let mut parts = self.steady.velocity_m_per_s.iter().zip(&self.sway_m_per_s);
        parts.try_for_each(|(u, &sway)| {
            let holds = (u.abs() + sway.abs()).is_finite();
            let allowed = "such that it is finite at all times";
            SettingError::unless(holds, "wind.sway_m_per_s", sway, allowed)
        })
    }
}

/// A region of vertices that are held in place, or led along a path.
///
/// If several holds contain the same vertex, the hold that took it last leads it. When that hold
/// releases it, the previous one takes over: it holds the vertex where it then is, or leads it
/// along its own path from there.
///
/// What a cut inserts on an edge with both ends in a hold is held too, and stays between them until the hold ends.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldVertices {
    /// The vertices that are held, selected by their positions at rest.
    pub region: Region,
    /// The time in seconds at which the vertices are taken, at their positions of that time.
    pub from_s: f64,
    /// The time, in seconds, at which the vertices are released; `None` for never.
    pub until_s: Option<f64>,
    /// The path along which the vertices are led: pairs of a time in seconds since the beginning of
    /// the scene and an offset in metres from where a vertex was taken. Motion is straight between
    /// them. Times must ascend. Empty for vertices that are only held.
    pub moves: Vec<(f64, Vector)>,
    /// How the vertices turn [about](HeldVertices::about) a point on their way: pairs of a time and a vector along the
    /// axis that is as long as the angle in radians, anticlockwise as seen from its tip. Times must ascend. Empty for
    /// vertices that do not turn.
    pub turns: Vec<(f64, Vector)>,
    /// The point about which the vertices turn, in metres, before the offset of their path.
    pub about: Point,
    /// The distance over the cloth at rest, in metres, up to which the cloth around the vertices is stronger throughout the scene:
    /// eight times there, and more the nearer it is, as in a hand. `None` for a cloth that is not gripped, of which a
    /// hold that is small tears out what it holds.
    pub grip_m: Option<f64>,
}

impl HeldVertices {
    /// Returns a hold that keeps the vertices of a region where they are for the whole scene.
    #[must_use]
    pub fn still(region: Region) -> HeldVertices {
        HeldVertices {
            region,
            from_s: 0.0,
            until_s: None,
            moves: Vec::new(),
            turns: Vec::new(),
            about: Point::origin(),
            grip_m: None,
        }
    }

    /// Returns whether the vertices are led, and not only held.
    #[must_use]
    pub fn leads(&self) -> bool {
        !self.moves.is_empty() || !self.turns.is_empty()
    }
}

/// A part of a cloth, selected by positions at rest or by ids.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Region {
    /// The vertices within a radius of the vertex that is nearest to a place. With radius 0 it is
    /// just that vertex.
    Near {
        /// The place, in fractions of width and height, from the bottom left corner.
        at: [f64; 2],
        /// The radius, as a fraction of the longer of width and height.
        radius: f64,
    },
    /// The vertices between these fractions of width and height, bounds included.
    Patch {
        /// The range of fractions of the width, from left to right.
        across: [f64; 2],
        /// The range of fractions of the height, from bottom to top.
        along: [f64; 2],
    },
    /// The vertices within a box along the coordinate axes, bounds included.
    Box {
        /// The corner with the smallest coordinates, in metres.
        from: Point,
        /// The corner with the largest coordinates, in metres.
        to: Point,
    },
    /// The vertices within a ball, surface included.
    Ball {
        /// The centre of the ball, in metres.
        centre: Point,
        /// The radius of the ball, in metres.
        radius_m: f64,
    },
    /// The vertices with these ids.
    Vertices(Vec<VertexId>),
}

impl Region {
    /// Returns the vertices in the region that belong to a face, in ascending order. `points` are
    /// the positions of all vertices. For [`Region::Vertices`] the result is the listed vertices in
    /// the order of the list, without those that the mesh does not have.
    #[must_use]
    pub fn vertices(&self, mesh: &Mesh, points: &[Point], frame: &Frame) -> Vec<VertexId> {
        let used = mesh.vertices().filter(|&v| mesh.half_edge_of(v).is_some());
        let at = |v: &VertexId| points[v.index()];
        let within = |x: f64, [low, high]: [f64; 2]| low <= x && x <= high;
        let is_in: Box<dyn Fn(Point) -> bool> = match self {
            Region::Near { at: place, radius } => {
                let away = |v: &VertexId| {
                    let [across, along] = frame.parts(at(v));
                    let x = (across - place[0]) * frame.extents_m[0];
                    let y = (along - place[1]) * frame.extents_m[1];
                    x * x + y * y
                };
                // Of those that are as near the first one counts.
                let nearest = used.clone().min_by(|a, b| away(a).total_cmp(&away(b)));
                let (nearest, reach) = (nearest.map(|v| at(&v)), radius * frame.size_m());
                Box::new(move |x| nearest.is_some_and(|nearest| length(x - nearest) <= reach))
            }
            Region::Patch { across, along } => Box::new(move |x| {
                let [x, y] = frame.parts(x);
                within(x, *across) && within(y, *along)
            }),
            Region::Box { from, to } => {
                Box::new(move |x| (0..3).all(|i| within(x[i], [from[i], to[i]])))
            }
            Region::Ball { centre, radius_m } => Box::new(move |x| length(x - centre) <= *radius_m),
            Region::Vertices(named) => {
                let exists = |v: &&VertexId| v.index() < mesh.vertex_count();
                return named.iter().filter(exists).copied().collect();
            }
        };
        used.filter(|v| is_in(at(v))).collect()
    }
}

/// A cut at a given time, through the cloth as it is then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedCut {
    /// The time of the cut, in seconds. At 0 the cloth is at rest.
    pub at_s: f64,
    /// The two rays between which the cloth is cut.
    pub rays: [Ray; 2],
    /// Whether the cut extends along the whole plane of the rays, not only between them.
    pub through: bool,
    /// The method by which the mesh is cut.
    pub method: tearmesh::CutMethod,
}

impl TimedCut {
    /// The scissor that makes the cut; an error if the rays span no plane.
    pub(crate) fn scissor(&self) -> Result<Scissor, ScissorError> {
        let scissor = Scissor::new(self.rays[0], self.rays[1])?;
        Ok(scissor.with_through(self.through))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wind_sways_as_a_triangle() {
        let wind = SwayingWind {
            sway_m_per_s: Vector::new(0.0, 0.0, 2.0),
            period_s: 4.0,
            ..SwayingWind::steady(Wind {
                velocity_m_per_s: Vector::new(5.0, 0.0, 0.0),
                coefficient: 1.0,
            })
        };
        for (at_s, sway) in [
            (0.0, 0.0),
            (0.5, 1.0),
            (1.0, 2.0),
            (2.0, 0.0),
            (3.0, -2.0),
            (3.5, -1.0),
            (4.0, 0.0),
            (5.0, 2.0),
        ] {
            let wind = wind.at(at_s).velocity_m_per_s;
            assert_eq!(wind, Vector::new(5.0, 0.0, sway), "{at_s}");
        }
    }
}
