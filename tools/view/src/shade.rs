//! How bright a surface is: smooth where it is smooth, and creased where it is.

use tearmesh::geometry::{cross, dot, length};
use tearmesh::{Mesh, Place, Vector};

use crate::camera::{Camera, unit};
use crate::palette::Color;

/// The cosine of the angle between two faces from which on there is a crease: 40 degrees.
pub(crate) const CREASE: f64 = 0.766;

/// How bright a surface is that no light meets, and how much each light adds: the key light, and the one at
/// the eye. Then where the key light is: backward, up and right. Then how much of its colour the back keeps,
/// and how bright it is.
pub(crate) const LIGHT: [f64; 8] = [0.34, 0.46, 0.28, 0.7, 0.6, -0.4, 0.65, 0.82];

/// The normal of each corner of each face: the mean, by area, of those faces of its vertex that go on
/// without a crease.
pub(crate) fn corner_normals(mesh: &Mesh, place: &(impl Place + ?Sized)) -> Vec<[Vector; 3]> {
    let spanned: Vec<Vector> = mesh
        .faces()
        .map(|f| {
            let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
            cross(b - a, c - a)
        })
        .collect();
    // Brought to about one, so that no product of tiny or huge ones is lost.
    let largest = spanned
        .iter()
        .map(|n| tearmesh::geometry::max_abs(*n))
        .fold(0.0, f64::max);
    let scale = if largest > 0.0 && largest.is_finite() {
        1.0 / largest
    } else {
        1.0
    };
    let normals: Vec<Vector> = spanned
        .iter()
        .map(|&n| unit(n).unwrap_or_default())
        .collect();
    let at_corner = |f: tearmesh::FaceId, v| {
        let own = normals[f.index()];
        let near = mesh
            .faces_of(v)
            .filter(|g| dot(own, normals[g.index()]) >= CREASE);
        let sum = near.fold(Vector::zeros(), |sum, g| sum + spanned[g.index()] * scale);
        unit(sum).unwrap_or(own)
    };
    mesh.faces()
        .map(|f| mesh.face_vertices(f).map(|v| at_corner(f, v)))
        .collect()
}

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

    /// The colour of a surface with this normal, of any length, of which the front or the back is seen.
    pub(crate) fn shade(&self, color: Color, normal: Vector, is_front: bool) -> [f64; 3] {
        let length = length(normal);
        let normal = match (length > 0.0, is_front) {
            (false, _) => self.backward,
            (true, true) => normal / length,
            (true, false) => normal / -length,
        };
        let key = dot(normal, self.key).max(0.0);
        let head = dot(normal, self.backward).max(0.0);
        let [ambient, by_key, by_head, .., kept, bright] = LIGHT;
        let light = ambient + by_key * key + by_head * head;
        let color = color.map(f64::from);
        let [r, g, b] = color;
        let grey = (r + g + b) / 3.0;
        // The back is duller and darker than the front, so that they are told apart.
        let side = |x: f64| {
            if is_front {
                x
            } else {
                (kept * x + (1.0 - kept) * grey) * bright
            }
        };
        color.map(|x| (side(x) * light).min(255.0))
    }
}
