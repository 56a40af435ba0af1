//! Cuts of all methods on a small mesh, mended in part or as a whole: what holds whatever the
//! rays, the snap and the order.
//!
//! The fuzz target `cut_mend`, its replay and random bytes use this. The oracle of straight cuts
//! judges generic cuts; here vertices lie on planes, tips on edges and cuts on older cuts.

use tearmesh::script::Script;
use tearmesh::{
    Cursor, CutEnd, CutLayers, CutMethod, Edits, FaceId, Masses, Mesh, PerCorner, Point, Positions,
    Ray, Scissor, Vector, VertexId, mend,
};

/// A mesh, and what is done to it.
#[derive(Debug)]
pub(crate) struct Case {
    mesh: Mesh,
    positions: Positions,
    steps: Vec<Step>,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Cut {
        rays: [[Point; 2]; 2],
        span: Span,
        method: CutMethod,
        snap: f64,
        snap_move: bool,
        through: bool,
        /// Whether to go on from the end of the cut before, to the second ray.
        continued: bool,
    },
    /// Sew what is this near to a vertex.
    Mend { near: u8, radius: f64 },
}

/// What rays stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Span {
    /// Two rays, and all that their plane meets between them.
    All,
    /// Two rays, and what they see of it first.
    First,
    /// The plane alone.
    Plane,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    pub(crate) cuts: usize,
    /// Cuts that split something: by a plane alone, and of what rays see first.
    pub(crate) by_planes: usize,
    pub(crate) of_first: usize,
    pub(crate) inserted: usize,
    pub(crate) splits: usize,
    pub(crate) merges: usize,
}

const SNAPS: [f64; 6] = [0.0, 0.05, 0.2, 0.45, 1e-9, f64::NAN];
const STEPS_MAX: usize = 6;

impl Case {
    /// Any bytes are a case: some steps, and the rest is a mesh, as at the beginning of a script.
    /// Missing bytes count as zero.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Case {
        let mut bytes = Bytes(bytes);
        let count = 1 + usize::from(bytes.byte()) % STEPS_MAX;
        let kinds: Vec<[u8; 14]> = (0..count)
            .map(|_| std::array::from_fn(|_| bytes.byte()))
            .collect();
        let (mesh, positions) = Script::from_bytes(bytes.0).shape.make();
        let steps = kinds.iter().map(|kind| Step::from_bytes(kind, &positions));
        Case {
            steps: steps.collect(),
            mesh,
            positions,
        }
    }

    pub(crate) fn check(&self) -> Done {
        let mut world = World::new(&self.mesh, &self.positions);
        let mut last = None;
        for &step in &self.steps {
            world.apply(step, &mut last);
            world.is_sound();
        }
        world.mend(|_| true);
        world.is_sound();
        let World { done, mesh, .. } = world;
        assert!(
            mesh.half_edges().all(|h| mesh.ghost_pair(h).is_none()),
            "all is sewn"
        );
        assert_eq!(mesh.components().count(), self.mesh.components().count());
        assert_eq!(
            mesh.boundary_loops().len(),
            self.mesh.boundary_loops().len()
        );
        assert_eq!(
            mesh.vertex_count(),
            self.mesh.vertex_count() + done.inserted - done.twins
        );
        if done.inserted == 0 {
            assert_eq!(mesh, self.mesh, "mended, and nothing inserted");
        }
        done.told
    }
}

impl Step {
    fn from_bytes(bytes: &[u8; 14], positions: &Positions) -> Step {
        let [kind, a, b, c, d, e, f, g, h, i, j, k, l, m] = *bytes;
        if kind % 8 == 7 {
            return Step::Mend {
                near: a,
                radius: f64::from(b) / 128.0,
            };
        }
        // Origins and aims: small numbers, vertices, and places between vertices.
        let vertex = |i: u8| positions.as_slice()[usize::from(i) % positions.len()];
        let small = |x: [u8; 3]| Point::from(x.map(|x| f64::from(x.cast_signed()) / 32.0));
        let between =
            |x: u8, y: u8, t: u8| vertex(x) + (vertex(y) - vertex(x)) * (f64::from(t) / 64.0);
        let (eye, p, q) = (small([a, b, c]), between(d, e, f), between(g, h, i));
        let rays = match j % 3 {
            0 => [[eye, p], [eye, q]],
            1 => [[eye, p], [eye + (q - p), q]],
            _ => [[eye, p], [small([g, h, i]), between(k, l, 32)]],
        };
        Step::Cut {
            rays,
            span: match j / 3 % 8 {
                1 => Span::Plane,
                4 | 7 => Span::First,
                _ => Span::All,
            },
            method: [
                CutMethod::Exact,
                CutMethod::Exact,
                CutMethod::Exact,
                CutMethod::Exact,
                CutMethod::Partition,
                CutMethod::Uniform,
                CutMethod::Alternating,
            ][usize::from(kind % 7)],
            snap: SNAPS[usize::from(k / 3) % SNAPS.len()],
            snap_move: l % 4 == 3,
            through: m % 2 == 1,
            continued: m % 8 >= 6,
        }
    }
}

struct Counts {
    inserted: usize,
    /// Of the inserted, those that are copies of others, on torn edges.
    twins: usize,
    told: Done,
}

/// A mesh and its followers.
struct World {
    mesh: Mesh,
    positions: Positions,
    masses: Masses,
    corners: PerCorner<[f64; 3]>,
    edits: Edits,
    area: f64,
    done: Counts,
}

impl World {
    fn new(mesh: &Mesh, positions: &Positions) -> World {
        let corners = mesh
            .half_edges()
            .map(|h| positions.at(mesh.origin(h)).into());
        World {
            corners: PerCorner::new(corners.collect()),
            masses: Masses::area(mesh, positions, 1.0).expect("a shape has an area"),
            area: area(mesh, positions),
            mesh: mesh.clone(),
            positions: positions.clone(),
            edits: Edits::new(),
            done: Counts {
                inserted: 0,
                twins: 0,
                told: Done::default(),
            },
        }
    }

    fn apply(&mut self, step: Step, last: &mut Option<CutEnd>) {
        match step {
            Step::Cut {
                rays,
                span,
                method,
                snap,
                snap_move,
                through,
                continued,
            } => {
                let rays = rays.map(|[from, to]| Ray::new(from, to - from));
                let [Ok(a), Ok(b)] = rays else { return };
                let scissor = match last {
                    Some(end) if continued => {
                        self.edits.replay(end);
                        Scissor::continued(end, b, &self.positions)
                    }
                    _ => Scissor::new(a, b),
                };
                let Ok(scissor) = scissor else { return };
                let scissor = match span {
                    Span::All => scissor,
                    Span::First => scissor.layers(CutLayers::First),
                    Span::Plane => Scissor::by_plane(scissor.plane()),
                };
                let scissor = scissor.snap(snap).snap_move(snap_move).through(through);
                let first = self.edits.cursor();
                let pieces_before = self.mesh.components().count();
                let before = self.positions.clone();
                let torn_before: Vec<VertexId> = self.mesh.vertices().collect();
                let (cut, report) = scissor
                    .cut_measured(method, &mut self.mesh, &mut self.positions, &mut self.edits)
                    .expect("positions are in step");
                if snap_move {
                    // With a large snap, on a mesh of a few faces, that may be half of it.
                    self.area = area(&self.mesh, &self.positions);
                }
                if !snap_move {
                    for v in torn_before {
                        assert_eq!(before.at(v), self.positions.at(v), "{v} stays");
                    }
                }
                self.count(first);
                self.done.told.cuts += 1;
                self.done.told.splits += report.splits;
                let splits = usize::from(report.splits > 0);
                match span {
                    Span::All => {}
                    Span::First => self.done.told.of_first += splits,
                    Span::Plane => self.done.told.by_planes += splits,
                }
                if report.splits == 0 && report.vertices_inserted == 0 {
                    assert_eq!(self.edits.since(first).len(), 0, "nothing is cut");
                }
                self.done.told.inserted += report.vertices_inserted;
                assert_eq!(report.pieces_before, pieces_before);
                assert_eq!(report.pieces, self.mesh.components().count());
                *last = cut.ends().map(|[_, end]| end.clone());
            }
            Step::Mend { near, radius } => {
                let points = self.positions.as_slice();
                let centre = points[usize::from(near) % points.len()];
                let positions = self.positions.clone();
                self.mend(|v| (positions.at(v) - centre).norm() <= radius);
            }
        }
        self.edits
            .replay(&mut (&mut self.masses, &mut self.corners));
    }

    /// Counts what the edits from `first` on inserted.
    fn count(&mut self, first: Cursor) {
        for edit in self.edits.since(first) {
            if let tearmesh::Edit::Insert(insert) = edit {
                self.done.inserted += insert.points.len();
                let copies = insert.points.iter();
                let copies = copies.filter(|point| self.mesh.root(point.vertex) != point.vertex);
                self.done.twins += copies.count();
            }
        }
    }

    fn mend(&mut self, chosen: impl Fn(VertexId) -> bool) {
        let stitches = mend::stitches(&self.mesh, chosen);
        let masses = &self.masses;
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let merges = mend::sew(
            mesh,
            &self.positions,
            &stitches,
            |v| masses.at(v),
            f64::INFINITY,
            edits,
        )
        .expect("stitches are of one root");
        self.done.told.merges += merges;
        edits.replay(&mut (&mut self.positions, &mut self.masses, &mut self.corners));
    }

    fn is_sound(&self) {
        assert_eq!(self.mesh.check(), []);
        assert!(self.masses.ledger().is_balanced(), "mass stays");
        let area = area(&self.mesh, &self.positions);
        assert!(
            (area - self.area).abs() <= 1e-9 * self.area,
            "{area} of {}",
            self.area
        );
        for (h, corner) in self.mesh.half_edges().zip(self.corners.as_slice()) {
            let apart = (self.positions.at(self.mesh.origin(h)) - Point::from(*corner)).norm();
            assert!(apart < 1e-9, "the data of {h} is {apart} off");
        }
        let triangles: Vec<[u32; 3]> = self
            .mesh
            .faces()
            .map(|f| self.mesh.face_vertices(f).map(u32::from))
            .collect();
        let again = Mesh::build_torn(&triangles, &self.mesh.roots());
        assert_eq!(
            again.as_ref(),
            Ok(&self.mesh),
            "triangles and roots are all there is"
        );
    }
}

fn area(mesh: &Mesh, positions: &Positions) -> f64 {
    let of = |f: FaceId| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        let (b, c): (Vector, Vector) = (b - a, c - a);
        b.cross(&c).norm() / 2.0
    };
    mesh.faces().map(of).sum()
}

/// Bytes to be read, followed by zeros without end.
struct Bytes<'b>(&'b [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let [first, rest @ ..] = self.0 else { return 0 };
        self.0 = rest;
        *first
    }
}
