//! The external loads on particles: gravity, drag, wind and colliders.
//!
//! Each exists only where it is named, and costs nothing otherwise; [`Counters`](crate::Counters)
//! prove it.

use std::sync::Arc;

use tearmesh::geometry::{Plane, Point, Vector, cross, dot, length, sine_and_cosine};
use tearmesh::shapes;

use crate::system::body::Body;
use crate::system::error::SettingError;
use crate::system::path::{Pose, RigidMotion};

/// The external loads on the particles. By default there are none.
///
/// ```
/// use tearmesh::Vector;
/// use tearmesh_cloth::Loads;
///
/// let loads = Loads { gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -9.81)), ..Loads::default() };
/// assert!(loads.wind.is_none() && loads.colliders.is_empty());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// The acceleration of gravity, in m/s²; `None` for no gravity.
    pub gravity_m_per_s2: Option<Vector>,
    /// The rate c at which drag slows velocities, in 1/s: the force is −c m v. `None` for no drag.
    pub drag_per_s: Option<f64>,
    /// The wind on the faces; `None` for no wind. A system without faces feels none.
    pub wind: Option<Wind>,
    /// The obstacles that particles cannot enter. Contacts are resolved in the order of this list.
    pub colliders: Vec<Collider>,
}

/// Wind on the faces of a system. It exerts the force c A (n · (u − v)) n on a face of area A and
/// unit normal n that moves at the velocity v (Provot 1995, §3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind {
    /// The velocity u of the air, in m/s.
    pub velocity_m_per_s: Vector,
    /// The coefficient c of the force, in kg/(m² s); zero or more.
    pub coefficient: f64,
}

/// An obstacle that particles cannot enter. A contact removes the velocity towards the obstacle;
/// friction takes some of the velocity along it.
///
/// ```
/// use tearmesh::{Plane, Point, Vector};
/// use tearmesh_cloth::{Collider, Loads};
///
/// let floor = Plane::new(Point::origin(), Vector::y())?;
/// let colliders = vec![Collider::plane(floor).with_friction(0.4)];
/// let loads = Loads { colliders, ..Loads::default() };
/// # Ok::<(), tearmesh::PlaneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// The obstacle itself.
    pub shape: ColliderShape,
    /// Coulomb's coefficient μ of friction; 0 for none. What rests on the obstacle stays where it is
    /// while the force along it is at most μ times the one into it.
    pub friction: f64,
}

/// The shape of a [`Collider`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColliderShape {
    /// The half-space behind a plane, on the side away from its normal.
    Plane(Plane),
    /// A ball.
    Sphere {
        /// The centre of the ball, in metres.
        centre: Point,
        /// The radius of the ball, in metres.
        radius_m: f64,
    },
    /// A body of triangles.
    Body {
        /// The body, shared by all who collide with it.
        body: Arc<Body>,
        /// How far vertices stay from its surface, in metres: at least the [largest
        /// error](Body::error_worst_m) of its grid.
        thickness_m: f64,
        /// How it moves.
        motion: RigidMotion,
    },
}

impl Wind {
    /// Refuses the first number that cannot be used.
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        finite("wind.velocity_m_per_s", self.velocity_m_per_s)?;
        SettingError::unless_at_least_0("wind.coefficient", self.coefficient)
    }
}

/// Refuses the first part of a vector that is not finite.
fn finite(setting: &'static str, v: Vector) -> Result<(), SettingError> {
    let check = |&x: &f64| SettingError::unless(x.is_finite(), setting, x, "finite");
    v.iter().try_for_each(check)
}

impl Loads {
    /// Whether a wind blows that pushes.
    pub(crate) fn blows(&self) -> bool {
        self.wind.is_some_and(|wind| wind.coefficient > 0.0)
    }

    /// Refuses the first number that cannot be used.
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        let gravity = self.gravity_m_per_s2.unwrap_or_default();
        finite("gravity_m_per_s2", gravity)?;
        SettingError::unless_at_least_0("drag_per_s", self.drag_per_s.unwrap_or(0.0))?;
        self.wind.as_ref().map_or(Ok(()), Wind::check)?;
        for collider in &self.colliders {
            SettingError::unless_at_least_0("colliders.friction", collider.friction)?;
            match &collider.shape {
                ColliderShape::Plane(_) => {}
                ColliderShape::Sphere { centre, radius_m } => {
                    finite("colliders.centre", centre.coords)?;
                    SettingError::unless_at_least_0("colliders.radius_m", *radius_m)?;
                }
                ColliderShape::Body {
                    body,
                    thickness_m,
                    motion,
                } => {
                    finite("colliders.motion.about", motion.about.coords)?;
                    let (given, setting) = (*thickness_m, "colliders.thickness_m");
                    let holds = given >= body.error_worst_m() && given.is_finite();
                    let allowed = "at least the largest error of the body's grid";
                    SettingError::unless(holds, setting, given, allowed)?;
                }
            }
        }
        Ok(())
    }
}

impl Wind {
    /// Adds the force on faces, a third to each corner.
    pub(crate) fn press(&self, faces: &[u32], x: &[Point], v: &[Vector], forces: &mut [Vector]) {
        for face in faces.as_chunks::<3>().0 {
            let third = self.force_at_corners(*face, x, v);
            for corner in *face {
                forces[corner as usize] += third;
            }
        }
    }

    /// A third of the force on a face: pressure c n·(u − v), where v is the mean velocity of the corners,
    /// along the normal.
    pub(crate) fn force_at_corners(&self, face: [u32; 3], x: &[Point], v: &[Vector]) -> Vector {
        let [a, b, c] = face.map(|corner| corner as usize);
        // Twice the area along the normal.
        let normal = cross(x[b] - x[a], x[c] - x[a]);
        let double_area = length(normal);
        if double_area <= 0.0 {
            return Vector::zeros();
        }
        let relative = self.velocity_m_per_s - (v[a] + v[b] + v[c]) / 3.0;
        let pressure = self.coefficient * dot(normal, relative) / double_area;
        normal * (pressure / 6.0)
    }
}

impl Collider {
    /// Creates the half-space behind a plane, without friction.
    #[must_use]
    pub fn plane(plane: Plane) -> Collider {
        Collider::of(ColliderShape::Plane(plane))
    }

    /// Creates a ball without friction.
    #[must_use]
    pub fn sphere(centre: Point, radius_m: f64) -> Collider {
        Collider::of(ColliderShape::Sphere { centre, radius_m })
    }

    /// Creates a body without friction that does not move, with a thickness of twice the largest error of its grid.
    #[must_use]
    pub fn body(body: Arc<Body>) -> Collider {
        Collider::of(ColliderShape::Body {
            thickness_m: 2.0 * body.error_worst_m(),
            body,
            motion: RigidMotion::default(),
        })
    }

    /// Returns the collider of this number in words, by the name of its file if it has one.
    #[must_use]
    pub fn text(&self, number: usize) -> String {
        match &self.shape {
            ColliderShape::Plane(_) => format!("the plane of collider {number}"),
            ColliderShape::Sphere { .. } => format!("the ball of collider {number}"),
            ColliderShape::Body { body, .. } => match body.name() {
                Some(name) => format!("the body `{name}`"),
                None => format!("the body of collider {number}"),
            },
        }
    }

    /// Returns the surface of a body or a ball as it was made, to be drawn: its points, and its faces, anticlockwise
    /// as seen from outside. A plane has none.
    #[must_use]
    pub fn surface(&self) -> (Vec<Point>, Vec<[u32; 3]>) {
        match &self.shape {
            ColliderShape::Plane(_) => Default::default(),
            ColliderShape::Sphere { centre, radius_m } => ball(*centre, *radius_m),
            ColliderShape::Body { body, .. } => (body.points().to_vec(), body.faces().to_vec()),
        }
    }

    /// Returns where it is at a time in seconds since the system was created. Only bodies move.
    #[must_use]
    pub fn pose(&self, elapsed_s: f64) -> Pose {
        match &self.shape {
            ColliderShape::Body { motion, .. } => motion.at(elapsed_s),
            _ => RigidMotion::default().at(elapsed_s),
        }
    }

    /// Returns the [skins](Collider::surface) of colliders where they are at a time, as one.
    #[must_use]
    pub fn skins(colliders: &[Collider], elapsed_s: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for collider in colliders {
            let (pose, (surface, sides)) = (collider.pose(elapsed_s), collider.surface());
            let first = points.len() as u32;
            points.extend(surface.into_iter().map(|p| pose.to_world(p)));
            faces.extend(sides.into_iter().map(|side| side.map(|v| first + v)));
        }
        (points, faces)
    }

    pub(crate) fn is_body(&self) -> bool {
        matches!(self.shape, ColliderShape::Body { .. })
    }

    fn of(shape: ColliderShape) -> Collider {
        let friction = 0.0;
        Collider { shape, friction }
    }

    /// Sets Coulomb's coefficient of friction.
    #[must_use]
    pub fn with_friction(self, friction: f64) -> Collider {
        Collider { friction, ..self }
    }
}

impl ColliderShape {
    /// The way out of a plane or a ball: a unit vector, and how deep inside a particle is. A body is none of them.
    pub(crate) fn way_out(&self, x: Point) -> (Vector, f64) {
        match *self {
            ColliderShape::Plane(plane) => (plane.normal(), -plane.distance(x)),
            ColliderShape::Sphere { centre, radius_m } => {
                let d = x - centre;
                let distance = length(d);
                let is_centre = distance <= 0.0;
                let normal = if is_centre { Vector::z() } else { d / distance };
                (normal, radius_m - distance)
            }
            ColliderShape::Body { .. } => (Vector::z(), f64::NEG_INFINITY),
        }
    }
}

/// The rows of a ball between its poles, and the faces around it.
const ROWS: u32 = 14;
const AROUND: u32 = 32;

/// The surface of a ball: a tube that is rounded, and the fans that close it.
fn ball(centre: Point, radius_m: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (tube, rings) = shapes::tube(AROUND, ROWS);
    let rounded = rings.as_slice().iter().map(|p| {
        let part = (p.z * f64::from(ROWS) + 1.0) / f64::from(ROWS + 2);
        let (out, down) = sine_and_cosine(std::f64::consts::PI * part);
        Vector::new(p.x * out, p.y * out, -down)
    });
    let poles = [-Vector::z(), Vector::z()];
    let points = rounded.chain(poles).map(|out| centre + out * radius_m);
    let mut faces = tube.indices().as_chunks().0.to_vec();
    let (last, pole) = (AROUND * ROWS, AROUND * (ROWS + 1));
    for (i, next) in (0..AROUND).map(|i| (i, (i + 1) % AROUND)) {
        faces.extend([[next, i, pole], [last + i, last + next, pole + 1]]);
    }
    (points.collect(), faces)
}
