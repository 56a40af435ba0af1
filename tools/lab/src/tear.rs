//! Tearing: the forces that tear strips, by two rules and on meshes of several sizes, and what follows after the
//! first tear.
//!
//! A trouser test ([`Scene::trouser`]): a strip is slit to its middle, and its two legs are pulled apart.
//! The paper's rule tears an edge at a stretch ratio (Souza et al. 2014 §III-A), whatever its length. So the
//! force at which an edge tears is proportional to that length, and a cloth on a mesh twice as fine is half
//! as strong. A threshold of toughness, an energy per metre of tear, does not have that fault. Both rules
//! are set to agree on the middle mesh. In a laboratory the tear runs from the slit. To get that here, tips are
//! half as strong ([`Tearing::weakening`](tearmesh_cloth::Tearing::weakening)).
//!
//! After the first tear a scene is chaotic, and two single runs of it differ by a fifth in half of all pairs. So
//! every method plays it with many seeds ([`ensemble`]), at its step and at a half and a quarter of it. A method
//! has *converged* in a quantity if its ensembles at half and at a quarter of its step have the same median. If
//! the finest ensembles of two methods that converged have the same median, they are the reference with which all
//! methods are compared. If no two of them agree, there is no reference.

mod chart;
mod strip;

pub use self::strip::{STRIP_M, StripTest, TIP};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Positions, shapes};
use tearmesh_cloth::scene::ensemble::{self, Member, MemberStatus, Subject};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
use tearmesh_cloth::{Tearing, Threshold};

use crate::experiment::list;
use crate::experiment::{Bounds, Experiment, Status};
use crate::method::DefaultMethod;

/// The default numbers of cells across the strips.
pub const CELLS: [u32; 5] = [8, 12, 16, 24, 32];

/// The stretch ratio at which an edge tears by the paper's rule.
pub const RATIO: f64 = 1.5;

/// The default number of seeds of an ensemble.
pub const SEEDS: u64 = 16;

/// The numbers by which the steps of ensembles are divided.
const STEP_DIVISORS: [NonZero<u32>; 3] = [
    NonZero::<u32>::MIN,
    NonZero::<u32>::MIN.saturating_add(1),
    NonZero::<u32>::MIN.saturating_add(3),
];

/// The scenes that are played with many seeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EnsembleScene {
    /// The trouser test of a strip, with tips of half the strength.
    Trouser,
    /// A patch that a hand rips in its middle.
    Rip,
}

impl EnsembleScene {
    /// All scenes.
    pub const ALL: [EnsembleScene; 2] = [EnsembleScene::Trouser, EnsembleScene::Rip];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            EnsembleScene::Trouser => "trouser",
            EnsembleScene::Rip => "rip",
        }
    }

    /// Returns the default number of cells across.
    #[must_use]
    pub fn cells(self) -> u32 {
        match self {
            EnsembleScene::Trouser => 16,
            EnsembleScene::Rip => 32,
        }
    }

    fn mesh(self, cells: u32) -> (Mesh, Positions) {
        match self {
            EnsembleScene::Trouser => strip::strip(cells),
            EnsembleScene::Rip => {
                shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0)
            }
        }
    }

    fn scene(self, frame: &Frame) -> Scene {
        match self {
            EnsembleScene::Rip => Scene::rip(frame),
            EnsembleScene::Trouser => {
                let scene = Scene::trouser(frame);
                let weakening = Some(TIP);
                let weak = |tearing: Tearing| Tearing {
                    weakening,
                    ..tearing
                };
                Scene {
                    tearing: scene.tearing.map(weak),
                    ..scene
                }
            }
        }
    }
}

/// The options of the experiment on tearing.
#[derive(Clone, Debug)]
pub struct Options {
    /// The numbers of cells across the strips, none or at least two, all of them even: the slit runs along edges.
    pub strips: Vec<u32>,
    /// The scenes that are played with many seeds.
    pub scenes: Vec<EnsembleScene>,
    /// The numbers of cells across of those scenes; empty for the default of each.
    pub cells: Vec<u32>,
    /// The names of the methods that play them, from [`DefaultMethod::NAMES`].
    pub methods: Vec<String>,
    /// The number of seeds of each ensemble.
    pub seeds: u64,
    /// The number of runs that may go on at a time.
    pub threads: NonZero<usize>,
}

/// The experiment on tearing.
#[derive(Clone, Debug)]
pub struct Tear {
    options: Options,
}

/// A strip, or a run of an ensemble.
#[derive(Clone, Debug)]
pub enum Key {
    /// A trouser test.
    Strip {
        /// The number of cells across.
        cells: u32,
        /// The rule by which edges tear.
        threshold: Threshold,
    },
    /// A run of an ensemble.
    Run {
        /// The scene.
        scene: EnsembleScene,
        /// The number of cells across.
        cells: u32,
        /// The index of the method in [`DefaultMethod::NAMES`].
        method: usize,
        /// The number by which the step is divided.
        step_divisor: NonZero<u32>,
        /// The seed.
        seed: u64,
    },
}

/// What a key leaves.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// What a trouser test measured, or why it failed.
    Strip(Result<StripTest, String>),
    /// A run of an ensemble, and its step in seconds.
    Run(Member, f64),
}

/// What a row is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum What {
    /// The largest force of a strip.
    Largest,
    /// The mean force of a strip from its first tear to its last.
    Mean,
    /// The first tear of a strip by a method at a step.
    First,
    /// A point of the curve of force against distance of a strip.
    Curve,
    /// A run of an ensemble.
    Run,
}

/// A number of a strip, or a run of an ensemble. Cells that do not belong to a row are empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the row is about.
    pub what: What,
    /// The scene; the trouser test for strips.
    pub scene: EnsembleScene,
    /// The number of cells across.
    pub cells: u32,
    /// The way in which the run ended.
    pub status: Status,
    /// The rule by which a strip tears: `stretch` or `toughness`.
    pub rule: Option<String>,
    /// The threshold of the rule: a stretch ratio, or a toughness in J/m.
    pub threshold: Option<f64>,
    /// The length of the edges along a strip, in metres.
    pub edge_m: Option<f64>,
    /// The distance of the clamps, in metres.
    pub displacement_m: Option<f64>,
    /// The force between the clamps, in newtons.
    pub force_n: Option<f64>,
    /// The method.
    pub method: Option<String>,
    /// The number by which the step was divided.
    pub step_divisor: Option<u32>,
    /// The step, in seconds.
    pub step_s: Option<f64>,
    /// The seed.
    pub seed: Option<u64>,
    /// The time of the first tear, in seconds.
    pub first_tear_s: Option<f64>,
    /// The force at the first tear, in newtons.
    pub first_force_n: Option<f64>,
    /// The rest length of the edges that tore, in metres.
    pub torn_m: Option<f64>,
    /// The number of components of the mesh at the end.
    pub pieces: Option<usize>,
    /// The largest force at a hold, in newtons.
    pub largest_force_n: Option<f64>,
    /// The work of all holds, in joules.
    pub work_j: Option<f64>,
    /// The number of visits to single constraints.
    pub visits: Option<u64>,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    fn empty(what: What, scene: EnsembleScene, cells: u32, status: Status) -> Row {
        Row {
            what,
            scene,
            cells,
            status,
            rule: None,
            threshold: None,
            edge_m: None,
            displacement_m: None,
            force_n: None,
            method: None,
            step_divisor: None,
            step_s: None,
            seed: None,
            first_tear_s: None,
            first_force_n: None,
            torn_m: None,
            pieces: None,
            largest_force_n: None,
            work_j: None,
            visits: None,
            why: String::new(),
        }
    }
}

impl Tear {
    /// Creates the experiment.
    #[must_use]
    pub fn new(options: Options) -> Tear {
        Tear { options }
    }

    /// The rules of strips, which agree on the middle mesh.
    fn rules(&self) -> Vec<Threshold> {
        let Some(&middle) = self.options.strips.get(self.options.strips.len() / 2) else {
            return Vec::new();
        };
        let edge_m = STRIP_M[0] / f64::from(middle);
        // ½ k ε² h: the energy of an edge at the ratio.
        let toughness = 0.5 * Scene::STRETCH_N_PER_M * (RATIO - 1.0) * (RATIO - 1.0) * edge_m;
        vec![Threshold::Stretch(RATIO), Threshold::Toughness(toughness)]
    }
}

impl Experiment for Tear {
    type Key = Key;
    type Outcome = Outcome;
    type Row = Row;

    fn command(&self) -> String {
        let options = &self.options;
        let mut command = match options.strips[..] {
            [] => "tearmesh chart tear --no-strips".to_owned(),
            _ => format!("tearmesh chart tear --strips {}", list(&options.strips)),
        };
        if options.scenes.is_empty() || options.seeds == 0 {
            return command + " --seeds 0";
        }
        let scenes = options.scenes.iter().map(|scene| scene.name());
        command += &format!(
            " --scene {} --method {} --seeds {}",
            list(scenes),
            list(&options.methods),
            options.seeds
        );
        match options.cells[..] {
            [] => command,
            _ => command + &format!(" --size {}", list(&options.cells)),
        }
    }

    fn threads(&self) -> NonZero<usize> {
        self.options.threads
    }

    fn plan(&self) -> Vec<Vec<Key>> {
        let options = &self.options;
        let strips = self.rules().into_iter().flat_map(|threshold| {
            let cells = options.strips.iter();
            cells.map(move |&cells| Key::Strip { cells, threshold })
        });
        let mut plan: Vec<Vec<Key>> = vec![strips.collect()];
        for &scene in &options.scenes {
            let own = [scene.cells()];
            let sizes = if options.cells.is_empty() {
                &own[..]
            } else {
                &options.cells
            };
            for &cells in sizes {
                let mut keys = Vec::new();
                for (method, name) in DefaultMethod::NAMES.into_iter().enumerate() {
                    if !options.methods.iter().any(|other| other == name) {
                        continue;
                    }
                    for step_divisor in STEP_DIVISORS {
                        keys.extend((1..=options.seeds).map(|seed| Key::Run {
                            scene,
                            cells,
                            method,
                            step_divisor,
                            seed,
                        }));
                    }
                }
                plan.push(keys);
            }
        }
        plan.retain(|keys| !keys.is_empty());
        plan
    }

    fn name(&self, key: &Key) -> String {
        match key {
            Key::Strip { cells, .. } => format!("strip of {cells} cells"),
            Key::Run {
                scene,
                cells,
                method,
                ..
            } => {
                let method = DefaultMethod::NAMES[*method];
                format!("{} of {cells} cells by {method}", scene.name())
            }
        }
    }

    /// A strip of n cells across has n² times as many edges as one of a cell, and steps 1/n as long. A mesh twice
    /// as fine has four times as many edges, and steps that are half as long if the method is explicit.
    fn guess_s(&self, key: &Key) -> f64 {
        match key {
            Key::Strip { cells, .. } => STRIP_S * f64::from(*cells).powi(3),
            Key::Run {
                scene,
                cells,
                method,
                step_divisor,
                ..
            } => {
                let [trouser, rip] = RUN_S[*method];
                let finer = f64::from(*cells) / f64::from(scene.cells());
                let at_default = match scene {
                    EnsembleScene::Trouser => trouser,
                    EnsembleScene::Rip => rip,
                };
                at_default * finer.powf(2.5) * f64::from(step_divisor.get())
            }
        }
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Outcome> {
        match *key {
            Key::Strip { cells, threshold } => {
                strip::test(cells, threshold, bounds.stop).map(Outcome::Strip)
            }
            Key::Run {
                scene,
                cells,
                method,
                step_divisor,
                seed,
            } => {
                let (mesh, positions) = scene.mesh(cells);
                let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
                let scene = Scene {
                    solver: DefaultMethod::all()[method].settings.clone(),
                    ..scene.scene(&frame)
                };
                let whole = Run::new(mesh.clone(), &positions, scene.clone(), &frame);
                let step_s = whole.expect("a ready scene fits its mesh").step_s();
                let subject = Subject {
                    mesh: &mesh,
                    positions: &positions,
                    frame: &frame,
                    scene: &scene,
                    strengths: None,
                };
                let member = ensemble::member(subject, step_divisor, seed, bounds.stop);
                let is_done = member.status != MemberStatus::Interrupted;
                is_done.then(|| Outcome::Run(member, step_s / f64::from(step_divisor.get())))
            }
        }
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Outcome>>) -> Vec<Row> {
        let both = keys.iter().zip(outcomes);
        both.flat_map(|(key, outcome)| match *key {
            Key::Strip { cells, threshold } => {
                let test = match outcome {
                    Some(Outcome::Strip(test)) => Some(test),
                    _ => None,
                };
                strip_rows(cells, threshold, test)
            }
            Key::Run {
                scene,
                cells,
                method,
                step_divisor,
                seed,
            } => {
                let (member, step_s) = match outcome {
                    Some(Outcome::Run(member, step_s)) => (Some(member), Some(step_s)),
                    _ => (None, None),
                };
                vec![Row {
                    method: Some(DefaultMethod::NAMES[method].to_owned()),
                    step_divisor: Some(step_divisor.get()),
                    step_s,
                    seed: Some(seed),
                    ..run_row(scene, cells, member)
                }]
            }
        })
        .collect()
    }
}

/// The CPU time of the tests of a strip with a cell across, in seconds.
const STRIP_S: f64 = 5e-3;

/// By method, the CPU time of a trouser test and of a rip on their own meshes, in seconds.
const RUN_S: [[f64; 2]; 5] = [[6.0, 1.2], [2.0, 0.5], [5.0, 2.5], [2.5, 0.8], [20.0, 6.0]];

fn strip_rows(
    cells: u32,
    threshold: Threshold,
    test: Option<Result<StripTest, String>>,
) -> Vec<Row> {
    let status = match &test {
        None => Status::Interrupted,
        Some(Err(_)) => Status::Failed,
        Some(Ok(_)) => Status::Ok,
    };
    let (rule, given) = match threshold {
        Threshold::Toughness(toughness) => ("toughness", toughness),
        Threshold::Stretch(ratio) => ("stretch", ratio),
        _ => ("other", f64::NAN),
    };
    let row = |what: What, force_n: f64| Row {
        rule: Some(rule.to_owned()),
        threshold: Some(given),
        edge_m: Some(STRIP_M[0] / f64::from(cells)),
        force_n: Some(force_n),
        ..Row::empty(what, EnsembleScene::Trouser, cells, status)
    };
    let test = match test {
        Some(Ok(test)) => test,
        test => {
            let why = test.and_then(Result::err).unwrap_or_default();
            let force_n = None;
            return vec![Row {
                force_n,
                why,
                ..row(What::Largest, f64::NAN)
            }];
        }
    };
    let mut rows = vec![
        row(What::Largest, test.force_largest_n),
        row(What::Mean, test.force_mean_n),
    ];
    rows.extend(test.first.iter().map(|first| Row {
        method: Some(first.method.to_owned()),
        step_s: Some(first.dt_s),
        displacement_m: Some(first.displacement_m),
        ..row(What::First, first.force_n)
    }));
    rows.extend(test.curve.iter().map(|&[displacement_m, force_n]| Row {
        displacement_m: Some(displacement_m),
        ..row(What::Curve, force_n)
    }));
    rows
}

fn run_row(scene: EnsembleScene, cells: u32, member: Option<Member>) -> Row {
    let Some(member) = member else {
        return Row::empty(What::Run, scene, cells, Status::Interrupted);
    };
    let status = match member.status {
        MemberStatus::Done => Status::Ok,
        MemberStatus::Failed => Status::Failed,
        MemberStatus::Interrupted => Status::Interrupted,
    };
    let observed = member.observed;
    Row {
        first_tear_s: observed.and_then(|one| one.first_tear_s),
        first_force_n: observed.and_then(|one| one.first_force_n),
        torn_m: observed.map(|one| one.torn_m),
        pieces: observed.map(|one| one.pieces),
        largest_force_n: observed.and_then(|one| one.largest_force_n),
        work_j: observed.and_then(|one| one.work_j),
        visits: observed.map(|one| one.visits),
        why: member.why,
        ..Row::empty(What::Run, scene, cells, status)
    }
}

#[cfg(test)]
mod tests;
