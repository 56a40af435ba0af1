//! The scenes of the page: how each is set, played and measured.

use std::num::NonZero;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Point, Positions, Vector, VertexId, shapes};
use tearmesh_cloth::implicit::{self, Tolerance};
use tearmesh_cloth::scene::ensemble::Disturbance;
use tearmesh_cloth::scene::{Axis, Chronicle, FRAME_S, Frame, Method, Run, Scene};
use tearmesh_cloth::statistics::{Random, median};

use crate::experiment::{Bounds, Status};
use crate::method::DefaultMethod;
use crate::pareto::status_of;
use crate::tear::STRIP_M;

/// The topic of a panel: a scene, and what is asked about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Topic {
    /// The shape at rest of a sheet that hangs by two corners.
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

    /// The number by which the first reference divides the step of Verlet's method. For a flag chance is larger
    /// than what a shorter step changes.
    fn reference_divisor(self) -> NonZero<u32> {
        match self {
            Topic::Flag => HALF,
            _ => HALF.saturating_mul(HALF).saturating_mul(HALF),
        }
    }

    /// The time at which the pull begins, in seconds.
    fn pull_begins_s(self) -> f64 {
        match self {
            Topic::Rip | Topic::Aftermath => 0.5,
            Topic::Hang | Topic::Flag | Topic::Trouser => 0.0,
        }
    }
}

/// The time for which a method holds the shape at rest of the reference, in seconds. The mean of the second half
/// is compared.
const REST_S: f64 = 3.0;

/// The purpose of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// A method at its default or at a multiple of its default step.
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

/// A scene on a mesh.
#[derive(Debug)]
pub(super) struct Stage {
    pub(super) topic: Topic,
    pub(super) cells: u32,
    pub(super) diagonals: u64,
    mesh: Mesh,
    positions: Positions,
    frame: Frame,
    /// The shape at rest, for [`Topic::Hang`]; `None` if it was not found.
    rest: OnceLock<Option<Vec<Point>>>,
}

/// How a run went.
#[derive(Clone, Debug)]
pub struct Play {
    pub(super) status: Status,
    pub(super) why: String,
    pub(super) dt_s: f64,
    pub(super) cpu_s_per_s: Option<f64>,
    /// What was measured; `None` if the run did not reach its end.
    pub(super) measured: Option<Measured>,
}

/// What was measured of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Measured {
    pub(super) first_tear_s: Option<f64>,
    pub(super) first_force_n: Option<f64>,
    pub(super) torn_m: Option<f64>,
    pub(super) work_j: Option<f64>,
    pub(super) corner: Option<Corner>,
    /// The time from which on the first tear is counted, in seconds.
    pull_begins_s: f64,
    /// Displacements from the flat sheet, for the shape at rest.
    shape: Vec<Vector>,
    /// The positions at the last whole frame before the end.
    last: Vec<Point>,
}

/// The motion of the free corner of a flag.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    mean: Vector,
    pub(super) away_m: f64,
    pub(super) spread_m: f64,
}

impl Measured {
    /// The rms distance between the last positions of two runs, in metres; `None` if either has none.
    pub(super) fn apart_m(&self, other: &Measured) -> Option<f64> {
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
pub(super) fn error(ensemble: &[Measured], reference: &[Measured]) -> Option<f64> {
    let (one, known) = (ensemble.first()?, reference.first()?);
    if let (Some(time_s), Some(known_s)) = (one.first_tear_s, known.first_tear_s) {
        let late = (time_s - known_s).abs() / (known_s - known.pull_begins_s);
        let force = one.first_force_n.zip(known.first_force_n);
        return Some(force.map_or(late, |(force, known)| late.max((force / known - 1.0).abs())));
    }
    if !one.shape.is_empty() {
        let norm =
            |of: &mut dyn Iterator<Item = Vector>| of.map(|v| v.norm_squared()).sum::<f64>().sqrt();
        let mut apart = one.shape.iter().zip(&known.shape).map(|(a, b)| a - b);
        return Some(norm(&mut apart) / norm(&mut known.shape.iter().copied()));
    }
    let corner = |of: &[Measured]| -> Option<(Vector, f64, f64)> {
        let corners: Vec<Corner> = of.iter().filter_map(|one| one.corner).collect();
        let count = NonZero::new(corners.len())?.get() as f64;
        let mean = corners.iter().map(|one| one.mean).sum::<Vector>() / count;
        let within = corners.iter().map(|one| one.spread_m.powi(2)).sum::<f64>() / count;
        let among = corners
            .iter()
            .map(|one| (one.mean - mean).norm_squared())
            .sum::<f64>()
            / count;
        let away_m = corners.iter().map(|one| one.away_m).sum::<f64>() / count;
        Some((mean, (within + among).sqrt(), away_m))
    };
    let ((mean, spread, _), (known, known_spread, away_m)) =
        (corner(ensemble)?, corner(reference)?);
    Some(((mean - known).norm() / away_m).max((spread / known_spread - 1.0).abs()))
}

impl Stage {
    pub(super) fn new(topic: Topic, cells: u32, diagonals: u64) -> Stage {
        let mut random = Random::new(diagonals);
        let across = if topic == Topic::Trouser {
            cells / 2
        } else {
            cells
        };
        let (mesh, unit) = shapes::grid_with_diagonals(across, cells, |_, _| random.next() < 0.5);
        let [width, height] = match topic {
            Topic::Trouser => STRIP_M,
            _ => [1.0; 2],
        };
        let points = unit.as_slice().iter();
        let points = points.map(|p| Point::new(width * p.x, height * p.y, 0.0));
        let positions = Positions::new(points).expect("a sheet's coordinates are finite");
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
    pub(super) fn guess_s(&self, role: Role, method: &str, step_multiple: Option<f64>) -> f64 {
        let finer = f64::from(self.cells) / 32.0;
        let (seconds, factor) = match self.topic {
            Topic::Hang => (REST_S, 1.0),
            Topic::Flag => (1.5, 3.0),
            Topic::Rip => (0.3, 1.0),
            Topic::Trouser => (2.0, 4.0),
            Topic::Aftermath => (3.0, 1.5),
        };
        let a_second = match (role, method) {
            (Role::Second, _) => 1.5,
            (Role::Reference, _) => 1.2,
            (_, "xpbd") => 0.05,
            (_, "implicit") => 0.2,
            (_, "pbd") => 0.1,
            (_, "provot") => 0.4,
            _ => 0.15,
        };
        factor * a_second * seconds * finer.powi(3) / step_multiple.unwrap_or(1.0)
    }

    /// Plays the scene. Returns `None` if it was interrupted.
    pub(super) fn play(
        &self,
        role: Role,
        method: usize,
        step_multiple: Option<f64>,
        seed: u64,
        bounds: &Bounds<'_>,
    ) -> Option<Play> {
        let rest = match self.topic {
            Topic::Hang => self.rest.get_or_init(|| self.shape_at_rest(bounds.stop)),
            _ => &None,
        };
        if self.topic == Topic::Hang && rest.is_none() && (bounds.stop)() {
            return None;
        }
        if let (Some(rest), Role::Reference | Role::Mesh) = (rest, role) {
            return Some(self.known(rest));
        }
        let mut scene = self.topic.scene(&self.frame);
        let mut divisor = NonZero::<u32>::MIN;
        match role {
            Role::Method | Role::Mesh | Role::Gate => {
                scene.solver = DefaultMethod::all()[method].settings.clone();
            }
            // The second reference of a shape at rest keeps it by a method that did not find it.
            Role::Second if self.topic == Topic::Hang => divisor = HALF,
            Role::Reference => divisor = self.topic.reference_divisor(),
            Role::Second => {
                scene.step_s = Some(2.0 * self.run(scene.clone(), 0, None)?.step_s());
                scene.solver = bdf2(self.topic);
            }
        }
        if let Some(multiple) = step_multiple {
            scene.step_s = Some(multiple * self.run(scene.clone(), 0, None)?.step_s());
        }
        let run = self.run(scene, seed, rest.as_deref())?;
        self.measure(run.in_smaller_steps(divisor), bounds)
    }

    /// A run that is about to begin: with noise unless the seed is 0, in a given shape if there is one.
    fn run(&self, scene: Scene, seed: u64, shape: Option<&[Point]>) -> Option<Run> {
        let flat = self.positions.as_slice();
        let disturbance = (seed > 0).then(|| Disturbance::new(&self.mesh, seed));
        let mesh = disturbance.as_ref().map_or(&self.mesh, |one| &one.mesh);
        let run = Run::new(mesh.clone(), &self.positions, scene, &self.frame).ok()?;
        let offset_m = |v: VertexId| {
            let noise = disturbance.as_ref().map(|one| one.offsets_m[v.index()]);
            let shape = shape.map(|shape| shape[v.index()] - flat[v.index()]);
            noise.unwrap_or_default() + shape.unwrap_or_default()
        };
        run.displaced(offset_m).ok()
    }

    /// The shape at rest: by implicit steps with much drag, from a sheet that bulges a little. `None` if it does
    /// not come to rest or `stop` returns true.
    fn shape_at_rest(&self, stop: &dyn Fn() -> bool) -> Option<Vec<Point>> {
        let settings = implicit::Settings {
            tolerance: Tolerance::Fixed(1e-8),
            newton_iterations_max: 40,
            ..implicit::Settings::default()
        };
        let scene = Scene {
            solver: Method::Implicit(settings),
            step_s: Some(0.02),
            drag_per_s: 20.0,
            duration_s: 100.0,
            ..self.topic.scene(&self.frame)
        };
        let bulged = self.positions.as_slice().iter();
        let bulged =
            bulged.map(|p| Point::new(p.x, p.y, 0.01 * (3.0 * p.x).sin() * (2.0 * p.y).cos()));
        let mut run = self.run(scene, 0, Some(&bulged.collect::<Vec<_>>()))?;
        while !run.is_over() && !stop() {
            run.step().ok()?;
            let system = run.cloth().system();
            let speeds = system.velocities().iter().map(|v| v.norm());
            if speeds.fold(0.0, f64::max) < AT_REST_M_PER_S {
                return Some(system.positions().to_vec());
            }
        }
        None
    }

    /// A reference that was not played: the shape at rest.
    fn known(&self, rest: &[Point]) -> Play {
        let flat = self.positions.as_slice();
        let shape = rest.iter().zip(flat).map(|(p, flat)| p - flat);
        Play {
            status: Status::Ok,
            why: String::new(),
            dt_s: 0.02,
            cpu_s_per_s: None,
            measured: Some(Measured {
                shape: shape.collect(),
                ..Measured::default()
            }),
        }
    }

    /// Takes a run to its end: its last moment, or its first tear if the topic is that.
    fn measure(&self, mut run: Run, bounds: &Bounds<'_>) -> Option<Play> {
        let is_first_tear = matches!(self.topic, Topic::Rip | Topic::Trouser);
        let mut measured = Measured {
            pull_begins_s: self.topic.pull_begins_s(),
            ..Measured::default()
        };
        let mut chronicle = Chronicle::new(&run);
        let mut places: Vec<Vec<Point>> = Vec::new();
        let mut times: Vec<f64> = Vec::new();
        let before_m = run.torn_length_m();
        let mut play = Play {
            status: Status::Ok,
            why: String::new(),
            dt_s: run.step_s(),
            cpu_s_per_s: None,
            measured: None,
        };
        while !run.is_over() {
            if (bounds.stop)() {
                return None;
            }
            let (began, frame) = (bounds.now(), (run.elapsed_s() / FRAME_S) as u64);
            let step = run.step();
            times.push(bounds.now().saturating_sub(began).as_secs_f64());
            match step {
                Ok(step) => chronicle.note(&run, &step),
                Err(error) => {
                    play.status = status_of(&error);
                    play.why = error.to_string();
                    return Some(play);
                }
            }
            if is_first_tear && chronicle.first_tear().is_some() {
                break;
            }
            if (run.elapsed_s() / FRAME_S) as u64 > frame {
                measured.last.clone_from(&run.cloth().positions().to_vec());
                if matches!(self.topic, Topic::Hang | Topic::Flag) {
                    places.push(measured.last.clone());
                }
            }
        }
        if is_first_tear && chronicle.first_tear().is_none() {
            play.status = Status::Restless;
            play.why = "nothing tore".to_owned();
            return Some(play);
        }
        play.cpu_s_per_s = bounds.clock.and_then(|_| cpu_s_per_s(&times, run.step_s()));
        let first = chronicle.first_tear().filter(|_| is_first_tear);
        measured.first_tear_s = first.map(|first| first.event.time_s);
        measured.first_force_n = first.and_then(|first| first.force_n);
        if self.topic == Topic::Aftermath {
            measured.torn_m = Some(run.torn_length_m() - before_m);
            let knows_force = chronicle.largest_force_n().is_some();
            measured.work_j = knows_force.then(|| run.energy_balance().held_j);
        }
        let later = &places[places.len() / 2..];
        match self.topic {
            Topic::Hang => measured.shape = self.mean_displacements(later),
            Topic::Flag => measured.corner = self.corner(later),
            Topic::Rip | Topic::Trouser | Topic::Aftermath => {}
        }
        play.measured = Some(measured);
        Some(play)
    }

    fn mean_displacements(&self, places: &[Vec<Point>]) -> Vec<Vector> {
        let flat = self.positions.as_slice().iter().enumerate();
        let mean = flat.map(|(v, flat)| {
            let sum: Vector = places.iter().map(|points| points[v] - flat).sum();
            sum / places.len() as f64
        });
        mean.collect()
    }

    /// The motion of the lower corner that is farthest from the pole.
    fn corner(&self, places: &[Vec<Point>]) -> Option<Corner> {
        let flat = self.positions.as_slice();
        let out = |p: &Point| p.x - p.y;
        let corner = (0..flat.len()).max_by(|&a, &b| out(&flat[a]).total_cmp(&out(&flat[b])))?;
        let count = NonZero::new(places.len())?.get() as f64;
        let mean = places
            .iter()
            .map(|points| points[corner] - flat[corner])
            .sum::<Vector>()
            / count;
        let off = |points: &Vec<Point>| (points[corner] - flat[corner] - mean).norm_squared();
        Some(Corner {
            mean,
            away_m: mean.norm(),
            spread_m: (places.iter().map(off).sum::<f64>() / count).sqrt(),
        })
    }
}

/// A divisor of steps.
const HALF: NonZero<u32> = NonZero::<u32>::MIN.saturating_add(1);

/// The speed of the fastest particle at which a sheet is at rest.
const AT_REST_M_PER_S: f64 = 1e-7;

/// Newton's method of second order, with each step solved to convergence.
fn bdf2(topic: Topic) -> Method {
    Method::Implicit(implicit::Settings {
        method: implicit::Method::Bdf2,
        tolerance: match topic {
            // With led particles, rounding leaves less of the potential for the line search to compare.
            Topic::Rip | Topic::Trouser => Tolerance::Fixed(1e-8),
            Topic::Hang | Topic::Flag | Topic::Aftermath => Tolerance::Tied(0.1),
        },
        newton_iterations_max: 40,
        ..implicit::Settings::default()
    })
}

/// The CPU time per simulated second: the median of five equal parts of a run.
fn cpu_s_per_s(steps_s: &[f64], dt_s: f64) -> Option<f64> {
    let parts = steps_s.chunks(steps_s.len().div_ceil(5).max(1));
    let each = parts.map(|steps| steps.iter().sum::<f64>() / (steps.len() as f64 * dt_s));
    median(each.collect())
}
