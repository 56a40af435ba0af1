//! Distances from a mesh without a grid: every triangle is asked, and solid angles tell inside from outside.

use crate::plain::Plain;
use crate::vectors::{cross, dot, length, minus};

type V = [f64; 3];

/// The triangles of an OBJ file.
pub(super) struct Solid {
    pub(super) points: Vec<V>,
    pub(super) faces: Vec<[u32; 3]>,
}

/// The distance of the origin from a segment.
fn from_segment(a: V, b: V) -> f64 {
    let d = minus(b, a);
    let t = (-dot(a, d) / dot(d, d)).clamp(0.0, 1.0);
    let nearest = [0, 1, 2].map(|i| a[i] + d[i] * t);
    length(nearest)
}

impl Solid {
    /// Reads vertices and faces, in metres of which a unit of the file has so many.
    pub(super) fn read(text: &str, unit_m: f64) -> Solid {
        let file = Plain::read(text);
        let point = |v| file.at(v).map(|x| x * unit_m);
        Solid {
            points: (0..file.vertices.len()).map(point).collect(),
            faces: file.triangles(),
        }
    }

    /// The distance of a point from the nearest triangle, negative where the faces surround it.
    pub(super) fn distance(&self, p: V) -> f64 {
        let (mut least, mut angle) = (f64::INFINITY, 0.0);
        for face in &self.faces {
            let [a, b, c] = face.map(|v| minus(self.points[v as usize], p));
            let [la, lb, lc] = [a, b, c].map(length);
            let volume = dot(a, cross(b, c));
            let base = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            angle += 2.0 * volume.atan2(base);
            let normal = cross(minus(b, a), minus(c, a));
            let parts = [cross(b, c), cross(c, a), cross(a, b)].map(|part| dot(part, normal));
            let edges = from_segment(a, b)
                .min(from_segment(b, c))
                .min(from_segment(c, a));
            least = least.min(edges);
            if parts.iter().all(|&part| part >= 0.0) {
                least = least.min(volume.abs() / length(normal));
            }
        }
        if angle > 2.0 * std::f64::consts::PI {
            -least
        } else {
            least
        }
    }
}
