//! Cuts of all methods on a small mesh, mended in part or as a whole: what holds whatever the
//! rays, the snap and the order.
//!
//! The fuzz target `cut_mend`, its replay and random bytes use this. The oracle of straight cuts
//! judges generic cuts; here vertices lie on planes, tips on edges and cuts on older cuts.

use tearmesh::script::Script;
use tearmesh::{
    Cursor, CutEnd, CutError, CutLayers, CutMethod, Mesh, Point, Positions, Ray, Scissor, VertexId,
};

use crate::work::{METHODS, Work, area};

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
    /// Cuts that split something: by a plane alone, and of what rays see first.
    pub(crate) by_planes: usize,
    pub(crate) of_first: usize,
    inserted: usize,
    /// Of the inserted, those that are copies of others, on torn edges.
    twins: usize,
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
        let mut world = World {
            work: Work::new((self.mesh.clone(), self.positions.clone())),
            area: area(&self.mesh, &self.positions),
            done: Done::default(),
        };
        let mut last = None;
        for &step in &self.steps {
            world.apply(step, &mut last);
        }
        world.work.sew_all();
        let World { done, work, .. } = world;
        let mesh = &work.mesh;
        let counts = |mesh: &Mesh| (mesh.components().count(), mesh.boundary_loops().len());
        assert_eq!(counts(mesh), counts(&self.mesh));
        let vertices = self.mesh.vertex_count() + done.inserted - done.twins;
        assert_eq!(mesh.vertex_count(), vertices);
        if done.inserted == 0 {
            assert_eq!(*mesh, self.mesh, "mended, and nothing inserted");
        }
        done
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
            // Four in seven are exact.
            method: METHODS[usize::from(kind % 7).saturating_sub(3)],
            snap: SNAPS[usize::from(k / 3) % SNAPS.len()],
            snap_move: l % 4 == 3,
            through: m % 2 == 1,
            continued: m % 8 >= 6,
        }
    }
}

/// A mesh, its followers, and its area.
struct World {
    work: Work,
    area: f64,
    done: Done,
}

impl World {
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
                        self.work.edits.replay(end);
                        Scissor::continued(end, b, &self.work.positions)
                    }
                    _ => Scissor::new(a, b),
                };
                let Ok(scissor) = scissor else { return };
                let scissor = match span {
                    Span::All => scissor,
                    Span::First => scissor.with_layers(CutLayers::First),
                    Span::Plane => Scissor::by_plane(scissor.plane()),
                };
                let scissor = scissor
                    .with_snap(snap)
                    .with_snap_move(snap_move)
                    .with_through(through);
                if snap_move {
                    self.no_slide_leaves_a_thin_face(method, &scissor, snap);
                }
                *last = self.cut(method, &scissor, span, snap_move);
            }
            Step::Mend { near, radius } => {
                let positions = self.work.positions.clone();
                let centre = positions.as_slice()[usize::from(near) % positions.len()];
                let is_near = |v: VertexId| (positions.at(v) - centre).norm() <= radius;
                self.work.sew(is_near);
            }
        }
        self.the_area_stays();
    }

    /// Cuts; returns where the cut ended.
    fn cut(
        &mut self,
        method: CutMethod,
        scissor: &Scissor,
        span: Span,
        snap_move: bool,
    ) -> Option<CutEnd> {
        let (first, before) = (self.work.edits.cursor(), self.work.positions.clone());
        let pieces_before = self.work.mesh.components().count();
        let (cut, report) = match self.work.try_cut(method, scissor) {
            Ok(made) => made,
            Err(CutError::RaysCross { .. } | CutError::TooShort { .. }) => return None,
            Err(error) => panic!("positions are in step: {error}"),
        };
        if snap_move {
            // With a large snap, on a mesh of a few faces, that may be half of it.
            self.area = area(&self.work.mesh, &self.work.positions);
        } else {
            let now = &self.work.positions.as_slice()[..before.len()];
            assert_eq!(now, before.as_slice(), "old vertices stay");
        }
        self.count(first);
        let splits = usize::from(report.splits > 0);
        match span {
            Span::All => {}
            Span::First => self.done.of_first += splits,
            Span::Plane => self.done.by_planes += splits,
        }
        if report.splits == 0 && report.vertices_inserted == 0 {
            let nothing = self.work.edits.since(first).len();
            assert_eq!(nothing, 0, "nothing is cut");
        }
        assert_eq!(report.pieces_before, pieces_before);
        cut.ends().map(|[_, end]| end.clone())
    }

    /// Faces keep as much of their altitudes as the snap allows, or as they keep where nothing slides.
    fn no_slide_leaves_a_thin_face(&self, method: CutMethod, scissor: &Scissor, snap: f64) {
        let (first, before) = (self.work.edits.cursor(), self.work.altitudes());
        let kept = [false, true].map(|moves| {
            let mut work = self.work.clone();
            let made = work.try_cut(method, &scissor.clone().with_snap_move(moves));
            made.ok()?;
            Some(work.kept_by(work.edits.since(first), &before))
        });
        let [Some(still), Some(slid)] = kept else {
            return; // It is refused, as the cut itself will be.
        };
        assert_eq!(still.len(), slid.len(), "slides divide no face");
        let bound = snap * (1.0 - snap);
        for (still, slid) in still.into_iter().zip(slid) {
            let is_thin = slid < still.min(bound) * (1.0 - 1e-9);
            assert!(
                !is_thin,
                "{slid} of an altitude, and without slides {still}"
            );
        }
    }

    /// Counts what the edits from `first` on inserted.
    fn count(&mut self, first: Cursor) {
        for edit in self.work.edits.since(first) {
            if let tearmesh::Edit::Insert(insert) = edit {
                self.done.inserted += insert.points.len();
                let new = insert.points.iter().map(|point| point.vertex);
                let copies = new.filter(|&v| self.work.mesh.root(v) != v);
                self.done.twins += copies.count();
            }
        }
    }

    fn the_area_stays(&self) {
        let area = area(&self.work.mesh, &self.work.positions);
        let off = (area - self.area).abs();
        assert!(off <= 1e-9 * self.area, "{area} of {}", self.area);
    }
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
