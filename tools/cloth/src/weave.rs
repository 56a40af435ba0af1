//! Cloth of triangles: a modulus along warp, along weft and in shear, in every face.
//!
//! A net of springs has the stiffness of its mesh: one diagonal a cell makes it shear when it is
//! pulled, and three directions alike give it Poisson's ratio 1/3. Triangles have the moduli that
//! are asked for, whatever the mesh (Baraff and Witkin 1998 §4; see
//! [`implicit::triangle`](crate::implicit::triangle) for the energy and where it differs).
//!
//! The triangle of a face is made from the rest positions of its corners and the direction of warp,
//! and has the number of the face. Edits follow with the cost of what they touch: a split or a
//! merge relabels corners, so a split changes no energy at all; the parts of a divided face
//! deform as it did, so together they hold what it held; where a vertex slides the triangles
//! around it are made anew.

use tearmesh::geometry::{Point, Vector};
use tearmesh::{FaceId, HalfEdgeId, Insert, Merge, Split};

use crate::implicit::{Triangle, triangle};
use crate::sheet::{Cloth, ClothError};
use crate::strain::{default_warp, material};

/// How triangles resist: `E_u`, `E_v` and G as moduli of the sheet, Poisson's ratio zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weave {
    /// The modulus along warp, in N/m; positive.
    pub warp_n_per_m: f64,
    /// The modulus along weft, across warp, in N/m; positive.
    pub weft_n_per_m: f64,
    /// The shear modulus, in N/m; zero or more.
    pub shear_n_per_m: f64,
    /// The direction of warp in space where the cloth is at rest. In each face it is projected
    /// onto that; weft is across it. [`Cloth::with_warps`] has one for each face instead.
    pub warp: Vector,
}

/// The direction in which the first coordinate of a texture grows in a triangle: warp, for a
/// garment that was drawn as flat pieces.
///
/// `None` where the texture coordinates span no area.
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

impl Weave {
    /// The first number that can be no modulus: its field, and the number as given.
    pub(super) fn fault(&self) -> Option<(&'static str, f64)> {
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        [
            ("weave.warp_n_per_m", self.warp_n_per_m, true),
            ("weave.weft_n_per_m", self.weft_n_per_m, true),
            ("weave.shear_n_per_m", self.shear_n_per_m, false),
        ]
        .into_iter()
        .find(|&(_, given, is_needed)| !usable(given) || is_needed && given == 0.0)
        .map(|(field, given, _)| (field, given))
    }
}

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
        for child in insert.children {
            if child.face != child.parent && !self.warps.is_empty() {
                self.warps.push(self.warps[child.parent.index()]);
            }
        }
        if !self.is_woven() {
            return 0.0;
        }
        let particles = self.positions().len();
        let mut gained = 0.0;
        for family in insert.families() {
            gained -= self.triangle_energy(family[0].parent.index());
            for child in family {
                let triangle = self.woven(child.face);
                let triangles = &mut self.system.model.triangles;
                if child.face == child.parent {
                    triangles.set(child.face.index(), triangle);
                } else {
                    let index = triangles.as_slice().len();
                    let face = child.face.index();
                    assert_eq!(index, face, "triangles are in step with faces");
                    triangles.push(particles, triangle);
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
        for &t in &around {
            let triangle = self.woven(FaceId::new(t).expect("I1: ids fit"));
            self.system.model.triangles.set(t, triangle);
        }
        for t in around {
            let corners = self.system.triangles()[t].vertices;
            self.system.touched(&corners.map(|v| v as usize));
        }
    }

    fn triangle_energy(&self, t: usize) -> f64 {
        let triangle = &self.system.triangles()[t];
        triangle::energy(triangle, triangle::corners(triangle, self.positions()))
    }
}
