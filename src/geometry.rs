//! Points, planes and rays, the rule for points on a plane, and arithmetic that gives the same bits
//! on every machine.
//!
//! The types are re-exported at the root of the crate. The functions are for programs that need the
//! same reproducible results as this crate: each uses only `+ − × ÷ √`, in the documented order,
//! whereas a linear algebra library may sum in any order. There is no hidden epsilon.
//!
//! ```
//! use tearmesh::geometry::{Point, Vector, between, cross, dot, length};
//!
//! let (p, q) = (Point::new(1.0, 0.0, 0.0), Point::new(1.0, 4.0, 3.0));
//! assert_eq!(length(q - p), 5.0);
//! assert_eq!(between(p, q, 0.5), Point::new(1.0, 2.0, 1.5));
//! assert_eq!(dot(cross(Vector::x(), q - p), q - p), 0.0);
//! ```

// The one file that names nalgebra's types.

use std::fmt;

use crate::exact::{ROUNDING, exponent_above, power_of_two};

/// A point in space, in the units of the model.
pub type Point = nalgebra::Point3<f64>;

/// A direction, or the difference of two points.
pub type Vector = nalgebra::Vector3<f64>;

/// The largest absolute value of a coordinate that this library accepts: 2^250, about 1.8e75.
///
/// Up to this size the square of an area is a finite `f64`, so no operation of this library can
/// overflow.
pub const COORDINATE_MAX: f64 = f64::from_bits((250 + 1023) << 52);

/// The side of a plane on which a face or a point lies.
///
/// A distance of zero counts as `Front`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// On the plane, or on the side to which the normal points.
    Front,
    /// Strictly on the side away from the normal.
    Back,
}

impl Side {
    /// Returns the side for a signed distance or a sum of signed distances: `Back` if it is
    /// negative, and otherwise `Front`, also for NaN.
    #[inline]
    #[must_use]
    pub fn of(offset: f64) -> Side {
        if offset < 0.0 {
            Side::Back
        } else {
            Side::Front
        }
    }
}

/// A plane, given by a point on it and a normal.
///
/// ```
/// use tearmesh::{Plane, Point, Vector};
///
/// let plane = Plane::new(Point::new(1.0, 0.0, 0.0), Vector::new(2.0, 0.0, 0.0))?;
/// assert_eq!(plane.distance(Point::new(4.0, 9.0, 9.0)), 3.0);
/// # Ok::<(), tearmesh::PlaneError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "(Point, Vector)"))]
#[cfg_attr(feature = "serde", serde(into = "(Point, Vector)"))]
pub struct Plane {
    point: Point,
    /// The given normal, scaled by a power of two: exact, so that points that lie
    /// on the plane in exact arithmetic on small numbers have offset zero.
    normal: Vector,
    length: f64,
}

impl Plane {
    /// Creates the plane through `point` with the given normal, which need not be a unit vector.
    ///
    /// # Errors
    ///
    /// [`PlaneError`] if a coordinate is not finite, a coordinate of the point exceeds
    /// [`COORDINATE_MAX`] in absolute value, or the normal is zero.
    pub fn new(point: Point, normal: Vector) -> Result<Plane, PlaneError> {
        check_point(point).map_err(|_| PlaneError::Point { given: point })?;
        let normal = scaled(normal).ok_or(PlaneError::Normal { given: normal })?;
        Ok(Plane {
            point,
            normal,
            length: length(normal),
        })
    }

    /// Returns the point from which the plane was created.
    #[must_use]
    pub fn point(&self) -> Point {
        self.point
    }

    /// Returns the normal as a unit vector.
    #[must_use]
    pub fn normal(&self) -> Vector {
        self.normal / self.length
    }

    /// The given normal, scaled by a power of two: a plane made of it is this one.
    pub(crate) fn scaled_normal(&self) -> Vector {
        self.normal
    }

    /// Returns a number that is positive, zero or negative like the signed distance of `p` from the
    /// plane. It is n · (p − o), where o is the point of the plane and n is the normal scaled by a
    /// power of two rather than to unit length.
    ///
    /// The number has one rounding fewer than [`Plane::distance`], so every decision about a side uses it.
    #[inline]
    #[must_use]
    pub fn offset(&self, p: Point) -> f64 {
        dot(self.normal, p - self.point)
    }

    /// Returns the signed distance of a point from the plane. It is positive on the side to which
    /// the normal points.
    #[inline]
    #[must_use]
    pub fn distance(&self, p: Point) -> f64 {
        self.offset(p) / self.length
    }

    /// How large an offset is for each unit of distance.
    pub(crate) fn offset_of_unit(&self) -> f64 {
        self.length
    }

    /// The parallel plane through another point, which has to be usable.
    pub(crate) fn through(&self, point: Point) -> Plane {
        debug_assert!(check_point(point).is_ok());
        Plane { point, ..*self }
    }
}

/// The reason why a plane was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PlaneError {
    /// A coordinate of the point is not finite, or exceeds [`COORDINATE_MAX`] in absolute value.
    Point {
        /// The point that was given.
        given: Point,
    },
    /// The normal is zero, or one of its coordinates is not finite.
    Normal {
        /// The normal that was given.
        given: Vector,
    },
}

impl fmt::Display for PlaneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlaneError::Point { given } => refused(f, "point", given.coords, "plane is not usable"),
            PlaneError::Normal { given } => {
                refused(f, "normal", *given, "plane is zero or not finite")
            }
        }
    }
}

impl std::error::Error for PlaneError {}

impl TryFrom<(Point, Vector)> for Plane {
    type Error = PlaneError;

    fn try_from((point, normal): (Point, Vector)) -> Result<Plane, PlaneError> {
        Plane::new(point, normal)
    }
}

impl From<Plane> for (Point, Vector) {
    fn from(plane: Plane) -> (Point, Vector) {
        (plane.point, plane.normal)
    }
}

/// A ray: an origin and a direction, which need not be a unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "(Point, Vector)"))]
#[cfg_attr(feature = "serde", serde(into = "(Point, Vector)"))]
pub struct Ray {
    origin: Point,
    direction: Vector,
}

impl Ray {
    /// Creates the ray from `origin` along `direction`.
    ///
    /// # Errors
    ///
    /// [`RayError`] if a coordinate is not finite, a coordinate of the origin exceeds
    /// [`COORDINATE_MAX`] in absolute value, or the direction is zero.
    pub fn new(origin: Point, direction: Vector) -> Result<Ray, RayError> {
        check_point(origin).map_err(|_| RayError::Origin { given: origin })?;
        scaled(direction).ok_or(RayError::Direction { given: direction })?;
        Ok(Ray { origin, direction })
    }

    /// Returns the point at which the ray starts.
    #[must_use]
    pub fn origin(&self) -> Point {
        self.origin
    }

    /// Returns the direction that was given, which need not be a unit vector.
    #[must_use]
    pub fn direction(&self) -> Vector {
        self.direction
    }

    /// Returns whether another ray lies on the line of this one and has the same direction, up to rounding: whether
    /// both are one ray, written in two ways.
    ///
    /// ```
    /// use tearmesh::{Point, Ray, Vector};
    ///
    /// let down = |z: f64, length: f64| {
    ///     Ray::new(Point::new(0.2, 0.3, z), Vector::new(0.0, 0.0, -length))
    /// };
    /// assert!(down(1.0, 1.0)?.is_along(&down(2.0, 5.0)?));
    /// assert!(!down(1.0, 1.0)?.is_along(&down(1.0, -1.0)?));
    /// # Ok::<(), tearmesh::RayError>(())
    /// ```
    #[must_use]
    pub fn is_along(&self, other: &Ray) -> bool {
        let directions = scaled(self.direction).zip(scaled(other.direction));
        let Some((along, other_along)) = directions else {
            return false;
        };
        let apart = other.origin - self.origin;
        let reach = max_abs(self.origin.coords).max(max_abs(other.origin.coords));
        dot(along, other_along) > 0.0
            && max_abs(cross(along, other_along)) <= ROUNDING
            && max_abs(cross(apart, along)) <= ROUNDING * reach
    }
}

impl TryFrom<(Point, Vector)> for Ray {
    type Error = RayError;

    fn try_from((origin, direction): (Point, Vector)) -> Result<Ray, RayError> {
        Ray::new(origin, direction)
    }
}

impl From<Ray> for (Point, Vector) {
    fn from(ray: Ray) -> (Point, Vector) {
        (ray.origin, ray.direction)
    }
}

/// The reason why a ray was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RayError {
    /// A coordinate of the origin is not finite, or exceeds [`COORDINATE_MAX`] in absolute value.
    Origin {
        /// The origin that was given.
        given: Point,
    },
    /// The direction is zero, or one of its coordinates is not finite.
    Direction {
        /// The direction that was given.
        given: Vector,
    },
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RayError::Origin { given } => refused(f, "origin", given.coords, "ray is not usable"),
            RayError::Direction { given } => {
                refused(f, "direction", *given, "ray is zero or not finite")
            }
        }
    }
}

impl std::error::Error for RayError {}

fn refused(f: &mut fmt::Formatter<'_>, part: &str, v: Vector, of: &str) -> fmt::Result {
    write!(f, "the {part} ({}, {}, {}) of a {of}", v.x, v.y, v.z)
}

/// Checks that every coordinate of a point is finite and at most [`COORDINATE_MAX`] in absolute
/// value.
///
/// # Errors
///
/// The first coordinate, in the order x, y, z, that fails the check.
pub fn check_point(p: Point) -> Result<(), f64> {
    let is_bad = |x: &&f64| !x.is_finite() || x.abs() > COORDINATE_MAX;
    p.coords.iter().find(is_bad).map_or(Ok(()), |&bad| Err(bad))
}

/// The vector times the power of two that brings its largest component into
/// ½ … 1; `None` for a vector that is zero or not finite. Exact, unless another
/// component is 2^1000 times smaller.
pub(crate) fn scaled(v: Vector) -> Option<Vector> {
    let largest = max_abs(v);
    if v.iter().any(|x| !x.is_finite()) || largest == 0.0 {
        return None;
    }
    let exponent = -exponent_above(largest);
    // Two steps, because 2^exponent itself may lie beyond the range of f64.
    Some(v * power_of_two(exponent / 2) * power_of_two(exponent - exponent / 2))
}

/// Returns the largest absolute value among the components of a vector. NaN components are ignored.
#[inline]
#[must_use]
pub fn max_abs(v: Vector) -> f64 {
    v.x.abs().max(v.y.abs()).max(v.z.abs())
}

/// Returns the dot product of two vectors, summed in the order x, y, z.
#[inline]
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Returns the cross product `a` × `b`.
#[inline]
#[must_use]
pub fn cross(a: Vector, b: Vector) -> Vector {
    Vector::new(
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    )
}

/// Returns the point at the fraction `t` of the way from `p` to `q`, computed as p − (p − q) t. If
/// `p` and `q` are equal, the result is bit-equal to `p`.
#[inline]
#[must_use]
pub fn between(p: Point, q: Point, t: f64) -> Point {
    // Not p + (q − p) t, which is the same but of −0 and −0 makes 0.
    p - (p - q) * t
}

/// Returns the length of a vector: √(x² + y² + z²), summed in that order.
#[inline]
#[must_use]
pub fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

/// The area of a triangle.
pub(crate) fn area(a: Point, b: Point, c: Point) -> f64 {
    length(cross(b - a, c - a)) / 2.0
}

/// The smallest altitude of a triangle: 0 where its corners are one point.
pub(crate) fn altitude([a, b, c]: [Point; 3]) -> f64 {
    let sides = [b - a, c - b, a - c];
    altitude_of_squares(twice_area_squared(sides), longest_squared(sides))
}

/// The square of the longest of three sides.
#[inline]
fn longest_squared(sides: [Vector; 3]) -> f64 {
    // None of them is NaN, and to allow for that takes five times as long.
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let [a, b, c] = sides.map(|side| dot(side, side));
    larger(larger(a, b), c)
}

/// The square of twice the area of a triangle with these sides.
#[inline]
fn twice_area_squared([a, _, c]: [Vector; 3]) -> f64 {
    let normal = cross(a, c);
    dot(normal, normal)
}

/// The root of the largest square is the largest root, so one root is enough for three sides.
fn altitude_of_squares(twice_area: f64, longest: f64) -> f64 {
    if longest > 0.0 {
        twice_area.sqrt() / longest.sqrt()
    } else {
        0.0
    }
}

/// The smallest [`altitude`] of many triangles, to the bit.
///
/// Nearly all triangles are passed over without a root or a quotient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AltitudeMin {
    least: f64,
    /// Above the square of the least altitude by more than rounding explains.
    square: f64,
}

impl AltitudeMin {
    /// Of no triangle.
    pub(crate) const NONE: AltitudeMin = AltitudeMin {
        least: f64::INFINITY,
        square: f64::INFINITY,
    };

    /// Takes in a triangle with these sides, one after the other.
    #[inline]
    pub(crate) fn take(&mut self, sides: [Vector; 3]) {
        let (area, longest) = (twice_area_squared(sides), longest_squared(sides));
        // Infinity times zero is no number, and above nothing.
        let is_higher = area > self.square * longest;
        if !is_higher {
            self.take_exactly(area, longest);
        }
    }

    #[cold]
    fn take_exactly(&mut self, area: f64, longest: f64) {
        self.least = self.least.min(altitude_of_squares(area, longest));
        // Below the normal range a square has lost its digits. Its least number is above all those.
        let square = (self.least * self.least).max(f64::MIN_POSITIVE);
        self.square = square * (1.0 + 64.0 * f64::EPSILON);
    }

    /// The smallest altitude; `None` of no triangle.
    pub(crate) fn least(self) -> Option<f64> {
        (self.least < f64::INFINITY).then_some(self.least)
    }
}

/// Returns the sine and the cosine of an angle in radians, in this order. The absolute value of the
/// angle must be at most 8, which is more than a full turn.
///
/// Both are computed in a fixed order, so they are the same on every machine. The nearest multiple
/// of π/2 is subtracted in three parts, of which the first two have so few bits that their
/// multiples are exact (Cody and Waite, "Software Manual for the Elementary Functions", 1980). The
/// remainder is at most π/4, where eight terms of the Taylor series omit less than 1e-17 of the
/// result. The error of each result is less than two units in the last place.
#[must_use]
pub fn sine_and_cosine(angle: f64) -> (f64, f64) {
    debug_assert!(angle.abs() <= 8.0);
    // 33 bits of π/2, the next 33, and 53 of the rest.
    const HALF_PI: [u64; 3] = [
        0x3ff9_21fb_5440_0000,
        0x3dd0_b461_1a60_0000,
        0x3ba3_198a_2e03_7073,
    ];
    let quarters = (angle * std::f64::consts::FRAC_2_PI).round();
    let [high, middle, low] = HALF_PI.map(|bits| quarters * f64::from_bits(bits));
    let rest = angle - high - middle - low;
    // sin x = x − x s and cos x = 1 − c, from the smallest term on.
    let (mut s, mut c) = (0.0, 0.0);
    for n in (1..=8).map(|k| f64::from(2 * k)).rev() {
        s = rest * rest * (1.0 - s) / (n * (n + 1.0));
        c = rest * rest * (1.0 - c) / (n * (n - 1.0));
    }
    let (sine, cosine) = (rest - rest * s, 1.0 - c);
    match (quarters as i32).rem_euclid(4) {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many numbers apart two numbers of one sign are.
    fn apart(a: f64, b: f64) -> u64 {
        assert!(a * b >= 0.0, "{a} and {b}");
        a.abs().to_bits().abs_diff(b.abs().to_bits())
    }

    #[test]
    fn sines_and_cosines_are_the_systems_to_two_last_places() {
        let mut furthest = 0;
        let mut compare = |angle: f64| {
            let (sine, cosine) = sine_and_cosine(angle);
            let (y, x) = angle.sin_cos();
            furthest = furthest.max(apart(sine, y)).max(apart(cosine, x));
        };
        for i in -400_000..=400_000 {
            compare(f64::from(i) / 50_000.0);
        }
        for quarters in -4..=4 {
            let near = f64::from(quarters) * std::f64::consts::FRAC_PI_2;
            (-1000..=1000).for_each(|i| compare(near + f64::EPSILON * f64::from(i)));
            (1..=300).for_each(|i| compare(near + power_of_two(-i)));
        }
        assert!(furthest <= 2, "{furthest}");
        assert_eq!(sine_and_cosine(0.0), (0.0, 1.0));
    }

    #[test]
    fn a_triangle_that_is_a_point_has_no_altitude() {
        assert_eq!(altitude([Point::origin(); 3]), 0.0);
    }

    #[test]
    fn scaling_is_exact_at_both_ends_of_the_range() {
        for size in [5e-324, 1e-310, 1.0, 3.0, f64::MAX] {
            let v = scaled(Vector::new(0.0, -size, 0.0)).expect("not zero");
            assert!((0.5..1.0).contains(&-v.y), "{size}");
        }
        assert_eq!(scaled(Vector::zeros()), None);
        assert_eq!(scaled(Vector::new(1.0, f64::NAN, 0.0)), None);
        assert_eq!(scaled(Vector::new(f64::INFINITY, 1.0, 0.0)), None);
    }
}
