//! Running a script.

use super::{Fault, Operation, Script, Shape};
use crate::attribute::{PerCorner, PerVertex};
use crate::edit::Edits;
use crate::geometry::{Plane, Point, Ray, Vector};
use crate::id::{FaceId, VertexId};
use crate::mass::Masses;
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::{CutReport, Method, Scissor, Tips};
use crate::split::{self, Refusal};

/// A mesh and everything that can follow it.
#[derive(Clone, Debug)]
pub struct World {
    /// The mesh.
    pub mesh: Mesh,
    /// The log of edits since it was last cleared.
    pub edits: Edits,
    /// Positions, which have seen every edit.
    pub positions: Positions,
    /// Masses by area with density 1, which have seen every edit.
    pub area: Masses,
    /// Masses by halves with density 1, which have seen every edit.
    pub half: Masses,
    /// For each vertex the one that it was at first. Has seen every edit.
    pub roots: PerVertex<f64>,
    /// The same, but replayed only just before the log is cleared: by many edits at once.
    pub late_roots: PerVertex<f64>,
    /// For each corner its half-edge. Has seen every edit.
    pub corners: PerCorner<f64>,
}

/// What was done to a [`World`]. Edits are named by their numbers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Step<'s> {
    /// The mesh was built. Comes first, once.
    Built,
    /// A split by a set of faces was tried.
    Split {
        /// The vertex.
        vertex: VertexId,
        /// The faces that were to move.
        faces: &'s [FaceId],
        /// The edit, or why there was none.
        outcome: Result<u64, Refusal>,
    },
    /// A split by a plane through the vertex was tried.
    Plane {
        /// The vertex.
        vertex: VertexId,
        /// The normal of the plane.
        normal: [f64; 3],
        /// The edit, if there was one.
        outcome: Option<u64>,
    },
    /// A cut was made.
    Cut {
        /// The first edit of the cut; those from there on are the cut's.
        first: u64,
        /// What the cut reported.
        report: &'s CutReport,
    },
    /// All followers replayed the log, and it was cleared.
    Cleared,
    /// The operation was none: a normal of zero, or rays that span no plane.
    Nothing,
}

impl Script {
    /// Makes the mesh, applies the operations, and shows the observer the world after
    /// each step. All followers but [`World::late_roots`] have replayed by then.
    ///
    /// Tearing to pieces is many steps, each a split. A cut is one.
    pub fn run(&self, mut observe: impl FnMut(&World, &Step<'_>)) -> World {
        let mut world = World::new(&self.shape);
        observe(&world, &Step::Built);
        for &operation in &self.operations {
            world.apply(operation, &mut observe);
        }
        world
    }
}

impl World {
    /// The mesh of this shape, with nothing done to it yet.
    ///
    /// # Panics
    ///
    /// If the shape's numbers are below the limits given there.
    #[must_use]
    pub fn new(shape: &Shape) -> World {
        let (mesh, positions) = shape.make();
        let masses = "a mesh with an area has masses";
        let roots = PerVertex::new((0..mesh.vertex_count() as u32).map(f64::from).collect());
        World {
            area: Masses::area(&mesh, &positions, 1.0).expect(masses),
            half: Masses::half(&mesh, &positions, 1.0).expect(masses),
            late_roots: roots.clone(),
            roots,
            corners: PerCorner::new((0..mesh.half_edge_count() as u32).map(f64::from).collect()),
            edits: Edits::new(),
            mesh,
            positions,
        }
    }

    /// Applies an operation, and shows the observer each step of it.
    pub fn apply(&mut self, operation: Operation, mut observe: impl FnMut(&World, &Step<'_>)) {
        match operation {
            Operation::Split {
                vertex,
                mask,
                fault,
            } => {
                let v = self.vertex(vertex);
                let mut faces = self.faces(v);
                let mut bit = 0..;
                faces.retain(|_| bit.next().is_some_and(|i: u32| mask >> (i % 16) & 1 == 1));
                match fault {
                    Fault::Repeated(i) if !faces.is_empty() => {
                        faces.push(faces[usize::from(i) % faces.len()]);
                    }
                    Fault::Foreign(i) => {
                        let number = usize::from(i) % self.mesh.face_count();
                        faces.push(FaceId::from_u32(number as u32));
                    }
                    _ => {}
                }
                self.split(v, &faces, &mut observe);
            }
            Operation::Plane { vertex, normal } => {
                let v = self.vertex(vertex);
                self.plane(v, normal.map(f64::from), &mut observe);
            }
            Operation::Cut {
                through,
                tips,
                rays,
            } => self.cut(through, tips, rays, &mut observe),
            Operation::Tear => {
                for v in self.mesh.vertices() {
                    for &face in self.faces(v).iter().skip(1) {
                        self.split(v, &[face], &mut observe);
                    }
                }
            }
            Operation::Clear => {
                self.edits.replay(&mut self.late_roots);
                self.edits.clear();
                observe(self, &Step::Cleared);
            }
        }
    }

    fn vertex(&self, number: u16) -> VertexId {
        VertexId::from_u32(u32::from(number) % self.mesh.vertex_count() as u32)
    }

    fn faces(&self, v: VertexId) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self.mesh.faces_of(v).collect();
        faces.sort();
        faces
    }

    fn split(
        &mut self,
        vertex: VertexId,
        faces: &[FaceId],
        observe: &mut impl FnMut(&World, &Step<'_>),
    ) {
        let outcome = split::faces(&mut self.mesh, vertex, faces, &mut self.edits);
        let outcome = outcome.map(|split| split.number);
        self.replay();
        let step = Step::Split {
            vertex,
            faces,
            outcome,
        };
        observe(self, &step);
    }

    fn plane(
        &mut self,
        vertex: VertexId,
        normal: [f64; 3],
        observe: &mut impl FnMut(&World, &Step<'_>),
    ) {
        let Ok(plane) = Plane::new(self.positions.at(vertex), Vector::from(normal)) else {
            return observe(self, &Step::Nothing);
        };
        let split = split::by_plane(
            &mut self.mesh,
            vertex,
            &plane,
            &self.positions,
            &mut self.edits,
        );
        let outcome = split.map(|split| split.number);
        self.replay();
        let step = Step::Plane {
            vertex,
            normal,
            outcome,
        };
        observe(self, &step);
    }

    fn cut(
        &mut self,
        through: bool,
        tips: Tips,
        rays: [[[i8; 3]; 2]; 2],
        observe: &mut impl FnMut(&World, &Step<'_>),
    ) {
        let [a, b] = rays.map(|[origin, direction]| {
            let origin = origin.map(|x| f64::from(x) / 32.0);
            Ray::new(Point::from(origin), Vector::from(direction.map(f64::from)))
        });
        let (Ok(a), Ok(b)) = (a, b) else {
            return observe(self, &Step::Nothing);
        };
        let Ok(scissor) = Scissor::new(&a, &b) else {
            return observe(self, &Step::Nothing);
        };
        let first = self.edits.next_number();
        let report = scissor
            .through(through)
            .tips(tips)
            .cut(
                Method::Partition,
                &mut self.mesh,
                &mut self.positions,
                &mut self.edits,
            )
            .expect("positions are in step");
        self.replay();
        let step = Step::Cut {
            first,
            report: &report,
        };
        observe(self, &step);
    }

    fn replay(&mut self) {
        let masses = (&mut self.area, &mut self.half);
        let attributes = (&mut self.roots, &mut self.corners);
        self.edits
            .replay(&mut (&mut self.positions, masses, attributes));
    }
}
