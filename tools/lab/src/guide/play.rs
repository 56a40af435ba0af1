//! The scenes of the page: how each is set, played and measured.

use std::num::NonZero;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Point, Positions, Vector, VertexId};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::ensemble::Disturbance;
use tearmesh_cloth::scene::{Axis, Chronicle, FRAME_S, Frame, Method, Run, Scene};
use tearmesh_cloth::statistics::{Random, median};

use crate::experiment::{Bounds, Status};
use crate::method::{DEFAULT, DefaultMethod};
use crate::pareto::status_of;
use crate::tear::{STRIP_M, grid};

/// The topic of a panel: a scene, and what is asked about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Topic {
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
    pub const ALL: [Topic; 5] = [
        Topic::Hang,
        Topic::Flag,
        Topic::Rip,
        Topic::Trouser,
        Topic::Aftermath,
    ];

    /// Returns the name of the scene on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Topic::Hang => "hang",
            Topic::Flag => "flag",
            Topic::Rip | Topic::Aftermath => "rip",
            Topic::Trouser => "trouser",
        }
    }

    /// The scene, with what does not belong to the topic left out.
    fn scene(self, frame: &Frame) -> Scene {
        match self {
            Topic::Hang => Scene {
                tearing: None,
                duration_s: REST_S,
                ..Scene::hang(frame)
            },
            Topic::Flag => Scene {
                cuts: Vec::new(),
                duration_s: 1.5,
                ..Scene::flag(frame)
            },
            Topic::Rip | Topic::Aftermath => Scene::rip(frame),
            Topic::Trouser => Scene::trouser(frame),
        }
    }
}

/// The time for which a method holds the shape at rest of the reference, in seconds. The mean of the second half
/// is compared.
const REST_S: f64 = 3.0;

/// The name of Newton's method of second order in tables, with each step solved to convergence.
pub(super) const BDF2: &str = "bdf2";

/// The purpose of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
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
pub struct Row {
    /// The topic.
    pub topic: Topic,
    /// The number of cells along the longest side.
    pub cells: u32,
    /// The seed of the diagonals of the mesh.
    pub diagonals: u64,
    /// The purpose of the run.
    pub role: Role,
    /// The method, as on the command line; `bdf2` for Newton's method of second order.
    pub method: String,
    /// The step as a multiple of the default step; `None` for the default.
    pub step_multiple: Option<f64>,
    /// The seed of the noise at the start; 0 for none.
    pub seed: u64,
    /// The way in which the run ended.
    pub status: Status,
    /// The step, in seconds.
    pub dt_s: Option<f64>,
    /// The CPU time per simulated second: the median of five equal parts of the run.
    pub cpu_s_per_s: Option<f64>,
    /// The torn length at the end, in metres.
    pub torn_m: Option<f64>,
    /// The work of all holds until the end, in joules.
    pub work_j: Option<f64>,
    /// The error relative to the reference; for a flag that of the whole ensemble, as its median over resampled
    /// seeds.
    pub error: Option<f64>,
    /// The 10 % and 90 % points of the error over resampled seeds.
    pub error_low: Option<f64>,
    /// See `error_low`.
    pub error_high: Option<f64>,
    /// The distance between the references.
    pub error_floor: Option<f64>,
    /// The median error of the meshes with other diagonals.
    pub error_mesh: Option<f64>,
    /// The distance between the runs of the gate by what the topic is about.
    pub error_noise: Option<f64>,
    /// The rms distance between the positions in the runs of the gate, divided by the noise.
    pub noise_amplification: Option<f64>,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    /// What the runs of an ensemble have in common, beside their topic and their cells.
    pub(super) fn ensemble(&self) -> (u64, Role, &str, Option<f64>) {
        let (role, method) = (self.role, &*self.method);
        (self.diagonals, role, method, self.step_multiple)
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

/// A run: its row without errors, and what errors are computed from.
#[derive(Clone, Debug)]
pub struct Play {
    pub(super) row: Row,
    /// `None` if the run did not reach its end, and for [`Topic::Aftermath`].
    pub(super) answer: Option<Answer>,
    /// The positions at the last whole frame before the end.
    last: Vec<Point>,
}

/// What a topic is about, as measured in a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Answer {
    /// The displacements from the flat sheet.
    Shape(Vec<Vector>),
    /// The mean displacement of the free corner of a flag, and the rms distance from it in metres.
    Corner(Vector, f64),
    /// The time from the begin of the pull to the first tear in seconds, and the force in newtons if the method
    /// knows it.
    FirstTear(f64, Option<f64>),
}

impl Play {
    /// A run that has not begun.
    pub(super) fn new(key: &Row) -> Play {
        Play {
            row: key.clone(),
            answer: None,
            last: Vec::new(),
        }
    }

    /// The rms distance between the last positions of two runs, in metres; `None` if either has none.
    pub(super) fn apart_m(&self, other: &Play) -> Option<f64> {
        let pairs = self.last.iter().zip(&other.last);
        let squares: Vec<f64> = pairs.map(|(p, q)| (p - q).norm_squared()).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (!squares.is_empty()).then(|| mean.sqrt())
    }
}

/// The error of an ensemble relative to a reference, by what its topic is about; `None` if either is empty.
///
/// For a tear it is the larger of the errors of its time and of its force, if the method knows its force. For a
/// flag it is the larger of those of the mean place of the corner and of its spread.
pub(super) fn error(ensemble: &[&Answer], reference: &[&Answer]) -> Option<f64> {
    match (*ensemble.first()?, *reference.first()?) {
        (Answer::FirstTear(time_s, force_n), Answer::FirstTear(known_s, known_n)) => {
            let late = (time_s - known_s).abs() / known_s;
            let force = force_n.zip(*known_n);
            Some(force.map_or(late, |(force, known)| late.max((force / known - 1.0).abs())))
        }
        (Answer::Shape(shape), Answer::Shape(known)) => {
            let apart = shape.iter().zip(known).map(|(a, b)| a - b);
            let apart: f64 = apart.map(|off| off.norm_squared()).sum();
            let whole: f64 = known.iter().map(Vector::norm_squared).sum();
            Some(apart.sqrt() / whole.sqrt())
        }
        (Answer::Corner(..), Answer::Corner(..)) => {
            let [(mean, spread_m, _), (known, known_m, away_m)] = [ensemble, reference].map(pooled);
            Some(((mean - known).norm() / away_m).max((spread_m / known_m - 1.0).abs()))
        }
        _ => None,
    }
}

/// The mean place and the spread of the corner over an ensemble, and its mean distance from where it is at rest.
fn pooled(ensemble: &[&Answer]) -> (Vector, f64, f64) {
    let corners = ensemble.iter().filter_map(|answer| match answer {
        Answer::Corner(mean, spread_m) => Some((*mean, *spread_m)),
        _ => None,
    });
    let corners: Vec<(Vector, f64)> = corners.collect();
    let count = corners.len() as f64;
    let mean = corners.iter().map(|(place, _)| place).sum::<Vector>() / count;
    let average = |of: &dyn Fn(&(Vector, f64)) -> f64| corners.iter().map(of).sum::<f64>() / count;
    let within = average(&|(_, spread_m)| spread_m.powi(2));
    let among = average(&|(place, _)| (place - mean).norm_squared());
    let away_m = average(&|(place, _)| place.norm());
    (mean, (within + among).sqrt(), away_m)
}

impl Stage {
    pub(super) fn new(topic: Topic, cells: u32, diagonals: u64) -> Stage {
        let mut random = Random::new(diagonals);
        let (across, size_m) = match topic {
            Topic::Trouser => (cells / 2, STRIP_M),
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
        let finer = f64::from(self.cells) / 32.0;
        let seconds = match self.topic {
            Topic::Hang => 3.0,
            Topic::Flag | Topic::Aftermath => 4.5,
            Topic::Rip => 0.3,
            Topic::Trouser => 8.0,
        };
        let method = DefaultMethod::NAMES.iter();
        let method = method.take_while(|name| **name != key.method).count();
        let a_second = match key.role {
            Role::Reference | Role::Second => 1.3,
            _ => [0.15, 0.05, 0.2, 0.1, 0.4][method],
        };
        a_second * seconds * finer.powi(3) / key.step_multiple.unwrap_or(1.0)
    }

    /// Plays the scene. Returns `None` if it was interrupted.
    pub(super) fn play(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Play> {
        let mut play = Play::new(key);
        let end = self.measure(&mut play, bounds).err();
        (play.row.status, play.row.why) = end.unwrap_or((Status::Ok, String::new()));
        (play.row.status != Status::Interrupted).then_some(play)
    }

    /// Takes a run to its end, or to its first tear if the topic is that.
    fn measure(&self, play: &mut Play, bounds: &Bounds<'_>) -> Result<(), End> {
        let flat = self.positions.as_slice();
        let mut rest = None;
        if self.topic == Topic::Hang {
            let shape = self.rest.get_or_init(|| self.shape_at_rest(bounds.stop));
            let shape = shape.as_ref().map_err(End::clone)?;
            if let Role::Reference | Role::Mesh = play.row.role {
                let shape = shape.iter().zip(flat).map(|(p, flat)| p - flat);
                play.answer = Some(Answer::Shape(shape.collect()));
                play.row.dt_s = Some(REST_STEP_S);
                return Ok(());
            }
            rest = Some(&shape[..]);
        }
        let mut run = self.begin(&play.row, rest)?;
        play.row.dt_s = Some(run.step_s());
        let before_m = run.torn_length_m();
        let is_first_tear = matches!(self.topic, Topic::Rip | Topic::Trouser);
        let mut chronicle = Chronicle::new(&run);
        let (mut frames, mut times) = (Vec::new(), Vec::new());
        while !run.is_over() {
            if (bounds.stop)() {
                return Err((Status::Interrupted, String::new()));
            }
            let (began, frame) = (bounds.now(), (run.elapsed_s() / FRAME_S) as u64);
            let step = run.step();
            times.push(bounds.now().saturating_sub(began).as_secs_f64());
            let step = step.map_err(|error| (status_of(&error), error.to_string()))?;
            chronicle.note(&run, &step);
            if is_first_tear && chronicle.first_tear().is_some() {
                break;
            }
            if (run.elapsed_s() / FRAME_S) as u64 > frame {
                frames.push(run.cloth().positions().to_vec());
            }
        }
        let later = &frames[frames.len() / 2..];
        let displaced = |v: usize| later.iter().map(move |points| points[v] - flat[v]);
        let mean = |v: usize| displaced(v).sum::<Vector>() / later.len() as f64;
        play.answer = match self.topic {
            Topic::Hang => Some(Answer::Shape((0..flat.len()).map(mean).collect())),
            Topic::Flag => {
                // The lower right one: the pole is on the left.
                let corner = self.cells as usize;
                let mean = mean(corner);
                let squares: f64 = displaced(corner).map(|at| (at - mean).norm_squared()).sum();
                Some(Answer::Corner(mean, (squares / later.len() as f64).sqrt()))
            }
            Topic::Rip | Topic::Trouser => {
                let nothing = || (Status::Restless, "nothing tore".to_owned());
                let first = chronicle.first_tear().ok_or_else(nothing)?;
                // The hand of a rip begins to pull after half a second.
                let begins_s = if self.topic == Topic::Rip { 0.5 } else { 0.0 };
                let time_s = first.event.time_s - begins_s;
                Some(Answer::FirstTear(time_s, first.force_n))
            }
            Topic::Aftermath => {
                play.row.torn_m = Some(run.torn_length_m() - before_m);
                let force_n = chronicle.largest_force_n();
                play.row.work_j = force_n.map(|_| run.energy_balance().held_j);
                None
            }
        };
        play.last = frames.pop().unwrap_or_default();
        play.row.cpu_s_per_s = bounds.clock.and_then(|_| cpu_s_per_s(&times, run.step_s()));
        Ok(())
    }

    /// The run of a key that is about to begin.
    fn begin(&self, key: &Row, rest: Option<&[Point]>) -> Result<Run, End> {
        let by = |name: &str| Scene {
            solver: match DefaultMethod::named(name) {
                Some(method) => method.settings,
                None => bdf2(),
            },
            ..self.topic.scene(&self.frame)
        };
        let mut scene = by(&key.method);
        let (name, multiple) = match &*key.method {
            // It takes longer steps than Verlet's method by as much as its order allows.
            BDF2 => (DEFAULT, Some(2.0)),
            name => (name, key.step_multiple),
        };
        if let Some(multiple) = multiple {
            scene.step_s = Some(multiple * self.run(by(name), 0, None)?.step_s());
        }
        let divisor = match (key.role, self.topic) {
            // For a flag chance is larger than what a shorter step changes. A shape at rest is kept by a method
            // that did not find it.
            (Role::Reference, Topic::Flag) | (Role::Second, Topic::Hang) => 2,
            (Role::Reference, _) => 8,
            _ => 1,
        };
        let run = self.run(scene, key.seed, rest)?;
        Ok(run.in_smaller_steps(NonZero::new(divisor).unwrap_or(NonZero::<u32>::MIN)))
    }

    /// A run that is about to begin: with noise unless the seed is 0, in a given shape if there is one.
    fn run(&self, scene: Scene, seed: u64, shape: Option<&[Point]>) -> Result<Run, End> {
        let flat = self.positions.as_slice();
        let disturbance = (seed > 0).then(|| Disturbance::new(&self.mesh, seed));
        let mesh = disturbance.as_ref().map_or(&self.mesh, |one| &one.mesh);
        let offset_m = |v: VertexId| {
            let noise = disturbance.as_ref().map(|one| one.offsets_m[v.index()]);
            let shape = shape.map(|shape| shape[v.index()] - flat[v.index()]);
            noise.unwrap_or_default() + shape.unwrap_or_default()
        };
        let run = Run::new(mesh.clone(), &self.positions, scene, &self.frame);
        let run = run.map_err(|error| (Status::Failed, error.to_string()))?;
        let run = run.displaced(offset_m);
        run.map_err(|error| (Status::Failed, error.to_string()))
    }

    /// The shape at rest: by implicit steps with much drag, from a sheet that bulges a little.
    fn shape_at_rest(&self, stop: &dyn Fn() -> bool) -> Result<Vec<Point>, End> {
        let settings = implicit::Settings {
            tolerance: 1e-5,
            ..implicit::Settings::default()
        };
        let scene = Scene {
            solver: Method::Implicit(settings),
            step_s: Some(REST_STEP_S),
            drag_per_s: 20.0,
            duration_s: 100.0,
            ..self.topic.scene(&self.frame)
        };
        let depth = |p: &Point| 0.01 * (3.0 * p.x).sin() * (2.0 * p.y).cos();
        let bulged = self.positions.as_slice().iter();
        let bulged = bulged.map(|p| Point::new(p.x, p.y, depth(p)));
        let mut run = self.run(scene, 0, Some(&bulged.collect::<Vec<_>>()))?;
        while !run.is_over() {
            if stop() {
                return Err((Status::Interrupted, String::new()));
            }
            let step = run.step();
            step.map_err(|error| (status_of(&error), error.to_string()))?;
            let system = run.cloth().system();
            let speeds = system.velocities().iter().map(|v| v.norm());
            if speeds.fold(0.0, f64::max) < AT_REST_M_PER_S {
                return Ok(system.positions().to_vec());
            }
        }
        let why = "the sheet does not come to rest";
        Err((Status::Restless, why.to_owned()))
    }
}

/// The step by which the shape at rest is found, in seconds.
const REST_STEP_S: f64 = 0.02;

/// The speed of the fastest particle at which a sheet is at rest.
const AT_REST_M_PER_S: f64 = 1e-7;

/// The implicit method of second order, with each linear equation solved to about rounding.
fn bdf2() -> Method {
    Method::Implicit(implicit::Settings {
        method: implicit::Method::Bdf2,
        tolerance: 0.1,
        ..implicit::Settings::default()
    })
}
/// The CPU time per simulated second: the median of five equal parts of a run.
fn cpu_s_per_s(steps_s: &[f64], dt_s: f64) -> Option<f64> {
    let parts = steps_s.chunks(steps_s.len().div_ceil(5).max(1));
    let each = parts.map(|steps| steps.iter().sum::<f64>() / (steps.len() as f64 * dt_s));
    median(each.collect())
}
