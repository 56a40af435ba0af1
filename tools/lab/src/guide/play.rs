//! The scenes of the page: how each is set, played and measured.

use std::num::NonZero;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Point, Positions, Vector, VertexId};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, TearLog};
use tearmesh_cloth::{FRAME_S, Method, TearReport};

use self::Topic::{Aftermath, Flag, Hang, Rip, Trouser};
use crate::ensemble::{Disturbance, NOISE_M};
use crate::experiment::{Bounds, Status};
use crate::method;
use crate::pareto::{fastest_m_per_s, status_of};
use crate::reference::Reference;
use crate::sheet::grid;
use crate::statistics::{Random, median};
use crate::tear::STRIP_M;

/// The topic of a panel: a scene, and what is asked about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Topic {
    /// The shape at rest of a sheet that hangs by two corners.
    #[default]
    Hang,
    /// The mean place and the spread of the free corner of a flag, before it is cut.
    Flag,
    /// The time and the force of the first tear of a sheet that a hand rips.
    Rip,
    /// The time and the force of the first tear of a strip whose legs are pulled apart.
    Trouser,
    /// The torn length and the work of a rip as a whole.
    Aftermath,
}

impl Topic {
    /// All topics, in the order of panels.
    pub(crate) const ALL: [Topic; 5] = [Hang, Flag, Rip, Trouser, Aftermath];

    /// Returns the name of the scene on the command line.
    #[must_use]
    pub(crate) fn name(self) -> &'static str {
        match self {
            Hang => "hang",
            Flag => "flag",
            Rip | Aftermath => "rip",
            Trouser => "trouser",
        }
    }

    /// The scene, with what does not belong to the topic left out.
    fn scene(self, frame: &Frame) -> Scene {
        let ready = match self {
            Hang => Scene::hang,
            Flag => Scene::flag,
            Rip | Aftermath => Scene::rip,
            Trouser => Scene::trouser,
        };
        let mut scene = ready(frame);
        match self {
            Hang => (scene.tearing, scene.duration_s) = (None, REST_S),
            Flag => (scene.cuts, scene.duration_s) = (Vec::new(), 1.5),
            _ => {}
        }
        scene
    }
}

/// The time for which a method holds the shape at rest of the reference, in seconds. The mean of the second half
/// is compared.
const REST_S: f64 = 3.0;

/// The name in tables of the method that shares no code with the others ([`Reference`]).
pub(super) const NEWTON: &str = "newton";

/// The purpose of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Role {
    /// A method at its default or at a multiple of its default step.
    #[default]
    Method,
    /// The reference that errors are relative to.
    Reference,
    /// The reference by another method, whose distance from the first is the error floor.
    Second,
    /// Verlet's method from a start with noise, compared with that from a start without.
    Gate,
    /// The default method on a mesh with other diagonals; for a shape at rest, its reference.
    Mesh,
}

/// A run with its errors. A row without a result is the key of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The topic.
    pub(crate) topic: Topic,
    /// The number of cells along the longest side.
    pub(crate) cells: u32,
    /// The seed of the diagonals of the mesh.
    pub(crate) diagonals: u64,
    /// The purpose of the run.
    pub(crate) role: Role,
    /// The method, as on the command line; `newton` for the second reference.
    pub(crate) method: String,
    /// The step as a multiple of the default step; `None` for the default.
    pub(crate) step_multiple: Option<f64>,
    /// The seed of the noise at the start; 0 for none.
    pub(crate) seed: u64,
    /// The way in which the run ended.
    pub(crate) status: Status,
    /// The step, in seconds.
    pub(crate) dt_s: Option<f64>,
    /// The CPU time per simulated second: the median of five equal parts of the run.
    pub(crate) cpu_s_per_s: Option<f64>,
    /// The torn length at the end, in metres.
    pub(crate) torn_m: Option<f64>,
    /// The work of all holds until the end, in joules.
    pub(crate) work_j: Option<f64>,
    /// The error relative to the reference; for a flag that of the whole ensemble.
    pub(crate) error: Option<f64>,
    /// The distance between the references.
    pub(crate) error_floor: Option<f64>,
    /// The median error of the meshes with other diagonals.
    pub(crate) error_mesh: Option<f64>,
    /// The distance between the runs of the gate by what the topic is about.
    pub(crate) error_noise: Option<f64>,
    /// The rms distance between the positions in the runs of the gate, divided by the noise.
    pub(crate) noise_amplification: Option<f64>,
    /// The reason of a failure.
    pub(crate) why: String,
    /// What errors are computed from, until they are. `None` if the run did not reach its end, and for
    /// [`Topic::Aftermath`].
    #[serde(skip)]
    pub(super) answer: Option<Answer>,
    /// The positions at the last whole frame before the end, until they are compared.
    #[serde(skip)]
    pub(super) last: Vec<Point>,
}

impl Row {
    /// What the runs of an ensemble have in common, beside their topic and their cells.
    pub(super) fn ensemble(&self) -> (u64, Role, &str, Option<f64>) {
        let method = &self.method;
        (self.diagonals, self.role, method, self.step_multiple)
    }

    /// The rms distance between the last positions of this run and of one with noise, divided by the noise; `None` if
    /// either has none.
    pub(super) fn amplification(&self, other: &Row) -> Option<f64> {
        let pairs = self.last.iter().zip(&other.last);
        let squares: Vec<f64> = pairs.map(|(p, q)| (p - q).norm_squared()).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (!squares.is_empty()).then(|| mean.sqrt() / NOISE_M)
    }
}

/// A scene on a mesh.
#[derive(Debug)]
pub(super) struct Stage {
    pub(super) topic: Topic,
    pub(super) cells: u32,
    pub(super) diagonals: u64,
    mesh: Mesh,
    positions: Positions,
    frame: Frame,
    /// The shape at rest, for [`Topic::Hang`].
    rest: OnceLock<Result<Vec<Point>, End>>,
}

/// The way in which a run ended before it was measured, and the reason.
type End = (Status, String);

/// What a topic is about, as measured in a run: quantities of one or more numbers each.
///
/// For a shape at rest it is one quantity, the displacements from the flat sheet. For a flag it is the mean
/// displacement of the free corner, and the rms distance of the corner from it. For a first tear it is the time
/// from the begin of the pull, and the force unless the method does not know it.
type Answer = Vec<Vec<f64>>;

/// The error of an ensemble relative to a reference: the largest relative error of the quantities that both know,
/// each as a mean over runs. `None` if either has no run with an answer.
pub(super) fn error(ensemble: &[&Row], reference: &[&Row]) -> Option<f64> {
    let (own, known) = (mean(ensemble)?, mean(reference)?);
    let errors = own.iter().zip(&known).map(|(own, known)| {
        let apart: f64 = own.iter().zip(known).map(|(a, b)| (a - b) * (a - b)).sum();
        let whole: f64 = known.iter().map(|b| b * b).sum();
        (apart / whole).sqrt()
    });
    errors.reduce(f64::max)
}

fn mean(runs: &[&Row]) -> Option<Answer> {
    let answers = runs.iter().filter_map(|run| run.answer.as_ref());
    let answers: Vec<&Answer> = answers.collect();
    let mut mean = Answer::clone(answers.first()?);
    for (i, quantity) in mean.iter_mut().enumerate() {
        for (j, number) in quantity.iter_mut().enumerate() {
            let numbers = answers.iter().map(|answer| answer[i][j]);
            *number = numbers.sum::<f64>() / answers.len() as f64;
        }
    }
    Some(mean)
}

impl Stage {
    pub(super) fn new(topic: Topic, cells: u32, diagonals: u64) -> Stage {
        let mut random = Random::new(diagonals);
        let (across, size_m) = match topic {
            Trouser => (cells / 2, STRIP_M),
            _ => (cells, [1.0; 2]),
        };
        let (mesh, positions) = grid([across, cells], size_m, |_, _| random.next() < 0.5);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        Stage {
            topic,
            cells,
            diagonals,
            mesh,
            positions,
            frame,
            rest: OnceLock::new(),
        }
    }

    /// An estimate of the CPU time of a run, in seconds, from those of sheets of 32 cells.
    pub(super) fn guess_s(&self, key: &Row) -> f64 {
        let (method_s, second_s) = match self.topic {
            Hang => (0.35, 4.0),
            Flag => (0.6, 4.0),
            Rip => (0.12, 1.5),
            Trouser => (0.7, 8.0),
            Aftermath => (1.6, 0.0),
        };
        let seconds = match (key.role, self.topic) {
            (Role::Second, _) => second_s,
            (Role::Reference, Rip | Trouser) => 8.0 * method_s,
            _ => method_s / key.step_multiple.unwrap_or(1.0),
        };
        let finer = f64::from(self.cells) / 32.0;
        seconds * finer.powi(3)
    }

    /// Takes a run to its end, or to its first tear if the topic is that.
    pub(super) fn measure(&self, row: &mut Row, bounds: &Bounds<'_>) -> Result<(), End> {
        let flat = self.positions.as_slice();
        let shape_of = |at: &dyn Fn(usize) -> Vector| {
            let numbers = (0..flat.len()).flat_map(|v| <[f64; 3]>::from(at(v)));
            vec![numbers.collect()]
        };
        let mut rest = None;
        if self.topic == Hang {
            let shape = self.rest.get_or_init(|| self.shape_at_rest(bounds.stop));
            let shape = shape.as_ref().map_err(End::clone)?;
            if let Role::Reference | Role::Mesh = row.role {
                row.answer = Some(shape_of(&|v| shape[v] - flat[v]));
                row.dt_s = Some(REST_STEP_S);
                return Ok(());
            }
            rest = Some(&shape[..]);
        }
        let mut run = self.begin(row, rest)?;
        row.dt_s = Some(run.step_s());
        let before_m = run.torn_length_m();
        let is_first_tear = matches!(self.topic, Rip | Trouser);
        let mut tear_log = TearLog::new(&run);
        let (mut frames, mut times, mut began) = (Vec::new(), Vec::new(), bounds.now());
        take_steps(&mut run, bounds.stop, |run, step| {
            times.push(bounds.now().saturating_sub(began).as_secs_f64());
            tear_log.note(run, step);
            let is_over = is_first_tear && !tear_log.events().is_empty();
            if !is_over && (run.elapsed_s() / FRAME_S) as usize > frames.len() {
                frames.push(run.cloth().positions().to_vec());
            }
            began = bounds.now();
            is_over
        })?;
        let later = &frames[frames.len() / 2..];
        let displaced = |v: usize| later.iter().map(move |points| points[v] - flat[v]);
        let mean = |v: usize| displaced(v).sum::<Vector>() / later.len() as f64;
        row.answer = match self.topic {
            Hang => Some(shape_of(&mean)),
            Flag => {
                // The lower right one: the pole is on the left.
                let corner = self.cells as usize;
                let mean = mean(corner);
                let squares: f64 = displaced(corner).map(|at| (at - mean).norm_squared()).sum();
                let spread_m = (squares / later.len() as f64).sqrt();
                Some(vec![<[f64; 3]>::from(mean).to_vec(), vec![spread_m]])
            }
            Rip | Trouser => {
                let nothing = || (Status::Restless, "nothing tore".to_owned());
                let first = tear_log.events().first().ok_or_else(nothing)?;
                // The hand of a rip begins to pull after half a second.
                let begins_s = if self.topic == Rip { 0.5 } else { 0.0 };
                let numbers = [Some(first.time_s - begins_s), tear_log.first_force_n()];
                Some(numbers.into_iter().flatten().map(|x| vec![x]).collect())
            }
            Aftermath => {
                row.torn_m = Some(run.torn_length_m() - before_m);
                let force_n = tear_log.largest_force_n();
                row.work_j = force_n.map(|_| run.energy_balance().held_j);
                None
            }
        };
        row.last = frames.pop().unwrap_or_default();
        row.cpu_s_per_s = bounds.clock.and_then(|_| cpu_s_per_s(&times, run.step_s()));
        Ok(())
    }

    /// The run of a key that is about to begin.
    fn begin(&self, key: &Row, rest: Option<&[Point]>) -> Result<Run, End> {
        let method = method::Method::named(&key.method).and_then(|method| method.settings());
        let mut scene = self.topic.scene(&self.frame);
        scene.solver = method.unwrap_or(Method::Verlet);
        let (multiple, divisor, reference) = match (key.role, self.topic) {
            (Role::Second, Hang) => {
                (scene.step_s, scene.duration_s) = (Some(REST_STEP_S), 0.5);
                (None, 1, Some(Reference::to_rest()))
            }
            // It takes longer steps than Verlet's method by as much as its order allows, and for a flag chance is
            // larger than what a shorter step changes.
            (Role::Second, Flag) => (Some(4.0), 1, Some(Reference::new(self.mesh.indices()))),
            (Role::Second, _) => (Some(2.0), 1, Some(Reference::new(self.mesh.indices()))),
            (Role::Reference, Flag) => (None, 1, None),
            (Role::Reference, _) => (None, 8, None),
            _ => (key.step_multiple, 1, None),
        };
        if let Some(multiple) = multiple {
            scene.step_s = Some(multiple * self.run(scene.clone(), 0, None)?.step_s());
        }
        let run = self.run(scene, key.seed, rest)?;
        let run = run.in_smaller_steps(NonZero::new(divisor).unwrap_or(NonZero::<u32>::MIN));
        Ok(match reference {
            Some(reference) => run.with_solver(reference),
            None => run,
        })
    }

    /// A run that is about to begin: with noise unless the seed is 0, in a given shape if there is one.
    fn run(&self, scene: Scene, seed: u64, shape: Option<&[Point]>) -> Result<Run, End> {
        let flat = self.positions.as_slice();
        let noise = (seed > 0).then(|| Disturbance::new(&self.mesh, seed));
        let mesh = noise.as_ref().map_or(&self.mesh, |noise| &noise.mesh);
        let offset_m = |v: VertexId| {
            let noise = noise.as_ref().map(|noise| noise.offsets_m[v.index()]);
            let shape = shape.map(|shape| shape[v.index()] - flat[v.index()]);
            noise.unwrap_or_default() + shape.unwrap_or_default()
        };
        let failed = |why: &dyn ToString| (Status::Failed, why.to_string());
        let run = Run::new(mesh.clone(), &self.positions, scene, &self.frame);
        let run = run.map_err(|error| failed(&error))?;
        run.displaced(offset_m).map_err(|error| failed(&error))
    }

    /// The shape at rest: by implicit steps with much drag.
    fn shape_at_rest(&self, stop: &dyn Fn() -> bool) -> Result<Vec<Point>, End> {
        let backward_euler = implicit::Settings {
            tolerance: 1e-5,
            ..implicit::Settings::default()
        };
        let mut scene = self.topic.scene(&self.frame);
        scene.solver = Method::Implicit(backward_euler);
        scene.step_s = Some(REST_STEP_S);
        (scene.drag_per_s, scene.duration_s) = (20.0, 100.0);
        let mut run = self.run(scene, 0, None)?;
        let is_at_rest = |run: &Run| fastest_m_per_s(run.cloth().system()) < AT_REST_M_PER_S;
        take_steps(&mut run, stop, |run, _| is_at_rest(run))?;
        if !is_at_rest(&run) {
            let why = "the sheet does not come to rest".to_owned();
            return Err((Status::Restless, why));
        }
        Ok(run.cloth().positions().to_vec())
    }
}

/// Takes the steps of a run up to the first after which `is_done` returns true.
fn take_steps(
    run: &mut Run,
    stop: &dyn Fn() -> bool,
    mut is_done: impl FnMut(&Run, &TearReport) -> bool,
) -> Result<(), End> {
    while !run.is_over() {
        if stop() {
            return Err((Status::Interrupted, String::new()));
        }
        let step = run.step();
        let step = step.map_err(|error| (status_of(&error), error.to_string()))?;
        if is_done(run, &step) {
            break;
        }
    }
    Ok(())
}

/// The step by which the shape at rest is found, in seconds.
const REST_STEP_S: f64 = 0.02;

/// The speed of the fastest particle at which a sheet is at rest.
const AT_REST_M_PER_S: f64 = 1e-7;

/// The CPU time per simulated second: the median of five equal parts of a run.
fn cpu_s_per_s(steps_s: &[f64], dt_s: f64) -> Option<f64> {
    let parts = steps_s.chunks(steps_s.len().div_ceil(5).max(1));
    let each = parts.map(|steps| steps.iter().sum::<f64>() / (steps.len() as f64 * dt_s));
    median(each.collect())
}
