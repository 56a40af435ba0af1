//! The worst of the faces of a mesh: the smallest angle and the smallest altitude.

use crate::geometry::{angle, cross, dot, length};
use crate::mesh::Mesh;
use crate::place::Positions;

/// The smallest angle and the smallest altitude of any face; both are 0 for a mesh without faces.
pub(super) struct Quality {
    pub(super) angle_min_deg: f64,
    pub(super) altitude_min: f64,
}

impl Quality {
    pub(super) fn of(mesh: &Mesh, positions: &Positions) -> Quality {
        let mut altitude_min = f64::INFINITY;
        // The smallest angle has the largest cotangent, for which it needs no arc function.
        let (mut cotangent_max, mut smallest) = (f64::NEG_INFINITY, [0.0; 2]);
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
            let [ab, bc, ca] = [b - a, c - b, a - c].map(|side| dot(side, side));
            let longest = ab.max(bc).max(ca).sqrt();
            let altitude = length(cross(b - a, c - a)) / longest;
            altitude_min = altitude_min.min(if longest > 0.0 { altitude } else { 0.0 });
            // It is opposite the shortest side.
            let (corner, one, other) = match ab.min(bc).min(ca) {
                shortest if shortest == bc => (a, b, c),
                shortest if shortest == ca => (b, c, a),
                _ => (c, a, b),
            };
            let along = dot(one - corner, other - corner);
            let across = length(cross(one - corner, other - corner));
            let cotangent = if across > 0.0 {
                along / across
            } else {
                f64::INFINITY
            };
            if cotangent > cotangent_max {
                (cotangent_max, smallest) = (cotangent, [along, across]);
            }
        }
        let [along, across] = smallest;
        Quality {
            angle_min_deg: angle(along, across) * (180.0 / std::f64::consts::PI),
            altitude_min: if altitude_min < f64::INFINITY {
                altitude_min
            } else {
                0.0
            },
        }
    }
}
