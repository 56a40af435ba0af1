//! The stretch of a face: the singular values of its deformation.
//!
//! A face maps its piece of the material, a triangle in the plane with warp along u and weft along
//! v, into space. The map is affine with the constant derivatives `w_u` and `w_v`; their lengths
//! are the stretch of warp and weft, and the singular values of (`w_u` `w_v`) are the largest and
//! smallest stretch of any direction. They need the rest positions alone, so they are known
//! of every cloth, whatever resists the stretch. Closed forms of `+ − × ÷ √`.

use tearmesh::FaceId;
use tearmesh::geometry::{Point, Vector, dot, length};

use crate::sheet::Cloth;

impl Cloth {
    /// Returns the largest stretch of a face in any direction, as a multiple of the length at rest:
    /// the larger singular value of its deformation. It is 1 at rest, up to rounding.
    /// [`Threshold::PrincipalStretch`](crate::Threshold::PrincipalStretch) is compared with it.
    ///
    /// For a face without area at rest, the result is the largest stretch ratio of its edges.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn principal_stretch(&self, f: FaceId) -> f64 {
        let (rest, now) = (self.rest_corners(f), self.corners(f));
        let Some(derivatives) = self.derivatives(f) else {
            return thread_stretch(rest, now);
        };
        larger_singular_value(derivatives)
    }

    /// Returns the stretch of a face along warp and along weft, |`w_u`| and |`w_v`|, as multiples
    /// of the lengths at rest. Shear does not enter.
    ///
    /// The direction of warp is that of [`Weave::warp`](crate::Weave::warp) or
    /// [`Cloth::with_warps`], projected onto the face at rest. Weft is perpendicular to it. If the
    /// fabric sets no direction, warp runs along the x-axis, or along the y-axis in faces whose
    /// normal is nearer to the x-axis than to the other axes.
    ///
    /// For a face without area at rest, both numbers are the largest stretch ratio of its edges.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn warp_weft_stretch(&self, f: FaceId) -> [f64; 2] {
        match self.derivatives(f) {
            Some(derivatives) => derivatives.map(length),
            None => [thread_stretch(self.rest_corners(f), self.corners(f)); 2],
        }
    }

    /// `w_u` and `w_v` of a face; `None` where it has no area at rest.
    fn derivatives(&self, f: FaceId) -> Option<[Vector; 2]> {
        derivatives(self.material(f)?, self.corners(f))
    }

    fn corners(&self, f: FaceId) -> [Point; 3] {
        self.vertices_of(f).map(|v| self.positions()[v.index()])
    }
}

/// `w_u` and `w_v` of the map that takes these places to these points.
fn derivatives(material: [[f64; 2]; 3], now: [Point; 3]) -> Option<[Vector; 2]> {
    let [_, [u1, v1], [u2, v2]] = material;
    let twice = u1 * v2 - u2 * v1;
    let (a, b) = (now[1] - now[0], now[2] - now[0]);
    (twice > 0.0).then(|| [(a * v2 - b * v1) / twice, (b * u1 - a * u2) / twice])
}

/// The larger singular value of a matrix of two columns.
fn larger_singular_value([w_u, w_v]: [Vector; 2]) -> f64 {
    let (uu, vv, uv) = (dot(w_u, w_u), dot(w_v, w_v), dot(w_u, w_v));
    let apart = 0.5 * (uu - vv);
    (0.5 * (uu + vv) + (apart * apart + uv * uv).sqrt()).sqrt()
}

/// The largest ratio of the edges that have a length at rest; 1 where none has.
fn thread_stretch(rest: [Point; 3], now: [Point; 3]) -> f64 {
    let mut largest = None;
    for i in 0..3 {
        let j = (i + 1) % 3;
        let at_rest = length(rest[j] - rest[i]);
        if at_rest > 0.0 {
            let ratio = length(now[j] - now[i]) / at_rest;
            largest = Some(largest.map_or(ratio, |largest: f64| largest.max(ratio)));
        }
    }
    largest.unwrap_or(1.0)
}
