//! The place of a face in the flat material: the direction of warp, and the coordinates of its
//! corners.

use tearmesh::geometry::{Point, Vector, cross, dot, length};
use tearmesh::{FaceId, VertexId};

use crate::sheet::Cloth;

impl Cloth {
    /// The direction that warp has at rest, before it is projected onto the face.
    pub(super) fn warp(&self, f: FaceId) -> Vector {
        let named = self.warps.get(f.index()).copied();
        let named = named.or(self.fabric.weave.map(|weave| weave.warp));
        named.unwrap_or_else(|| default_warp(self.rest_corners(f)))
    }

    /// The places of a face's corners in the material. Where edits have turned a face until its
    /// warp has no projection the axis of cloths without names takes its place. `None` where
    /// there is no area at rest.
    pub(super) fn material(&self, f: FaceId) -> Option<[[f64; 2]; 3]> {
        let rest = self.rest_corners(f);
        material(rest, self.warp(f)).or_else(|| material(rest, default_warp(rest)))
    }

    pub(super) fn rest_corners(&self, f: FaceId) -> [Point; 3] {
        self.vertices_of(f).map(|v| self.rest.at(v))
    }

    pub(super) fn vertices_of(&self, f: FaceId) -> [VertexId; 3] {
        let corners = f.half_edges();
        corners.map(|h| VertexId::new(self.indices()[h.index()] as usize).expect("I1: ids fit"))
    }
}

/// Returns the direction in a triangle, in space, in which the first texture coordinate grows. This
/// is the direction of warp for a garment whose texture is its flat pattern. It is not a unit
/// vector.
///
/// Returns `None` if the texture coordinates span no area.
///
/// ```
/// use tearmesh::{Point, Vector};
/// use tearmesh_cloth::warp_of_texture;
///
/// let rest = [Point::origin(), Point::new(0.0, 0.0, 2.0), Point::new(0.0, 2.0, 0.0)];
/// let warp = warp_of_texture(rest, [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]);
/// assert_eq!(warp, Some(Vector::new(0.0, 0.0, 4.0)));
/// ```
#[must_use]
pub fn warp_of_texture(rest: [Point; 3], texture: [[f64; 2]; 3]) -> Option<Vector> {
    let [[s0, t0], [s1, t1], [s2, t2]] = texture;
    let (s1, t1, s2, t2) = (s1 - s0, t1 - t0, s2 - s0, t2 - t0);
    let twice = s1 * t2 - s2 * t1;
    let (a, b) = (rest[1] - rest[0], rest[2] - rest[0]);
    let spans = twice != 0.0 && twice.is_finite();
    spans.then(|| (a * t2 - b * t1) / twice)
}

/// The places (u, v) of a triangle's corners in its own plane, in metres: the first at the origin,
/// u along the projection of `warp`, v across it. `None` where the triangle has no area or
/// `warp` no projection.
pub(super) fn material(rest: [Point; 3], warp: Vector) -> Option<[[f64; 2]; 3]> {
    let (a, b) = (rest[1] - rest[0], rest[2] - rest[0]);
    let normal = unit(cross(a, b))?;
    let u = unit(warp - normal * dot(normal, warp))?;
    let v = cross(normal, u);
    Some([[0.0, 0.0], [dot(a, u), dot(a, v)], [dot(b, u), dot(b, v)]])
}

/// The axis that is warp where nobody says: x, or y where the normal lies nearest to x. So the
/// projection is never short.
fn default_warp(rest: [Point; 3]) -> Vector {
    let normal = cross(rest[1] - rest[0], rest[2] - rest[0]);
    let x = normal.x.abs();
    if x > normal.y.abs() && x > normal.z.abs() {
        Vector::y()
    } else {
        Vector::x()
    }
}

fn unit(v: Vector) -> Option<Vector> {
    let l = length(v);
    (l > 0.0).then(|| v / l)
}
