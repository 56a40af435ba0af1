//! The normals of corners, for shading.

use crate::geometry::{Vector, cross, dot, length, max_abs};
use crate::id::HalfEdgeId;
use crate::mesh::Mesh;
use crate::place::Place;

/// Returns the unit normal of each corner, indexed by half-edge: the mean of the normals of the faces
/// that are one smooth surface with it, weighted by area.
///
/// Two faces that share an untorn edge are one smooth surface at its ends if the cosine of the angle
/// between their normals is at least `crease`. Below −1 there is no crease, and 1 makes nearly every
/// edge one. The sides of a tear have normals of their own, so a torn surface may bend apart there. A
/// corner whose faces have no area has the normal zero.
///
/// Corners of one vertex that are one smooth surface have equal normals, so
/// [`DrawBuffers`](super::DrawBuffers) give them one slot. The cost is a walk round each vertex.
///
/// # Panics
///
/// If `place` does not store the position of a vertex that has a face.
///
/// ```
/// use tearmesh::engine::{DrawBuffers, normals};
/// use tearmesh::{Mesh, Positions, Vector};
///
/// // A square that is folded upright along its diagonal.
/// let positions = Positions::new([[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]])?;
/// let mesh = Mesh::build(4, &[[0, 1, 2], [0, 3, 1]])?;
/// let [smooth, sharp] = [-2.0, 0.5].map(|crease| normals(&mesh, &positions, crease));
/// assert_eq!((smooth[0], sharp[0]), (smooth[3], Vector::z()));
/// assert_eq!([smooth, sharp].map(|normals| DrawBuffers::new(&mesh, normals).len()), [4, 6]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn normals(mesh: &Mesh, place: &(impl Place + ?Sized), crease: f64) -> Vec<Vector> {
    let faces = FaceNormals::of(mesh, place);
    let mut normals = vec![Vector::zeros(); mesh.half_edge_count()];
    for first in mesh.vertices().flat_map(|v| mesh.fans(v)) {
        let fan = faces.fan(mesh, first, crease);
        for part in fan.chunk_by(|&one, &next| faces.are_smooth(one, next, crease)) {
            let mean = faces.mean(part);
            part.iter().for_each(|h| normals[h.index()] = mean);
        }
    }
    normals
}

/// The normals of faces.
struct FaceNormals {
    /// As long as twice the area of the face, of which the largest is about 1.
    spanned: Vec<Vector>,
    units: Vec<Vector>,
}

impl FaceNormals {
    fn of(mesh: &Mesh, place: &(impl Place + ?Sized)) -> FaceNormals {
        let spanned = |f| {
            let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
            cross(b - a, c - a)
        };
        let mut spanned: Vec<Vector> = mesh.faces().map(spanned).collect();
        let units = spanned
            .iter()
            .map(|&n| unit(n).unwrap_or_default())
            .collect();
        let largest = spanned.iter().map(|&n| max_abs(n)).fold(0.0, f64::max);
        // So that no product of tiny or huge ones is lost.
        if largest > 0.0 && largest.is_finite() {
            spanned.iter_mut().for_each(|n| *n /= largest);
        }
        FaceNormals { spanned, units }
    }

    /// Whether two faces at a vertex are one smooth surface.
    fn are_smooth(&self, one: HalfEdgeId, next: HalfEdgeId, crease: f64) -> bool {
        let [one, next] = [one, next].map(|h| self.units[h.face().index()]);
        dot(one, next) >= crease
    }

    /// The corners of a fan in order; a closed one begins at a crease, if it has one.
    fn fan(&self, mesh: &Mesh, first: HalfEdgeId, crease: f64) -> Vec<HalfEdgeId> {
        let mut fan: Vec<HalfEdgeId> = mesh.fan(first).collect();
        let is_closed = mesh.pair(first).is_some();
        let is_crease = |&i: &usize| !self.are_smooth(fan[i - 1], fan[i], crease);
        if let Some(at) = (1..fan.len()).find(is_crease).filter(|_| is_closed) {
            fan.rotate_left(at);
        }
        fan
    }

    /// The mean normal of the faces of corners, by area.
    fn mean(&self, corners: &[HalfEdgeId]) -> Vector {
        let faces = corners.iter().map(|h| h.face().index());
        let sum = faces.fold(Vector::zeros(), |sum, f| sum + self.spanned[f]);
        unit(sum).unwrap_or(self.units[corners[0].face().index()])
    }
}

/// A vector of length one; `None` for zero, and for one that is too long.
fn unit(v: Vector) -> Option<Vector> {
    let largest = max_abs(v);
    let scaled = v / largest;
    let length = length(scaled);
    (largest > 0.0 && length.is_finite()).then(|| scaled / length)
}
