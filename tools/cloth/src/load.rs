//! The external loads on particles: gravity, drag, wind and colliders.
//!
//! Each exists only where it is named, and costs nothing otherwise; [`Counters`](crate::Counters)
//! prove it.

use std::sync::Arc;

use tearmesh::geometry::{Plane, Point, Vector, check_point, cross, dot, length};

use crate::system::error::SettingError;

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

/// An obstacle that particles cannot enter. A contact removes the velocity towards the obstacle,
/// and has no friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Collider {
    /// The half-space behind a plane, on the side away from its normal.
    Plane(Plane),
    /// A ball.
    Sphere {
        /// The centre of the ball, in metres.
        centre: Point,
        /// The radius of the ball, in metres.
        radius_m: f64,
    },
}

impl Loads {
    /// Refuses the first number that cannot be used.
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        let finite = |setting, v: Vector| {
            let check = |&x: &f64| SettingError::unless(x.is_finite(), setting, x, "finite");
            v.iter().try_for_each(check)
        };
        let gravity = self.gravity_m_per_s2.unwrap_or_default();
        finite("gravity_m_per_s2", gravity)?;
        SettingError::unless_positive("drag_per_s", self.drag_per_s.unwrap_or(0.0))?;
        if let Some(wind) = self.wind {
            finite("wind.velocity_m_per_s", wind.velocity_m_per_s)?;
            SettingError::unless_positive("wind.coefficient", wind.coefficient)?;
        }
        for collider in &self.colliders {
            if let Collider::Sphere { centre, radius_m } = *collider {
                finite("colliders.centre", centre.coords)?;
                SettingError::unless_positive("colliders.radius_m", radius_m)?;
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
    /// Where a particle inside comes out, and its velocity then; `None` for one outside.
    pub(crate) fn pushed(&self, x: Point, v: Vector) -> Option<(Point, Vector)> {
        // The way out: a unit vector, and how far.
        let (normal, depth) = match *self {
            Collider::Plane(plane) => (plane.normal(), -plane.distance(x)),
            Collider::Sphere { centre, radius_m } => {
                let d = x - centre;
                let distance = length(d);
                let is_centre = distance <= 0.0;
                let normal = if is_centre { Vector::z() } else { d / distance };
                (normal, radius_m - distance)
            }
        };
        let into = dot(normal, v).min(0.0);
        (depth > 0.0).then(|| (x + normal * depth, v - normal * into))
    }
}

/// The path of a grabbed particle: straight from point to point, at rest before the first time and
/// after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// When to be where; at least one, ascending. Shared by all particles that the path leads.
    pub(crate) points: Arc<[(f64, Point)]>,
}

impl Path {
    /// Creates the path through these points at these times in seconds. Returns `None` unless there
    /// is at least one point, times and the differences between them are finite, times ascend
    /// strictly, and no coordinate is beyond [`COORDINATE_MAX`](tearmesh::COORDINATE_MAX). So
    /// everything that [`Path::at`] returns is finite.
    #[must_use]
    pub fn new(points: impl IntoIterator<Item = (f64, Point)>) -> Option<Path> {
        let points: Arc<[_]> = points.into_iter().collect();
        let usable = |&(s, p): &(f64, Point)| s.is_finite() && check_point(p).is_ok();
        let between = |pair: &[(f64, Point)]| pair[1].0 - pair[0].0;
        let mut between = points.windows(2).map(between);
        let ascending = between.all(|took_s| took_s > 0.0 && took_s.is_finite());
        (!points.is_empty() && ascending && points.iter().all(usable)).then_some(Path { points })
    }

    /// Returns the point of the path at `elapsed_s` seconds. It is the first point before the path
    /// begins, and the last one after it ends.
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> Point {
        let after = self.points.partition_point(|&(s, _)| s <= elapsed_s);
        if after == 0 || after == self.points.len() {
            return self.points[after.saturating_sub(1)].1;
        }
        let ((s, p), (t, q)) = (self.points[after - 1], self.points[after]);
        p + (q - p) * ((elapsed_s - s) / (t - s))
    }
}
