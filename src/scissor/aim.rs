//! The distance of a cut from the points of the mesh at which its rays are aimed.
//!
//! These are found by picking, which shares nothing with the planes of the strip. So a strip that lies
//! elsewhere than between the rays is noticed.

use crate::engine::pick;
use crate::exact::ROUNDING;
use crate::geometry::{Plane, Point, Ray, between, dot, length, max_abs};
use crate::id::HalfEdgeId;
use crate::mesh::Mesh;
use crate::place::Positions;

/// How near the seam comes to the point at which a ray meets the mesh first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct CutAim {
    /// The point at which the ray met the mesh before the cut.
    pub at: Point,
    /// The nearest point of the seam, or of an earlier cut or tear along the plane of this one.
    pub seam: Point,
    /// The distance between the two points.
    pub aside: f64,
    /// The distance that the method accounts for. With [`CutMethod::Exact`](super::CutMethod::Exact)
    /// it is twice the snap, once across the seam and once along it, times the longest edge of the face
    /// that the ray met. With other methods it is 1.5 times that edge.
    pub allowed: f64,
}

impl CutAim {
    /// Returns whether the seam is farther from the aim than the method accounts for. With the default
    /// snap, about one end in a thousand is, on sheets of a few hundred triangles: it was moved far to
    /// avoid a thin face.
    #[must_use]
    pub fn is_missed(&self) -> bool {
        self.aside > self.allowed
    }
}

/// Where the rays meet the mesh; none for a cut without bounds at the sides.
pub(super) type Aims = Option<[Option<Aim>; 2]>;

/// How many edges a seam may be aside that follows the edges of the mesh.
pub(super) const ALONG_EDGES: f64 = 1.5;

/// The point at which a ray meets the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    at: Point,
    allowed: f64,
}

impl Aim {
    /// The point at which a ray meets the mesh first, if it does. `edges` is how far from there the seam
    /// may be, in lengths of the longest edge of the face.
    pub(super) fn of(ray: &Ray, edges: f64, mesh: &Mesh, positions: &Positions) -> Option<Aim> {
        let hit = pick::first_hit(mesh, positions, ray)?;
        let [a, b, c] = mesh.face_vertices(hit.face).map(|v| positions.at(v));
        let longest = [b - a, c - b, a - c]
            .map(length)
            .into_iter()
            .fold(0.0, f64::max);
        let reach = max_abs(a.coords).max(max_abs(ray.origin().coords));
        Some(Aim {
            at: hit.point(mesh, positions),
            allowed: edges * longest + ROUNDING * reach,
        })
    }

    /// Compares with the edges that the cut tore, which are sorted, and those torn before that lie along
    /// its plane: there it is cut already. `None` if there are none.
    pub(super) fn compare(
        &self,
        plane: &Plane,
        torn: &[HalfEdgeId],
        mesh: &Mesh,
        positions: &Positions,
    ) -> Option<CutAim> {
        let ends = |h: HalfEdgeId| [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
        let is_along = |p: Point| plane.distance(p).abs() <= self.allowed;
        let counts = |&h: &HalfEdgeId| {
            mesh.ghost_pair(h).is_some()
                && (torn.binary_search(&h).is_ok() || ends(h).into_iter().all(is_along))
        };
        let nearest = mesh.half_edges().filter(counts).map(|h| {
            let seam = nearest_on(ends(h), self.at);
            (length(seam - self.at), seam)
        });
        let (aside, seam) = nearest.min_by(|one, other| one.0.total_cmp(&other.0))?;
        Some(CutAim {
            at: self.at,
            seam,
            aside,
            allowed: self.allowed,
        })
    }
}

/// The point of a segment that is nearest to another point.
fn nearest_on([from, to]: [Point; 2], p: Point) -> Point {
    let way = to - from;
    let whole = dot(way, way);
    let t = if whole > 0.0 {
        dot(p - from, way) / whole
    } else {
        0.0
    };
    between(from, to, t.clamp(0.0, 1.0))
}
