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

use tearmesh::{FaceId, HalfEdgeId, Insert, Merge, Split};

use crate::material::material;
use crate::sheet::{Cloth, ClothError};
use crate::triangle::Triangle;

impl Cloth {
    /// Makes a triangle for each face, if the fabric asks for them.
    pub(super) fn weave(&mut self) -> Result<(), ClothError> {
        let count = self.indices().len() / 3;
        if !self.warps.is_empty() && self.warps.len() != count {
            return Err(ClothError::Warps {
                faces: count,
                warps: self.warps.len(),
            });
        }
        if self.fabric.weave.is_none() && self.warps.is_empty() {
            return Ok(());
        }
        for f in (0..count).filter_map(FaceId::new) {
            let warp = self.warp(f);
            let triangle = material(self.rest_corners(f), warp)
                .and_then(|material| self.triangle_of(f, material))
                .ok_or(ClothError::Face { face: f, warp })?;
            if self.fabric.weave.is_some() {
                self.system.push_triangle(triangle);
            }
        }
        Ok(())
    }

    fn triangle_of(&self, f: FaceId, material: [[f64; 2]; 3]) -> Option<Triangle> {
        let stiffness = self.fabric.weave.map_or([0.0; 3], |weave| {
            [weave.warp_n_per_m, weave.weft_n_per_m, weave.shear_n_per_m]
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

    fn is_woven(&self) -> bool {
        self.fabric.weave.is_some()
    }

    pub(super) fn split_triangles(&mut self, split: &Split<'_>) {
        self.relabel_triangles(split.corners, split.new.index());
    }

    pub(super) fn merge_triangles(&mut self, merge: &Merge<'_>) {
        self.relabel_triangles(merge.corners, merge.kept.index());
    }

    fn relabel_triangles(&mut self, corners: &[HalfEdgeId], to: usize) {
        if self.is_woven() {
            let triangles = &mut self.system.model.triangles;
            for corner in corners {
                triangles.repoint(corner.face().index(), corner.corner(), to);
            }
        }
    }

    /// Divides triangles among the children of their faces, and returns the energy gained: zero
    /// to rounding, since children deform as their parents did.
    pub(super) fn insert_triangles(&mut self, insert: &Insert<'_>) -> f64 {
        if !self.warps.is_empty() {
            for family in insert.families() {
                family.apply_to_faces(&mut self.warps);
            }
        }
        if !self.is_woven() {
            return 0.0;
        }
        let mut gained = 0.0;
        for family in insert.families() {
            gained -= self.triangle_energy(family.parent().index());
            for child in family.children() {
                let triangle = self.woven(child.face);
                let triangles = &mut self.system.model.triangles;
                if child.face == child.parent {
                    triangles.set(child.face.index(), triangle);
                } else {
                    let index = triangles.as_slice().len();
                    let face = child.face.index();
                    assert_eq!(index, face, "triangles are in step with faces");
                    triangles.push(triangle);
                }
                gained += self.triangle_energy(child.face.index());
            }
        }
        gained
    }

    /// Makes the triangles around a particle anew, whose place at rest has changed.
    pub(super) fn weave_again(&mut self, particle: usize) {
        let around = self.system.model.triangles.of(particle);
        let around: Vec<usize> = around.map(|(t, _)| t).collect();
        for t in around {
            let triangle = self.woven(FaceId::new(t).expect("I1: ids fit"));
            self.system.model.triangles.set(t, triangle);
        }
    }

    fn triangle_energy(&self, t: usize) -> f64 {
        self.system.model.triangles.energy_of(t, self.positions())
    }
}
