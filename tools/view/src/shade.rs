//! How bright a surface is.

use tearmesh::Vector;
use tearmesh::geometry::{dot, length};

use crate::camera::Camera;

/// How bright a surface is that no light meets, and how much each light adds: the key light, and the one at
/// the eye. Then where the key light is: backward, up and right. Then how much of its colour the back keeps,
/// and how bright it is. Then the part of all light that comes from the sky.
pub(crate) const LIGHT: [f64; 9] = [0.34, 0.46, 0.28, 0.7, 0.6, -0.4, 0.65, 0.82, 0.75];

/// How much darker the ground is that sees no sky.
pub(crate) const SHADOW: f64 = 0.7;

/// The lights of a picture, which go with its camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    backward: Vector,
    key: Vector,
}

impl Light {
    pub(crate) fn of(camera: &Camera) -> Light {
        let [backward, right, up] = camera.axes();
        let [_, _, _, b, u, r, ..] = LIGHT;
        let key = backward * b + up * u + right * r;
        Light {
            backward,
            key: key / length(key),
        }
    }

    /// The colour of a surface with this normal, of any length, of which the front or the back is seen, and
    /// which sees this part of the sky.
    pub(crate) fn shade(
        &self,
        color: [f64; 3],
        normal: Vector,
        is_front: bool,
        sky: f64,
    ) -> [f64; 3] {
        let length = length(normal);
        let normal = match (length > 0.0, is_front) {
            (false, _) => self.backward,
            (true, true) => normal / length,
            (true, false) => normal / -length,
        };
        let key = dot(normal, self.key).max(0.0);
        let head = dot(normal, self.backward).max(0.0);
        let [ambient, by_key, by_head, .., kept, bright, by_sky] = LIGHT;
        let light = (ambient + by_key * key + by_head * head) * (1.0 - by_sky * (1.0 - sky));
        let [r, g, b] = color;
        let grey = (r + g + b) / 3.0;
        // The back is duller and darker than the front, so that they are told apart.
        let side = |x: f64| match is_front {
            true => x,
            false => (kept * x + (1.0 - kept) * grey) * bright,
        };
        color.map(|x| (side(x) * light).min(255.0))
    }
}
