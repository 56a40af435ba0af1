//! Paths along which particles are led, and rigid motion of bodies: a path, and turns about a point.

use std::sync::Arc;

use tearmesh::geometry::{Point, Vector, check_point, cross, length};
use tearmesh::nalgebra::Matrix3x4;
use tearmesh::{Blend as _, Mix};

use crate::system::bend::sinc_of_root;

/// The path of a grabbed particle: straight from point to point, at rest before the first time and
/// after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Shared by all particles that the path leads.
    curve: Arc<Curve>,
}

#[derive(Debug, PartialEq)]
enum Curve {
    /// When to be where; at least one, ascending.
    Points(Vec<(f64, Point)>),
    /// The path of what a motion carries away from a place.
    Carried(Point, Arc<RigidMotion>),
    /// The path of what stays between others, by their numbers in the list.
    Between(Mix<usize>, Vec<Path>),
}

impl Path {
    /// Creates the path through these points at these times in seconds. Returns `None` unless there
    /// is at least one point, times and the differences between them are finite, times ascend
    /// strictly, and no coordinate is beyond [`COORDINATE_MAX`](tearmesh::COORDINATE_MAX). So
    /// everything that [`Path::at`] returns is finite.
    #[must_use]
    pub fn new(points: impl IntoIterator<Item = (f64, Point)>) -> Option<Path> {
        let points: Vec<_> = points.into_iter().collect();
        let usable = |&(s, p): &(f64, Point)| s.is_finite() && check_point(p).is_ok();
        let between = |pair: &[(f64, Point)]| pair[1].0 - pair[0].0;
        let mut between = points.windows(2).map(between);
        let ascending = between.all(|took_s| took_s > 0.0 && took_s.is_finite());
        let is_usable = !points.is_empty() && ascending && points.iter().all(usable);
        is_usable.then(|| Path::through(points))
    }

    /// Returns the point of the path at `elapsed_s` seconds. It is the first point before the path
    /// begins, and the last one after it ends.
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> Point {
        match &*self.curve {
            Curve::Points(points) => point_at(points, elapsed_s),
            Curve::Carried(from, motion) => motion.at(elapsed_s).to_world(*from),
            Curve::Between(mix, paths) => {
                let place = |end: usize| paths.get(end).map(|path| path.at(elapsed_s));
                let places = [0, 1, 2].map(|end| place(end).unwrap_or_default());
                Point::blend(mix.map(|end| &places[end]))
            }
        }
    }

    /// The path through points that are known to be usable.
    pub(crate) fn through(points: Vec<(f64, Point)>) -> Path {
        let curve = Arc::new(Curve::Points(points));
        Path { curve }
    }

    /// The path of what stays at one place forever.
    pub(crate) fn still(at: Point) -> Path {
        Path::through(vec![(0.0, at)])
    }

    /// The path of what a motion carries along, which was at a place as that was made.
    pub(crate) fn carried(from: Point, motion: Arc<RigidMotion>) -> Path {
        let curve = Arc::new(Curve::Carried(from, motion));
        Path { curve }
    }

    /// The path of what stays between others, which go along these paths, at most three.
    pub(crate) fn between(mix: Mix<usize>, paths: Vec<Path>) -> Path {
        let curve = Arc::new(Curve::Between(mix, paths));
        Path { curve }
    }
}

/// The point of a polyline at a time.
fn point_at(points: &[(f64, Point)], elapsed_s: f64) -> Point {
    let after = points.partition_point(|&(s, _)| s <= elapsed_s);
    if after == 0 || after == points.len() {
        return points[after.saturating_sub(1)].1;
    }
    let ((s, p), (t, q)) = (points[after - 1], points[after]);
    p + (q - p) * ((elapsed_s - s) / (t - s))
}

/// How a body or a hold moves: from where it was made along a path, while it turns about a point.
///
/// ```
/// use tearmesh::Point;
/// use tearmesh_cloth::{Path, RigidMotion};
///
/// // A quarter of a turn about an upright axis through (1, 0, 0) in a second, while all moves up.
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let motion = RigidMotion {
///     moves: Path::new([(0.0, Point::origin()), (1.0, Point::new(0.0, 2.0, 0.0))]),
///     turns: Path::new([(0.0, Point::origin()), (1.0, Point::new(0.0, quarter, 0.0))]),
///     about: Point::new(1.0, 0.0, 0.0),
/// };
/// let corner = motion.at(1.0).to_world(Point::new(2.0, 0.0, 0.0));
/// assert!((corner - Point::new(1.0, 2.0, -1.0)).norm() < 1e-12);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidMotion {
    /// The path of its offset from where it was made, in metres; `None` if it has none.
    pub moves: Option<Path>,
    /// The path of its turn: vectors along the axis as long as the angle in radians, anticlockwise as seen
    /// from their tip. Between two of them it turns straight from one to the other. `None` if it does not turn.
    pub turns: Option<Path>,
    /// The point about which it turns, before its offset.
    pub about: Point,
}

impl RigidMotion {
    /// Returns the place of the body at a time in seconds since the system was created.
    #[must_use]
    pub fn at(&self, elapsed_s: f64) -> Pose {
        let at = |path: &Option<Path>| path.as_ref().map(|path| path.at(elapsed_s).coords);
        let turn = at(&self.turns).unwrap_or_default();
        let (angle, whole) = (length(turn), 2.0 * std::f64::consts::PI);
        let left = angle - whole * (angle / whole).round();
        let turn = if angle > 0.0 {
            turn * (left / angle)
        } else {
            turn
        };
        let half = sinc_of_root(0.25 * (left * left));
        Pose {
            about: self.about,
            offset: at(&self.moves).unwrap_or_default(),
            turn,
            first: sinc_of_root(left * left),
            second: 0.5 * (half * half),
        }
    }

    pub(crate) fn is_still(&self) -> bool {
        self.moves.is_none() && self.turns.is_none()
    }
}

/// The place of a body.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    about: Point,
    offset: Vector,
    /// The angle along the axis; and by Rodrigues' formula the coefficients of its cross products: sin θ / θ and
    /// (1 − cos θ) / θ².
    turn: Vector,
    first: f64,
    second: f64,
}

impl Pose {
    /// Returns where a point of the body is, as it was made.
    #[must_use]
    pub fn to_world(&self, p: Point) -> Point {
        self.about + self.offset + self.turned(p - self.about)
    }

    /// Returns the same as a matrix: its first three columns turn a point, and the last is added to that.
    #[must_use]
    pub fn matrix(&self) -> Matrix3x4<f64> {
        let [x, y, z] = [Vector::x(), Vector::y(), Vector::z()].map(|axis| self.turned(axis));
        Matrix3x4::from_columns(&[x, y, z, self.to_world(Point::origin()).coords])
    }

    /// Returns the point of the body, as it was made, that is at a place.
    #[must_use]
    pub fn to_body(&self, x: Point) -> Point {
        let back = Pose {
            turn: -self.turn,
            ..*self
        };
        self.about + back.turned(x - self.about - self.offset)
    }

    pub(crate) fn turned(&self, v: Vector) -> Vector {
        let across = cross(self.turn, v);
        v + across * self.first + cross(self.turn, across) * self.second
    }
}
