//! The camera through which somebody sees the mesh: from points of its picture to rays, and from points
//! in space to its picture.

use std::error::Error;
use std::fmt;

use tearmesh::geometry::{cross, dot, length, max_abs};
use tearmesh::{Point, Ray, RayError, Vector};

/// A perspective camera. The point that it looks at is in the middle of its picture.
///
/// All results are computed with + − × ÷ √ alone, so they are bit-equal on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Point,
    /// To the middle of the picture, and from there to the middles of its right and its upper edge.
    middle: Vector,
    right: Vector,
    up: Vector,
    /// Its width and height in pixels.
    size: [f64; 2],
}

/// The reason why a camera cannot be created, or placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraError {
    /// The point to look at equals the eye, or is not finite.
    At,
    /// The upward direction is zero, not finite, or parallel to the direction of view.
    Up,
    /// The angle of view is not between 0 and 180 degrees, both excluded.
    Angle,
    /// The mesh to look at has no visible face.
    Empty,
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            CameraError::At => "the camera looks at its own eye",
            CameraError::Up => "the camera looks along what is to be upright in its picture",
            CameraError::Angle => "the angle of view is not between 0 and 180 degrees",
            CameraError::Empty => "the mesh has no visible face",
        })
    }
}

impl Error for CameraError {}

impl Camera {
    /// Creates the camera at `eye` that looks at `at`, with `up` upright in its picture. `degrees` is the
    /// angle of view from the lower edge of the picture to the upper edge. `size` is the width and height of
    /// the picture, in pixels.
    ///
    /// ```
    /// use tearmesh::{Point, Vector};
    /// use tearmesh_view::Camera;
    ///
    /// let (eye, at) = (Point::new(0.0, 0.0, 5.0), Point::origin());
    /// let camera = Camera::new([eye, at], Vector::y(), 90.0, [800.0, 600.0])?;
    /// // 5 in front of the eye it sees 5 up and 5 down.
    /// let ray = camera.ray([400.0, 0.0])?;
    /// assert!((ray.direction() - Vector::new(0.0, 1.0, -1.0)).norm() < 1e-15);
    /// let seen = camera.seen(Point::new(0.0, 5.0, 0.0));
    /// assert!(seen.x.abs() < 1e-12 && (seen.y / seen.z - 1.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`CameraError`] if `at` equals `eye`, if `up` is parallel to the direction of view, or if `degrees`
    /// is not between 0 and 180.
    pub fn new(
        [eye, at]: [Point; 2],
        up: Vector,
        degrees: f64,
        size: [f64; 2],
    ) -> Result<Camera, CameraError> {
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(CameraError::Angle);
        }
        let middle = unit(at - eye).ok_or(CameraError::At)?;
        let across = unit(up).map(|up| cross(middle, up));
        // Two directions of length 1 whose product is nothing but rounding span no plane.
        let across = across.filter(|&across| max_abs(across) > 1e-12);
        let right = across.and_then(unit).ok_or(CameraError::Up)?;
        let half = tangent(degrees / 2.0);
        let [width, height] = size;
        Ok(Camera {
            eye,
            middle,
            up: cross(right, middle) * half,
            right: right * (half * width / height),
            size,
        })
    }

    /// Returns the ray from the eye through a point of the picture. `x` is the distance from the left edge,
    /// and `y` the distance from the upper edge, in pixels. The point may be outside the picture.
    ///
    /// # Errors
    ///
    /// [`RayError`] if the eye is not a valid origin of a ray, or if the direction is not finite.
    pub fn ray(&self, [x, y]: [f64; 2]) -> Result<Ray, RayError> {
        let [width, height] = self.size;
        let across = self.right * (2.0 * x / width - 1.0);
        let upward = self.up * (1.0 - 2.0 * y / height);
        // Adding zero turns −0 into 0.
        Ray::new(self.eye, (self.middle + across + upward).map(|x| x + 0.0))
    }

    /// Returns a point in the coordinates of the camera. The coordinate z is the distance in front of the
    /// eye along the direction of view, and negative behind the eye. The ratio x / z is −1 at the left edge
    /// of the picture and 1 at the right edge; y / z is −1 at the lower edge and 1 at the upper edge.
    #[must_use]
    pub fn seen(&self, p: Point) -> Vector {
        let from_eye = p - self.eye;
        let part = |axis: Vector| dot(from_eye, axis) / dot(axis, axis);
        Vector::new(part(self.right), part(self.up), dot(from_eye, self.middle))
    }

    /// The eye, and the direction in which a line of sight goes that [`Camera::seen`] gives as this.
    pub(crate) fn sight(&self, seen: Vector) -> (Point, Vector) {
        let direction = self.right * seen.x + self.up * seen.y + self.middle * seen.z;
        (self.eye, direction)
    }

    /// The direction from the surface to the eye and those of the picture, each of length one: backward,
    /// right and up.
    pub(crate) fn axes(&self) -> [Vector; 3] {
        let [right, up] = [self.right, self.up].map(|axis| axis / length(axis));
        [-self.middle, right, up]
    }
}

/// The vector of this direction and length 1, if it has a direction.
pub(crate) fn unit(v: Vector) -> Option<Vector> {
    let largest = max_abs(v);
    let scaled = v / largest;
    let length = length(scaled);
    (largest > 0.0 && length.is_finite()).then(|| scaled / length)
}

/// One of the first two axes, whichever is not nearly along a unit vector.
pub(crate) fn aside(v: Vector) -> Vector {
    match v.x.abs() < 0.9 {
        true => Vector::x(),
        false => Vector::y(),
    }
}

/// The tangent of an angle in degrees, from 0 to 90: that of its half by Lambert's continued fraction,
/// which twelve terms give to the last digits up to 45 degrees.
pub(crate) fn tangent(degrees: f64) -> f64 {
    let x = degrees / 2.0 * (std::f64::consts::PI / 180.0);
    let fraction = (1..=12).rev().map(|k| f64::from(2 * k - 1));
    let below = fraction.fold(f64::INFINITY, |below, odd| odd - x * x / below);
    let half = x / below;
    2.0 * half / (1.0 - half * half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tangent_is_that_of_the_standard_library() {
        for i in 1..9000 {
            let degrees = f64::from(i) / 100.0;
            let (is, expected) = (tangent(degrees), degrees.to_radians().tan());
            // Near 90 degrees the angle's own rounding grows.
            let allowed = 1e-15 * (8.0 + expected * expected / expected.max(1.0)) * expected;
            assert!(
                (is - expected).abs() <= allowed,
                "{degrees}: {is} {expected}"
            );
        }
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let eye = Point::new(0.0, 0.0, 5.0);
        let up = Vector::y();
        let (at, above) = (Point::origin(), Point::new(0.0, 9.0, 5.0));
        for (at, up, degrees, error) in [
            (at, up, 40.0, None),
            (eye, up, 40.0, Some(CameraError::At)),
            (above, up, 40.0, Some(CameraError::Up)),
            (at, Vector::zeros(), 40.0, Some(CameraError::Up)),
            (at, up, 180.0, Some(CameraError::Angle)),
            (at, up, f64::NAN, Some(CameraError::Angle)),
        ] {
            let camera = Camera::new([eye, at], up, degrees, [4.0, 3.0]);
            assert_eq!(camera.err(), error);
        }
    }
}
