//! Cloth of triangles: a modulus along warp, along weft and in shear, in every face.
//!
//! A net of springs has the stiffness of its mesh: one diagonal a cell makes it shear when it is
//! pulled, and three directions alike give it Poisson's ratio 1/3. Triangles have the moduli that
//! are asked for, whatever the mesh (Baraff and Witkin 1998 §4; see
//! [`Triangle`] for the energy and where it differs).
//!
//! The triangle of a face is made from the rest positions of its corners and the direction of warp,
//! and has the number of the face. Edits follow with the cost of what they touch: a split or a
//! merge relabels corners, so a split changes no energy at all; the parts of a divided face
//! deform as it did, so together they hold what it held; where a vertex slides the triangles
//! around it are made anew.

use tearmesh::geometry::{Point, Vector, cross, dot, length};
use tearmesh::{FaceId, HalfEdgeId};

use crate::cloth::fabric::Orthotropic;
use crate::cloth::{Cloth, ClothError};
use crate::system::triangle::Triangle;

impl Cloth {
    /// Makes a triangle for each face, if the fabric asks for them.
    pub(super) fn add_triangles(&mut self) -> Result<(), ClothError> {
        let Some(Orthotropic { warp, .. }) = self.fabric.orthotropic else {
            return Ok(());
        };
        for f in (0..self.indices().len() / 3).filter_map(FaceId::new) {
            let triangle = material(self.rest_face(f), warp)
                .and_then(|material| self.triangle_of(f, material))
                .ok_or(ClothError::Face { face: f, warp })?;
            self.system.push_triangle(triangle);
        }
        Ok(())
    }

    fn triangle_of(&self, f: FaceId, material: [[f64; 2]; 3]) -> Option<Triangle> {
        let stiffness = self.fabric.orthotropic.map_or([0.0; 3], |moduli| {
            [
                moduli.warp_n_per_m,
                moduli.weft_n_per_m,
                moduli.shear_n_per_m,
            ]
        });
        Triangle::new(self.face_vertices(f), material, stiffness)
    }

    fn face_vertices(&self, f: FaceId) -> [u32; 3] {
        f.half_edges().map(|h| self.indices()[h.index()])
    }

    /// The triangle of a face as it is at rest now; one that rounding left no area for resists
    /// nothing.
    fn woven(&self, f: FaceId) -> Triangle {
        let triangle = self.material(f).and_then(|m| self.triangle_of(f, m));
        triangle.unwrap_or_else(|| Triangle::slack(self.face_vertices(f)))
    }

    /// Gives corners of triangles to another particle.
    pub(super) fn relabel_triangles(&mut self, corners: &[HalfEdgeId], to: usize) {
        if self.fabric.orthotropic.is_some() {
            let triangles = &mut self.system.model.triangles;
            for corner in corners {
                triangles.repoint(corner.face().index(), corner.corner(), to);
            }
        }
    }

    /// Makes the triangle of a face anew, or that of a face that has come, if the fabric asks for them.
    pub(super) fn weave_face(&mut self, f: FaceId) {
        if self.fabric.orthotropic.is_some() {
            let triangle = self.woven(f);
            self.system.model.triangles.put(f.index(), triangle);
        }
    }

    /// Makes the triangles around a particle anew, whose place at rest has changed.
    pub(super) fn weave_again(&mut self, particle: usize) {
        let around = self.system.model.triangles.of(particle);
        let around: Vec<usize> = around.map(|(t, _)| t).collect();
        for t in around {
            self.weave_face(FaceId::new(t).expect("I1: ids fit"));
        }
    }

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
        let vertices = self.face_vertices(f);
        let material = self.material(f);
        if let Some(triangle) = material.and_then(|m| Triangle::new(vertices, m, [0.0; 3])) {
            let now = vertices.map(|v| self.positions()[v as usize]);
            let [w_u, w_v] = triangle.derivatives(now);
            let (uu, vv, uv) = (dot(w_u, w_u), dot(w_v, w_v), dot(w_u, w_v));
            let apart = 0.5 * (uu - vv);
            return (0.5 * (uu + vv) + (apart * apart + uv * uv).sqrt()).sqrt();
        }
        let ratio = |h: HalfEdgeId| self.system.stretch_ratio(self.stretch(h));
        f.half_edges().map(ratio).into_iter().fold(0.0, f64::max)
    }

    /// The places of a face's corners in the material. Where edits have turned a face until its
    /// warp has no projection the axis of cloths without names takes its place. `None` where
    /// there is no area at rest.
    fn material(&self, f: FaceId) -> Option<[[f64; 2]; 3]> {
        let rest = self.rest_face(f);
        let warp = self.fabric.orthotropic.map(|moduli| moduli.warp);
        let named = warp.and_then(|warp| material(rest, warp));
        named.or_else(|| material(rest, default_warp(rest)))
    }

    pub(super) fn rest_face(&self, f: FaceId) -> [Point; 3] {
        f.half_edges().map(|h| *self.rest.at(h))
    }
}

/// The places (u, v) of a triangle's corners in its own plane, in metres: the first at the origin,
/// u along the projection of `warp`, v across it. `None` where the triangle has no area or
/// `warp` no projection.
fn material(rest: [Point; 3], warp: Vector) -> Option<[[f64; 2]; 3]> {
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
