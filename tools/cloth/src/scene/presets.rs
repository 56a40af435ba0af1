//! The built-in scenes, which are sized to the mesh that they are given.

use tearmesh::geometry::{Ray, Vector};

use super::frame::{Axis, Frame};
use super::{HeldVertices, Region, Scene, SwayingWind, TimedCut};
use crate::cloth::fabric::Fabric;
use crate::cloth::tearing::{Tearing, Threshold};
use crate::method::Method;
use crate::system::load::Wind;

/// A built-in scene, for a mesh with a frame.
pub type Preset = fn(&Frame) -> Scene;

impl Scene {
    /// The magnitude of gravity in the built-in scenes except [`Scene::trouser`], in m/s².
    pub const GRAVITY_M_PER_S2: f64 = 9.81;
    /// The ratio of length to rest length at which an edge tears in built-in scenes with tearing.
    pub const STRETCH_RATIO: f64 = 1.5;

    /// The coefficient of friction of an obstacle for which a scene file gives none: that of cotton on most things.
    pub const FRICTION: f64 = 0.3;

    /// The built-in scenes by their names, each for a mesh with a frame.
    pub const PRESETS: [(&str, Preset); 5] = [
        ("hang", Scene::hang),
        ("flag", Scene::flag),
        ("rip", Scene::rip),
        ("trouser", Scene::trouser),
        ("fall", |frame| Scene::fall(frame.up)),
    ];

    /// Returns a scene in which nothing holds the cloth: it falls for two seconds, and can tear.
    pub fn fall(up: Axis) -> Scene {
        Scene {
            duration_s: 2.0,
            solver: Method::Verlet,
            step_s: None,
            fabric: Fabric::default(),
            areal_density_kg_per_m2: 0.15, // Of shirt cotton.
            gravity_m_per_s2: up.vector() * -Scene::GRAVITY_M_PER_S2,
            drag_per_s: 0.5,
            wind: None,
            colliders: Vec::new(),
            holds: Vec::new(),
            rest: Vec::new(),
            ripple_m: None,
            seams: Vec::new(),
            unpicks: Vec::new(),
            cuts: Vec::new(),
            tearing: Some(Tearing::new(Threshold::Stretch(Scene::STRETCH_RATIO))),
            strengths: Vec::new(),
        }
    }

    /// Returns a scene in which a sheet hangs by its two upper corners. Each is clamped over a
    /// patch of a tenth of the sheet, because the strain at a single pinned vertex would grow as
    /// the mesh gets finer.
    pub fn hang(frame: &Frame) -> Scene {
        let corner = |across: f64| {
            HeldVertices::still(Region::Near {
                at: [across, 1.0],
                radius: 0.1,
            })
        };
        Scene {
            holds: vec![corner(0.0), corner(1.0)],
            ..Scene::fall(frame.up)
        }
    }

    /// Returns the scene of a flag: the left edge is held, wind blows across and sways, and after a
    /// second and a half the flag is cut in two (Souza et al. 2014, Figure 4). It does not tear by
    /// itself.
    pub fn flag(frame: &Frame) -> Scene {
        let [width, ..] = frame.extents_m;
        let across = frame.across.vector();
        let depth = frame.depth.vector();
        Scene {
            duration_s: 3.0,
            wind: Some(SwayingWind {
                sway_m_per_s: depth * 4.0,
                period_s: 0.4 * width.max(0.1),
                ..SwayingWind::steady(Wind {
                    velocity_m_per_s: across * 6.0,
                    coefficient: 1.5,
                })
            }),
            holds: vec![HeldVertices::still(Region::Patch {
                across: [0.0, 0.02],
                along: [0.0, 1.0],
            })],
            // Down the whole plane, three fifths of the way from the pole.
            cuts: slit(frame, 0.6, [1.5, -0.5], |cut| TimedCut {
                at_s: 1.5,
                through: true,
                ..cut
            }),
            tearing: None,
            ..Scene::fall(frame.up)
        }
    }

    /// Returns a scene in which a hanging patch is ripped: one vertex in its middle is grabbed
    /// after half a second and dragged downward (Souza et al. 2014, Figure 6).
    ///
    /// The patch hangs by its upper edge. The strain around a single pulled vertex grows as the
    /// mesh gets finer, but a hand does not pull at a point. So the cloth within the grip is eight
    /// times as strong, and twice that at half the distance, and tears elsewhere (tried up to 160
    /// cells per side). Drag is that of a light cloth in air. Without it, loose pieces would fly
    /// away at some 10 m/s, the speed that the energy of torn edges gives them.
    pub fn rip(frame: &Frame) -> Scene {
        let down = frame.along.vector() * -frame.extents_m[1];
        let grip = |radius: f64| Region::Near {
            at: [0.5, 0.5],
            radius,
        };
        let edge = Region::Patch {
            across: [0.0, 1.0],
            along: [0.97, 1.0],
        };
        let grab = HeldVertices {
            from_s: 0.5,
            moves: vec![(0.5, Vector::zeros()), (2.5, down * 1.5)],
            ..HeldVertices::still(grip(0.0))
        };
        let rings = [1.0, 2.0, 4.0, 8.0, 16.0];
        Scene {
            duration_s: 3.0,
            drag_per_s: 5.0,
            holds: vec![HeldVertices::still(edge), grab],
            strengths: rings
                .map(|nearer| (grip(0.12 / nearer), 8.0 * nearer))
                .to_vec(),
            ..Scene::fall(frame.up)
        }
    }

    /// Returns a trouser test: a strip is slit from the middle of its lower edge to its centre, and
    /// the ends of the two legs are pulled apart, toward the viewer and away. There is no gravity.
    /// The sum of the forces at the clamps is the force that tears.
    pub fn trouser(frame: &Frame) -> Scene {
        let height = frame.extents_m[1];
        let depth = frame.depth.vector();
        let leg = |across: [f64; 2], side: f64| HeldVertices {
            moves: vec![
                (0.0, Vector::zeros()),
                (TROUSER_S, depth * (side * 1.05 * height)),
            ],
            ..HeldVertices::still(Region::Patch {
                across,
                along: [0.0, 0.05],
            })
        };
        Scene {
            duration_s: TROUSER_S,
            gravity_m_per_s2: Vector::zeros(),
            drag_per_s: 5.0,
            holds: vec![leg([0.0, 0.45], 1.0), leg([0.55, 1.0], -1.0)],
            cuts: slit(frame, 0.5, [-0.5, 0.5], |cut| cut),
            ..Scene::fall(frame.up)
        }
    }
}

/// The duration of a trouser test, in seconds.
const TROUSER_S: f64 = 4.0;

/// A cut straight along the height of a cloth at a fraction of its width, at the beginning and no farther than
/// these fractions of its height, unless changed; none of a cloth without extent.
fn slit(
    frame: &Frame,
    across: f64,
    along: [f64; 2],
    change: fn(TimedCut) -> TimedCut,
) -> Vec<TimedCut> {
    let depth = frame.depth.vector();
    let ray = |along: f64| {
        let origin = frame.point([across, along, 0.0]) + depth * frame.size_m();
        Ray::new(origin, -depth).ok()
    };
    let [from, to] = along.map(ray);
    let cut = |rays: (Ray, Ray)| TimedCut {
        at_s: 0.0,
        rays: rays.into(),
        through: false,
        method: tearmesh::CutMethod::Exact,
    };
    from.zip(to).map(cut).map(change).into_iter().collect()
}
