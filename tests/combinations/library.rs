//! A cut by the library, as a program would make it: seams that coincide are closed meanwhile, polylines go on
//! from where they ended, masses, values at corners and a document follow.

use tearmesh::unsewn::UnsewnSeams;
use tearmesh::{
    Cut, CutEnd, CutError, CutMethod, CutReport, Edit, Edits, Masses, Mesh, PerCorner, Plane,
    Point, Positions, Scissor, ScissorError, Vector, gap,
};
use tearmesh_obj::{Document, TornDocument};

use crate::oracle::straight::Surface;
use crate::surfaces::surface;
use crate::verb::{Along, CutVerb};
use crate::work::ray;

/// A mesh, and with how many of its vertices each was one before it was torn.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) surface: Surface,
    pub(crate) roots: Vec<u32>,
}

impl State {
    fn of(mesh: &Mesh, positions: &Positions) -> State {
        State {
            surface: surface(&(mesh.clone(), positions.clone())),
            roots: mesh.roots(),
        }
    }

    /// What a file has, at its true places.
    pub(crate) fn read(file: &str) -> State {
        let document = Document::read(file.as_bytes()).expect("a file of ours");
        let (mesh, positions) = built(&document);
        State::of(&mesh, &positions)
    }
}

fn built(document: &Document) -> (Mesh, Positions) {
    let mesh = document.mesh().expect("a mesh of ours");
    let points = document.positions().iter().copied();
    (mesh, Positions::new(points).expect("finite"))
}

/// One of the cuts of a verb.
pub(crate) struct Step {
    pub(crate) before: State,
    pub(crate) after: State,
    pub(crate) report: CutReport,
    /// The edges that it tore, where they are now.
    pub(crate) torn: Vec<[[f64; 3]; 2]>,
    /// Whether it began where the one before ended.
    pub(crate) continues: bool,
    pub(crate) has_slid: bool,
}

/// What a verb made.
pub(crate) struct Made {
    pub(crate) steps: Vec<Step>,
    pub(crate) file: String,
    /// The sums of the masses in parts of the vertices, and as the ledger has them.
    pub(crate) mass: f64,
    pub(crate) is_balanced: bool,
    /// How far each vertex is written from where it is, at most.
    pub(crate) apart: f64,
}

impl Made {
    /// How many of the cuts tore something. (Where two fans of one vertex are parted, that is no edge.)
    pub(crate) fn torn(&self) -> usize {
        let torn = self.steps.iter().filter(|step| step.report.splits > 0);
        torn.count()
    }

    pub(crate) fn has_slid(&self) -> bool {
        self.steps.iter().any(|step| step.has_slid)
    }

    pub(crate) fn first(&self) -> &State {
        &self.steps[0].before
    }

    pub(crate) fn last(&self) -> &State {
        &self.steps[self.steps.len() - 1].after
    }
}

/// Why a cut was refused.
pub(crate) type Refused = String;

/// Cuts the mesh of a file.
pub(crate) fn cut(file: &str, verb: &CutVerb) -> Result<Made, Refused> {
    let document = Document::read(file.as_bytes()).expect("a file of ours");
    let (mesh, positions) = built(&document);
    let mut torn = TornDocument::new(&document);
    let masses = match verb.halves {
        false => Masses::area(&mesh, &positions, 1.0),
        true => Masses::half(&mesh, &positions, 1.0),
    };
    let masses = masses.expect("the mesh has an area");
    let mut world = World::new(mesh, positions, masses);
    let steps = world.cut(verb, |edits| {
        edits.replay(&mut torn);
        torn.next_cut();
    })?;
    let World {
        mesh,
        positions,
        masses,
        ..
    } = &world;
    let mut apart = 0.0;
    if let Some(gap) = verb.gap {
        let (_, points) = gap::gapped(mesh, positions, gap);
        let far = points.iter().zip(positions.as_slice());
        apart = far.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        torn.set_apart(points);
    }
    let mut out = Vec::new();
    let written = torn.write(mesh, positions, &mut out);
    written.expect("memory takes all that is written");
    Ok(Made {
        steps,
        file: String::from_utf8(out).expect("text"),
        mass: mesh.vertices().map(|v| masses.at(v)).sum(),
        is_balanced: masses.ledger().is_balanced(),
        apart,
    })
}

/// Cuts a surface on which nothing is torn, with all that belongs to a cut but the document.
pub(crate) fn cut_surface(of: &Surface, verb: &CutVerb) -> Result<Vec<Step>, Refused> {
    let (mesh, positions) = crate::surfaces::built(of);
    let masses = Masses::area(&mesh, &positions, 1.0).expect("it has an area");
    World::new(mesh, positions, masses).cut(verb, |_| {})
}

struct World {
    mesh: Mesh,
    positions: Positions,
    masses: Masses,
    /// For each corner where it is.
    corners: PerCorner<[f64; 3]>,
}

impl World {
    fn new(mesh: Mesh, positions: Positions, masses: Masses) -> World {
        let place = |h| positions.at(mesh.origin(h)).into();
        World {
            corners: PerCorner::new(mesh.half_edges().map(place).collect()),
            mesh,
            positions,
            masses,
        }
    }

    fn cut(
        &mut self,
        verb: &CutVerb,
        mut follow: impl FnMut(&Edits),
    ) -> Result<Vec<Step>, Refused> {
        let seams = UnsewnSeams::find(&self.mesh, &self.positions);
        let mut closed = seams.close(&mut self.mesh);
        let (mut edits, mut steps, mut ends) = (Edits::new(), Vec::new(), None::<[CutEnd; 2]>);
        edits.replay(&mut (&mut self.masses, &mut self.corners, &mut closed));
        let pairs = verb.pairs();
        for i in 0..pairs.len().max(1) {
            let continues = i > 0 && !verb.through;
            let scissor = self.scissor(verb, i, ends.as_ref().filter(|_| continues));
            let scissor = scissor.map_err(|error| error.to_string())?;
            let before = State::of(&self.mesh, &self.positions);
            let made = self.cut_once(verb.method, &scissor, &mut edits);
            let (cut, report) = made.map_err(|error| error.to_string())?;
            edits.replay(&mut (&mut self.masses, &mut self.corners, &mut closed));
            let is_slide = |edit: Edit<'_>| matches!(edit, Edit::Slide(_));
            steps.push(Step {
                before,
                after: State::of(&self.mesh, &self.positions),
                report,
                torn: self.torn(&edits),
                continues,
                has_slid: edits.iter().any(is_slide),
            });
            ends = cut.ends().map(|[begin, end]| {
                let first = ends.take().filter(|_| continues).map(|[mut first, _]| {
                    edits.replay(&mut first);
                    first
                });
                [first.unwrap_or_else(|| begin.clone()), end.clone()]
            });
            follow(&edits);
            edits.clear();
        }
        closed.reopen(&mut self.mesh);
        self.is_sound();
        Ok(steps)
    }

    fn scissor(
        &self,
        verb: &CutVerb,
        i: usize,
        ends: Option<&[CutEnd; 2]>,
    ) -> Result<Scissor, ScissorError> {
        let pairs = verb.pairs();
        // Each cut that comes back to where the first began ends there.
        let comes_back = |i: usize| i > 0 && pairs[i][1] == pairs[0][0];
        let scissor = match (&verb.along, ends) {
            (Along::Plane(point, normal), _) => {
                let plane = Plane::new(Point::from(*point), Vector::from(*normal));
                Scissor::by_plane(plane.expect("a normal"))
            }
            (_, Some([first, last])) if comes_back(i) => {
                Scissor::closed(last, first, &self.positions)?
            }
            (_, Some([_, last])) => Scissor::continued(last, ray(pairs[i][1]), &self.positions)?,
            (_, None) => Scissor::new(ray(pairs[i][0]), ray(pairs[i][1]))?,
        };
        let scissor = scissor.with_through(verb.through).with_tips(verb.tips);
        let scissor = scissor.with_layers(verb.layers).with_snap(verb.snap);
        Ok(scissor.with_snap_move(verb.moves))
    }

    fn cut_once(
        &mut self,
        method: CutMethod,
        scissor: &Scissor,
        edits: &mut Edits,
    ) -> Result<(Cut, CutReport), CutError> {
        // As the command does, which reports the planes.
        let scissor = scissor.aimed_at(&self.mesh, &self.positions)?;
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        scissor.cut_measured(method, mesh, positions, edits)
    }

    /// The edges that some edits tore.
    fn torn(&self, edits: &Edits) -> Vec<[[f64; 3]; 2]> {
        let mut torn = Vec::new();
        for edit in edits {
            let Edit::Split(split) = edit else { continue };
            torn.extend(split.torn.iter().map(|link| {
                let ends = [link.stayed, link.stayed.next()];
                ends.map(|h| self.positions.at(self.mesh.origin(h)).into())
            }));
        }
        torn
    }

    /// What the library says of itself: its invariants, and that values at corners are those of their places.
    fn is_sound(&self) {
        let World {
            mesh, positions, ..
        } = self;
        assert_eq!(mesh.check(), []);
        let all = mesh.indices().as_chunks().0;
        let again = Mesh::build_torn(all, &mesh.roots());
        assert_eq!(again.as_ref(), Ok(mesh), "triangles and roots are all");
        for (h, &corner) in mesh.half_edges().zip(self.corners.as_slice()) {
            let at = positions.at(mesh.origin(h));
            let apart = (at - Point::from(corner)).norm();
            let reach = at.coords.amax();
            assert!(apart <= 1e-12 * reach, "the data of {h} is {apart} off");
        }
    }
}
