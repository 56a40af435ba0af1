//! Running a script.

use super::cut::CutSettings;
use super::{Fault, Operation, Script, Spot};
use crate::attribute::PerCorner;
use crate::edit::{Cursor, Edit, Edits};
use crate::geometry::Plane;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::insert::{self, ChordEnd, Plan, PointId};
use crate::mass::Masses;
use crate::mend::{self, Stitch};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::{CutEnd, CutError, CutReport, Scissor};
use crate::slide;
use crate::split::{self, SplitRefusal};
use crate::unsewn::UnsewnSeams;

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
    /// The position of each corner, which has seen every edit. It equals the position of the
    /// corner's vertex up to rounding, until copies that slid apart are merged. The merged vertex
    /// then lies between them, and its corner values do not change.
    pub corners: PerCorner<[f64; 3]>,
    /// The beginning and the end of the last polyline of cuts between rays, which have seen every edit. A cut
    /// that continues moves the end. `None` before the first cut, and after a cut by a plane.
    pub polyline: Option<[CutEnd; 2]>,
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
    /// A cut was carried out.
    Cut {
        /// The place in the log before the first edit of the cut. All later edits belong to the cut.
        first: Cursor,
        /// The scissor, with its settings.
        scissor: &'s Scissor,
        /// The method, and whether seams were closed while the mesh was cut.
        settings: CutSettings,
        /// The measurements of the cut.
        report: &'s CutReport,
    },
    /// An insertion was attempted.
    Insert {
        /// The vertices that were to be inserted, and the chord, if one was required.
        plan: &'s Plan,
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
    /// Nothing was done: the normal was zero, the rays spanned no plane, there was no cut to go on from, or a
    /// cut was refused.
    Nothing,
}

/// Sees the world after each step.
type Observe<'o> = dyn FnMut(&World, &Step<'_>) + 'o;

impl Script {
    /// Builds the mesh, applies the operations in order, and calls `observe` with the world after
    /// each step. All followers have then replayed the log.
    ///
    /// [`Operation::Tear`] consists of many steps, one for each split. A cut is one step.
    pub fn run(&self, mut observe: impl FnMut(&World, &Step<'_>)) -> World {
        let (mesh, positions) = self.shape.make();
        let mut world = World::of(mesh, positions);
        observe(&world, &Step::Built);
        for operation in &self.operations {
            world.apply(operation, &mut observe);
        }
        world
    }
}

impl World {
    /// Creates a world from a mesh, before any operation.
    ///
    /// # Panics
    ///
    /// If the mesh has no area, if its area is too large or too small for exact masses, or if there
    /// are fewer positions than vertices.
    #[must_use]
    pub fn of(mesh: Mesh, positions: Positions) -> World {
        let masses = "a mesh with an area has masses";
        let place = |h| positions.at(mesh.origin(h)).coords.into();
        let mut world = World {
            area: Masses::area(&mesh, &positions, 1.0).expect(masses),
            half: Some(Masses::half(&mesh, &positions, 1.0).expect(masses)),
            polyline: None,
            corners: PerCorner::new(mesh.half_edges().map(place).collect()),
            edits: Edits::new(),
            mesh,
            positions,
        };
        let begin = &mut (&mut world.positions, &mut world.corners);
        world.edits.replay(begin);
        world
    }

    /// Applies an operation, and calls `observe` after each of its steps.
    ///
    /// # Panics
    ///
    /// If the mesh has no vertex or no face.
    pub fn apply(&mut self, operation: &Operation, observe: &mut Observe<'_>) {
        match *operation {
            Operation::Split {
                vertex,
                mask,
                fault,
            } => {
                let vertex = self.vertex(vertex);
                let faces = self.some_faces(vertex, mask, fault);
                self.split(vertex, &faces, observe);
            }
            Operation::Plane { vertex, normal } => {
                self.split_by_plane(self.vertex(vertex), normal.map(f64::from), observe);
            }
            Operation::Cut {
                ref path,
                far,
                settings,
            } => {
                let polyline = self.polyline.as_ref();
                match path.scissor(far, &self.mesh, &self.positions, polyline) {
                    Some(scissor) => {
                        let scissor = settings.of(scissor);
                        self.cut(&scissor, settings, path.continues(), observe);
                    }
                    None => observe(self, &Step::Nothing),
                }
            }
            Operation::Insert {
                half_edge,
                ref spots,
                chord,
            } => {
                let plan = self.plan(half_edge, spots, chord);
                self.insert(&plan, observe);
            }
            Operation::Merge {
                vertex,
                other,
                any,
                weights,
            } => {
                let [one, other] = self.copies(vertex, other, any);
                self.merge(one, other, weights.map(f64::from), observe);
            }
            Operation::Slide {
                vertex,
                toward,
                any,
                part,
            } => {
                let vertex = self.vertex(vertex);
                let toward = self.neighbour(vertex, toward, any);
                self.slide(vertex, toward, f64::from(part) / 64.0, observe);
            }
            Operation::Sew { mask } => self.sew_chosen(mask, observe),
            Operation::Tear => self.tear_apart(observe),
            Operation::Clear => {
                self.edits.clear();
                observe(self, &Step::Cleared);
            }
        }
    }

    fn vertex(&self, number: u16) -> VertexId {
        VertexId::from_u32(u32::from(number) % self.mesh.vertex_count() as u32)
    }

    /// The vertex with this number among those that are chosen, or among all vertices if none is.
    fn among(&self, number: u16, is_chosen: impl Fn(VertexId) -> bool) -> VertexId {
        let chosen = self.mesh.vertices().filter(|&v| is_chosen(v));
        let chosen: Vec<VertexId> = chosen.collect();
        match chosen.len() {
            0 => self.vertex(number),
            count => chosen[usize::from(number) % count],
        }
    }

    fn faces(&self, v: VertexId) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self.mesh.faces_of(v).collect();
        faces.sort();
        faces
    }

    /// The faces of a vertex that a mask chooses, and the fault in their list.
    fn some_faces(&self, v: VertexId, mask: u16, fault: Fault) -> Vec<FaceId> {
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
        faces
    }

    /// Two vertices to be merged: one that has copies, if any vertex has, and one of its copies or any vertex.
    fn copies(&self, one: u16, other: u16, any: bool) -> [VertexId; 2] {
        let roots = self.mesh.all_roots();
        let mut copies = vec![0; roots.len()];
        roots.iter().for_each(|root| copies[root.index()] += 1);
        let root = |v: VertexId| roots[v.index()];
        let one = self.among(one, |v| copies[root(v).index()] > 1);
        let other = self.among(other, |v| any || root(v) == root(one));
        [one, other]
    }

    /// A vertex toward which another may slide: a neighbour of it, if it has one, or any vertex.
    fn neighbour(&self, v: VertexId, number: u16, any: bool) -> VertexId {
        let faces = self.mesh.faces_of(v);
        let around: Vec<_> = faces.flat_map(|f| self.mesh.face_vertices(f)).collect();
        self.among(number, |w| any || (w != v && around.contains(&w)))
    }

    /// The insertion at these spots, counted from a half-edge.
    fn plan(&self, half_edge: u16, spots: &[Spot], chord: Option<[u8; 2]>) -> Plan {
        let count = self.mesh.half_edge_count() as u32;
        let first = u32::from(half_edge) % count;
        let at = |offset: u8| HalfEdgeId::from_u32((first + u32::from(offset)) % count);
        let mut plan = Plan::new();
        let add = |spot: &Spot| match *spot {
            Spot::Edge { offset, part } => plan.on_edge(at(offset), f64::from(part) / 64.0),
            Spot::Face { offset, weights } => {
                plan.in_face(at(offset).face(), weights.map(f64::from))
            }
        };
        let points: Vec<PointId> = spots.iter().map(add).collect();
        let offset_of = |spot: &Spot| match *spot {
            Spot::Edge { offset, .. } | Spot::Face { offset, .. } => offset,
        };
        let f = at(spots.first().map_or(0, offset_of)).face();
        let end = |number: u8| match usize::from(number) % (3 + points.len()) {
            corner @ 0..3 => ChordEnd::Corner(f.half_edges()[corner]),
            point => ChordEnd::Point(points[point - 3]),
        };
        if let Some(ends) = chord {
            plan.chord(f, ends.map(end));
        }
        plan
    }

    /// Splits a vertex by a set of faces, and calls `observe` after this step.
    pub fn split(&mut self, vertex: VertexId, faces: &[FaceId], observe: &mut Observe<'_>) {
        let split = split::vertex(&mut self.mesh, vertex, faces, &mut self.edits);
        let outcome = split.map(|split| split.before);
        let step = Step::Split {
            vertex,
            faces,
            outcome,
        };
        self.end(&step, observe);
    }

    fn split_by_plane(&mut self, vertex: VertexId, normal: [f64; 3], observe: &mut Observe<'_>) {
        let Ok(plane) = Plane::new(self.positions.at(vertex), normal.into()) else {
            return observe(self, &Step::Nothing);
        };
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let split = split::by_plane(mesh, vertex, &plane, &self.positions, edits);
        let outcome = split.map(|split| split.before);
        let step = Step::Plane {
            vertex,
            normal,
            outcome,
        };
        self.end(&step, observe);
    }

    /// Splits off all faces of each vertex but one.
    fn tear_apart(&mut self, observe: &mut Observe<'_>) {
        for v in self.mesh.vertices() {
            for &face in self.faces(v).iter().skip(1) {
                self.split(v, &[face], observe);
            }
        }
    }

    fn cut(
        &mut self,
        scissor: &Scissor,
        settings: CutSettings,
        continues: bool,
        observe: &mut Observe<'_>,
    ) {
        let first = self.edits.cursor();
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        let seams = settings.seams.then(|| {
            UnsewnSeams::find(mesh, positions)
                .close(mesh)
                .starting_at(first)
        });
        let cut = scissor.cut_measured(settings.method, mesh, positions, &mut self.edits);
        if let Some(mut closed) = seams {
            self.edits.replay(&mut closed);
            closed.reopen(mesh);
        }
        let (cut, report) = match cut {
            Ok(made) => made,
            Err(CutError::RaysCross { .. } | CutError::TooShort { .. }) => {
                return observe(self, &Step::Nothing);
            }
            Err(error) => panic!("all that follows is in step: {error}"),
        };
        let begins = self.polyline.take().filter(|_| continues);
        self.polyline = cut.ends().cloned().map(|[begin, end]| {
            let begin = begins.map_or(begin, |[begin, _]| begin);
            [begin, end]
        });
        if self
            .edits
            .since(first)
            .any(|edit| matches!(edit, Edit::Insert(_)))
        {
            self.half = None;
        }
        let step = Step::Cut {
            first,
            scissor,
            settings,
            report: &report,
        };
        self.end(&step, observe);
    }

    /// Inserts vertices, and calls `observe` after this step.
    pub fn insert(&mut self, plan: &Plan, observe: &mut Observe<'_>) {
        let insert = plan.apply(&mut self.mesh, &mut self.edits);
        let outcome = insert.map(|insert| insert.before);
        if outcome.is_ok() {
            self.half = None;
        }
        self.end(&Step::Insert { plan, outcome }, observe);
    }

    /// Merges two vertices, and calls `observe` after this step.
    pub fn merge(
        &mut self,
        one: VertexId,
        other: VertexId,
        weights: [f64; 2],
        observe: &mut Observe<'_>,
    ) {
        let merge = mend::merge(&mut self.mesh, one, other, weights, &mut self.edits);
        let outcome = merge.map(|merge| merge.before);
        let step = Step::Merge {
            one,
            other,
            weights,
            outcome,
        };
        self.end(&step, observe);
    }

    fn slide(&mut self, vertex: VertexId, toward: VertexId, t: f64, observe: &mut Observe<'_>) {
        let slide = slide::toward(&mut self.mesh, vertex, toward, t, &mut self.edits);
        let outcome = slide.map(|slide| slide.before);
        let step = Step::Slide {
            vertex,
            toward,
            t,
            outcome,
        };
        self.end(&step, observe);
    }

    /// Sews the copies of the vertices that a mask chooses.
    fn sew_chosen(&mut self, mask: u16, observe: &mut Observe<'_>) {
        let chosen = |v: VertexId| mask >> (v.index() % 16) & 1 == 1;
        let stitches = mend::stitches(&self.mesh, chosen);
        let first = self.edits.cursor();
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let (weight, far) = (|v| self.area.at(v), f64::INFINITY);
        let merges = mend::sew(mesh, &self.positions, &stitches, weight, far, edits);
        let step = Step::Sewn {
            first,
            stitches: &stitches,
            merges: merges.expect("copies have one root and a mass"),
        };
        self.end(&step, observe);
    }

    /// Lets the followers replay a step, and shows it.
    fn end(&mut self, step: &Step<'_>, observe: &mut Observe<'_>) {
        if let Some(half) = &mut self.half {
            self.edits.replay(half);
        }
        let beside = (&mut self.positions, &mut self.area, &mut self.corners);
        self.edits.replay(&mut { beside });
        for end in self.polyline.iter_mut().flatten() {
            self.edits.replay(end);
        }
        observe(self, step);
    }
}
