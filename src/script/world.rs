//! Running a script.

use super::{Fault, Operation, Script, Shape, Spot, Triangles};
use crate::attribute::PerCorner;
use crate::edit::{Cursor, Edits};
use crate::geometry::{Plane, Point, Ray, Vector};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::insert::{self, ChordEnd, Plan, PointId};
use crate::mass::Masses;
use crate::mend::{self, Stitch};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::{CutMethod, CutReport, CutTips, Scissor};
use crate::slide;
use crate::split::{self, SplitRefusal};

/// A mesh together with one follower of each kind.
#[derive(Clone, Debug)]
pub struct World {
    /// The mesh that the operations change.
    pub mesh: Mesh,
    /// The log of edits since it was last cleared.
    pub edits: Edits,
    /// The positions of the vertices, which have seen every edit.
    pub positions: Positions,
    /// The masses by area with density 1, which have seen every edit.
    pub area: Masses,
    /// The masses by halves with density 1, which have seen every edit. `None` from the first
    /// insertion on, which they cannot follow.
    pub half: Option<Masses>,
    /// The triangles of the mesh, which have seen every edit.
    pub triangles: Triangles,
    /// A second copy of the triangles, replayed only just before the log is cleared, so that it
    /// replays many edits at once.
    pub late_triangles: Triangles,
    /// The position of each corner, which has seen every edit. It equals the position of the
    /// corner's vertex up to rounding, until copies that slid apart are merged. The merged vertex
    /// then lies between them, and its corner values do not change.
    pub corners: PerCorner<[f64; 3]>,
}

/// A vertex that a script requested to insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// A vertex on an edge: see [`Plan::on_edge`].
    Edge {
        /// The half-edge along which `t` is measured.
        half_edge: HalfEdgeId,
        /// The fraction of the way from the origin of the half-edge to its target.
        t: f64,
    },
    /// A vertex in a face: see [`Plan::in_face`].
    Face {
        /// The face that gets the vertex.
        face: FaceId,
        /// The weights of the face's corners, in their order.
        weights: [f64; 3],
    },
}

/// An end of a chord that a script requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedEnd {
    /// The corner at which this half-edge starts.
    Corner(HalfEdgeId),
    /// A requested vertex, as its index among the requested insertions, from 0.
    Point(usize),
}

/// A step of a [`World`]: an attempted operation with its outcome. An edit is identified by the place
/// in the log just before its record.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Step<'s> {
    /// The mesh was built. This is the first step of a script, and occurs once.
    Built,
    /// A split by a set of faces was attempted.
    Split {
        /// The vertex that was to be split.
        vertex: VertexId,
        /// The faces that were to move to the new vertex.
        faces: &'s [FaceId],
        /// The edit, or the reason for its refusal.
        outcome: Result<Cursor, SplitRefusal>,
    },
    /// A split by a plane through the vertex was attempted.
    Plane {
        /// The vertex that was to be split.
        vertex: VertexId,
        /// The normal of the plane, which need not be a unit vector.
        normal: [f64; 3],
        /// The edit, or `None` if all faces were on one side of the plane.
        outcome: Option<Cursor>,
    },
    /// A cut was carried out by the method `partition`.
    Cut {
        /// The place in the log before the first edit of the cut. All later edits belong to the cut.
        first: Cursor,
        /// The measurements of the cut.
        report: &'s CutReport,
    },
    /// An insertion was attempted.
    Insert {
        /// The vertices that were to be inserted.
        asked: &'s [Asked],
        /// The face and the ends of the required chord, or `None` if no chord was required.
        chord: Option<(FaceId, [AskedEnd; 2])>,
        /// The edit, or the reason for its refusal.
        outcome: Result<Cursor, insert::InsertRefusal>,
    },
    /// A merge was attempted.
    Merge {
        /// The first of the two vertices.
        one: VertexId,
        /// The second of the two vertices.
        other: VertexId,
        /// The weights of the first and the second vertex.
        weights: [f64; 2],
        /// The edit, or the reason for its refusal.
        outcome: Result<Cursor, mend::MergeRefusal>,
    },
    /// A slide was attempted.
    Slide {
        /// The vertex that was to slide.
        vertex: VertexId,
        /// The vertex toward which it was to slide.
        toward: VertexId,
        /// The fraction of the way to slide, strictly between 0 and 1 unless refused.
        t: f64,
        /// The edit, or the reason for its refusal.
        outcome: Result<Cursor, slide::SlideRefusal>,
    },
    /// Chosen vertices with the same root were sewn together.
    Sewn {
        /// The place in the log before the first edit. All later edits are merges of this step.
        first: Cursor,
        /// The stitches that were requested.
        stitches: &'s [Stitch],
        /// The number of merges, which is the number of edits.
        merges: usize,
    },
    /// All followers replayed the log, and the log was cleared.
    Cleared,
    /// Nothing was done, because the normal was zero or the rays spanned no plane.
    Nothing,
}

impl Script {
    /// Builds the mesh, applies the operations in order, and calls `observe` with the world after
    /// each step. All followers except [`World::late_triangles`] have then replayed the log.
    ///
    /// [`Operation::Tear`] consists of many steps, one for each split. A cut is one step.
    pub fn run(&self, mut observe: impl FnMut(&World, &Step<'_>)) -> World {
        let mut world = World::new(&self.shape);
        observe(&world, &Step::Built);
        for operation in &self.operations {
            world.apply(operation, &mut observe);
        }
        world
    }
}

impl World {
    /// Creates a world from the mesh of a shape, before any operation.
    ///
    /// # Panics
    ///
    /// If a number of the shape is below its lower limit.
    #[must_use]
    pub fn new(shape: &Shape) -> World {
        let (mesh, positions) = shape.make();
        World::of(mesh, positions)
    }

    /// Creates a world from a mesh, before any operation.
    ///
    /// # Panics
    ///
    /// If the mesh has no area, if its area is too large or too small for exact masses, or if there
    /// are fewer positions than vertices.
    #[must_use]
    pub fn of(mesh: Mesh, positions: Positions) -> World {
        let masses = "a mesh with an area has masses";
        let triangles = Triangles::new(&mesh);
        let place = |h| positions.at(mesh.origin(h)).coords.into();
        World {
            area: Masses::area(&mesh, &positions, 1.0).expect(masses),
            half: Some(Masses::half(&mesh, &positions, 1.0).expect(masses)),
            late_triangles: triangles.clone(),
            triangles,
            corners: PerCorner::new(mesh.half_edges().map(place).collect()),
            edits: Edits::new(),
            mesh,
            positions,
        }
    }

    /// Applies an operation, and calls `observe` after each of its steps.
    pub fn apply(&mut self, operation: &Operation, mut observe: impl FnMut(&World, &Step<'_>)) {
        match *operation {
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
            Operation::Insert {
                half_edge,
                ref spots,
                chord,
            } => self.insert_at(half_edge, spots, chord, &mut observe),
            Operation::Merge {
                vertex,
                other,
                any,
                weights,
            } => {
                let one = self.torn_vertex(vertex);
                let other = if any {
                    self.vertex(other)
                } else {
                    let root = self.mesh.root(one);
                    let copies: Vec<_> = self
                        .mesh
                        .vertices()
                        .filter(|&v| self.mesh.root(v) == root)
                        .collect();
                    copies[usize::from(other) % copies.len()]
                };
                self.merge(one, other, weights.map(f64::from), &mut observe);
            }
            Operation::Slide {
                vertex,
                toward,
                any,
                part,
            } => {
                let v = self.vertex(vertex);
                let neighbours = self.neighbours(v);
                let toward = match neighbours.len() {
                    count @ 1.. if !any => neighbours[usize::from(toward) % count],
                    _ => self.vertex(toward),
                };
                self.slide(v, toward, f64::from(part) / 64.0, &mut observe);
            }
            Operation::Sew { mask } => self.sew_chosen(mask, &mut observe),
            Operation::Tear => {
                for v in self.mesh.vertices() {
                    for &face in self.faces(v).iter().skip(1) {
                        self.split(v, &[face], &mut observe);
                    }
                }
            }
            Operation::Clear => {
                self.edits.replay(&mut self.late_triangles);
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

    fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let faces = self.mesh.faces_of(v);
        let corners = faces.flat_map(|f| self.mesh.face_vertices(f));
        let mut neighbours: Vec<VertexId> = corners.filter(|&w| w != v).collect();
        neighbours.sort();
        neighbours.dedup();
        neighbours
    }

    /// Splits a vertex by a set of faces, and calls `observe` after this step.
    pub fn split(
        &mut self,
        vertex: VertexId,
        faces: &[FaceId],
        mut observe: impl FnMut(&World, &Step<'_>),
    ) {
        let outcome = split::vertex(&mut self.mesh, vertex, faces, &mut self.edits);
        let outcome = outcome.map(|split| split.before);
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
        let outcome = split.map(|split| split.before);
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
        tips: CutTips,
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
        let Ok(scissor) = Scissor::new(a, b) else {
            return observe(self, &Step::Nothing);
        };
        let first = self.edits.cursor();
        let (_, report) = scissor
            .through(through)
            .tips(tips)
            .cut_measured(
                CutMethod::Partition,
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

    /// The vertex with this number among those that have copies, or among all vertices if none has.
    fn torn_vertex(&self, number: u16) -> VertexId {
        let mut copies = vec![0; self.mesh.vertex_count()];
        for v in self.mesh.vertices() {
            copies[self.mesh.root(v).index()] += 1;
        }
        let has_copies = |&v: &VertexId| copies[self.mesh.root(v).index()] > 1;
        let torn: Vec<VertexId> = self.mesh.vertices().filter(has_copies).collect();
        match torn.len() {
            0 => self.vertex(number),
            count => torn[usize::from(number) % count],
        }
    }

    /// The insertion at these spots, counted from a half-edge.
    fn insert_at(
        &mut self,
        half_edge: u16,
        spots: &[Spot],
        chord: Option<[u8; 2]>,
        observe: &mut impl FnMut(&World, &Step<'_>),
    ) {
        let count = self.mesh.half_edge_count() as u32;
        let first = u32::from(half_edge) % count;
        let at = |offset: u8| HalfEdgeId::from_u32((first + u32::from(offset)) % count);
        let ask = |&spot: &Spot| match spot {
            Spot::Edge { offset, part } => Asked::Edge {
                half_edge: at(offset),
                t: f64::from(part) / 64.0,
            },
            Spot::Face { offset, weights } => Asked::Face {
                face: at(offset).face(),
                weights: weights.map(f64::from),
            },
        };
        let asked: Vec<Asked> = spots.iter().map(ask).collect();
        let face = match asked.first() {
            None => at(0).face(),
            Some(Asked::Edge { half_edge, .. }) => half_edge.face(),
            Some(&Asked::Face { face, .. }) => face,
        };
        let end = |number: u8| match usize::from(number) % (3 + asked.len()) {
            corner @ 0..3 => AskedEnd::Corner(face.half_edges()[corner]),
            point => AskedEnd::Point(point - 3),
        };
        let chord = chord.map(|two| (face, two.map(end)));
        self.insert(&asked, chord, observe);
    }

    /// Inserts vertices, and calls `observe` after this step. `chord` is a face and the ends of an
    /// edge that must cross it, or `None`.
    pub fn insert(
        &mut self,
        asked: &[Asked],
        chord: Option<(FaceId, [AskedEnd; 2])>,
        mut observe: impl FnMut(&World, &Step<'_>),
    ) {
        let mut plan = Plan::new();
        let points: Vec<PointId> = asked
            .iter()
            .map(|&ask| match ask {
                Asked::Edge { half_edge, t } => plan.on_edge(half_edge, t),
                Asked::Face { face, weights } => plan.in_face(face, weights),
            })
            .collect();
        if let Some((face, ends)) = chord {
            let end = |end: AskedEnd| match end {
                AskedEnd::Corner(h) => ChordEnd::Corner(h),
                AskedEnd::Point(i) => ChordEnd::Point(points[i]),
            };
            plan.chord(face, ends.map(end));
        }
        let outcome = plan.apply(&mut self.mesh, &mut self.edits);
        let outcome = outcome.map(|insert| insert.before);
        if outcome.is_ok() {
            self.half = None;
        }
        self.replay();
        let step = Step::Insert {
            asked,
            chord,
            outcome,
        };
        observe(self, &step);
    }

    /// Merges two vertices, and calls `observe` after this step.
    pub fn merge(
        &mut self,
        one: VertexId,
        other: VertexId,
        weights: [f64; 2],
        mut observe: impl FnMut(&World, &Step<'_>),
    ) {
        let merge = mend::merge(&mut self.mesh, one, other, weights, &mut self.edits);
        let outcome = merge.map(|merge| merge.before);
        self.replay();
        let step = Step::Merge {
            one,
            other,
            weights,
            outcome,
        };
        observe(self, &step);
    }

    /// Slides a vertex toward another, and calls `observe` after this step.
    pub fn slide(
        &mut self,
        vertex: VertexId,
        toward: VertexId,
        t: f64,
        mut observe: impl FnMut(&World, &Step<'_>),
    ) {
        let slide = slide::toward(&self.mesh, vertex, toward, t, &mut self.edits);
        let outcome = slide.map(|slide| slide.before);
        self.replay();
        let step = Step::Slide {
            vertex,
            toward,
            t,
            outcome,
        };
        observe(self, &step);
    }

    fn sew_chosen(&mut self, mask: u16, observe: &mut impl FnMut(&World, &Step<'_>)) {
        let chosen = |v: VertexId| mask >> (v.index() % 16) & 1 == 1;
        let stitches = mend::stitches(&self.mesh, chosen);
        let first = self.edits.cursor();
        let merges = mend::sew(
            &mut self.mesh,
            &self.positions,
            &stitches,
            |v| self.area.at(v),
            f64::INFINITY,
            &mut self.edits,
        )
        .expect("copies have one root and a mass");
        self.replay();
        let step = Step::Sewn {
            first,
            stitches: &stitches,
            merges,
        };
        observe(self, &step);
    }

    fn replay(&mut self) {
        if let Some(half) = &mut self.half {
            self.edits.replay(half);
        }
        let beside = (&mut self.triangles, &mut self.corners);
        self.edits
            .replay(&mut (&mut self.positions, &mut self.area, beside));
    }
}
