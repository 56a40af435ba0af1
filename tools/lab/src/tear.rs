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
//! Up to its first tear a trouser test has an answer, and after it a tear takes a way of its own. So up to there
//! a strip is pulled again by a method that shares no force code. Verlet sums up the forces of springs by their
//! lengths. XPBD, with two sweeps at the same step, projects positions and reads forces off its multipliers.
//!
//! After the first tear a scene is chaotic, and two single runs of it differ by a fifth in half of all pairs. So
//! every method plays it with many seeds ([`ensemble`]), at its step and at a half and a quarter of it. A method
//! has *converged* in a quantity if its ensembles at half and at a quarter of its step have the same median. If
//! the finest ensembles of two methods that converged have the same median, they are the reference with which all
//! methods are compared. If no two of them agree, there is no reference.

mod chart;
mod scene;

pub use self::scene::EnsembleScene;
pub(crate) use self::scene::{STRIP_M, grid};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::{self, MemberStatus, Subject};
use tearmesh_cloth::scene::{Method, Scene};
use tearmesh_cloth::{Threshold, Xpbd};

use self::scene::Stage;
use crate::experiment::{Bounds, Experiment, Status, list};
use crate::method::DefaultMethod;

/// The default numbers of cells across the strips.
pub const CELLS: [u32; 5] = [8, 12, 16, 24, 32];

/// The default number of seeds of an ensemble.
pub const SEEDS: u64 = 16;

/// The numbers by which the steps of ensembles are divided.
const STEP_DIVISORS: [u32; 3] = [1, 2, 4];

/// The sweeps of XPBD in strips. One leaves edges several per cent too soft at Verlet's step.
const SWEEPS: u32 = 2;

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

/// The rules by which the edges of a strip tear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Rule {
    /// The ratio of length to rest length.
    Stretch,
    /// The energy per length of tear.
    Toughness,
}

impl Rule {
    /// Both rules.
    pub const ALL: [Rule; 2] = [Rule::Stretch, Rule::Toughness];

    /// Returns the name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Rule::Stretch => "stretch ratio",
            Rule::Toughness => "toughness",
        }
    }
}

/// What a row is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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
    #[default]
    Run,
}

/// A number of a strip, or a run of an ensemble. Cells that do not belong to a row are empty. A row without a
/// result is the key of a strip or of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What the row is about.
    pub what: What,
    /// The scene; the trouser test for strips.
    pub scene: EnsembleScene,
    /// The number of cells across.
    pub cells: u32,
    /// The way in which the run ended.
    pub status: Status,
    /// The rule by which a strip tears.
    pub rule: Option<Rule>,
    /// The threshold of the rule: a stretch ratio, or a toughness in J/m.
    pub threshold: Option<f64>,
    /// The distance of the clamps, in metres.
    pub displacement_m: Option<f64>,
    /// The force between the clamps, in newtons.
    pub force_n: Option<f64>,
    /// The method.
    pub method: Option<String>,
    /// The number by which the step was divided.
    pub step_divisor: Option<u32>,
    /// The seed.
    pub seed: Option<u64>,
    /// The rest length of the edges that tore, in metres.
    pub torn_m: Option<f64>,
    /// The number of components of the mesh at the end.
    pub pieces: Option<usize>,
    /// The largest force at a hold, in newtons.
    pub largest_force_n: Option<f64>,
    /// The work of all holds, in joules.
    pub work_j: Option<f64>,
    /// The reason of a failure.
    pub why: String,
}

impl Row {
    /// The stage of a strip or a run.
    fn stage(&self) -> Stage {
        let threshold = match (self.rule, self.threshold) {
            (Some(Rule::Toughness), Some(toughness)) => Threshold::Toughness(toughness),
            (_, ratio) => Threshold::Stretch(ratio.unwrap_or(Scene::STRETCH_RATIO)),
        };
        Stage::new(self.scene, self.cells, threshold)
    }

    /// The method of a run, and its place in [`DefaultMethod::NAMES`]; the default for a strip.
    fn method(&self) -> usize {
        let is_it = |name: &&str| Some(*name) == self.method.as_deref();
        let place = DefaultMethod::NAMES.iter().position(is_it);
        place.unwrap_or_default()
    }
}

impl Tear {
    /// Creates the experiment.
    #[must_use]
    pub fn new(options: Options) -> Tear {
        Tear { options }
    }

    /// The keys of strips, whose rules agree on the middle mesh.
    fn strips(&self) -> Vec<Row> {
        let strips = &self.options.strips;
        let Some(&middle) = strips.get(strips.len() / 2) else {
            return Vec::new();
        };
        let edge_m = STRIP_M[0] / f64::from(middle);
        let strain = Scene::STRETCH_RATIO - 1.0;
        // ½ k ε² h: the energy of an edge at the ratio.
        let toughness = 0.5 * Scene::STRETCH_N_PER_M * strain * strain * edge_m;
        let thresholds = [Scene::STRETCH_RATIO, toughness];
        let rules = Rule::ALL.into_iter().zip(thresholds);
        let keys = rules.flat_map(|(rule, threshold)| {
            strips.iter().map(move |&cells| Row {
                what: What::Largest,
                cells,
                rule: Some(rule),
                threshold: Some(threshold),
                ..Row::default()
            })
        });
        keys.collect()
    }

    /// The keys of the ensembles of a scene on a mesh.
    fn runs(&self, scene: EnsembleScene, cells: u32) -> Vec<Row> {
        let options = &self.options;
        let names = DefaultMethod::NAMES.into_iter();
        let names = names.filter(|name| options.methods.iter().any(|other| other == name));
        let steps = names.flat_map(|name| STEP_DIVISORS.map(|divisor| (name, divisor)));
        let keys = steps.flat_map(|(name, divisor)| {
            (1..=options.seeds).map(move |seed| Row {
                scene,
                cells,
                method: Some(name.to_owned()),
                step_divisor: Some(divisor),
                seed: Some(seed),
                ..Row::default()
            })
        });
        keys.collect()
    }
}

impl Experiment for Tear {
    type Key = Row;
    type Outcome = Vec<Row>;
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

    fn plan(&self) -> Vec<Vec<Row>> {
        let mut plan = vec![self.strips()];
        for &scene in &self.options.scenes {
            let sizes = match &self.options.cells[..] {
                [] => &[scene.cells()],
                sizes => sizes,
            };
            plan.extend(sizes.iter().map(|&cells| self.runs(scene, cells)));
        }
        plan.retain(|keys| !keys.is_empty());
        plan
    }

    fn name(&self, key: &Row) -> String {
        let (scene, cells) = (key.scene.name(), key.cells);
        match &key.method {
            None => format!("strip of {cells} cells"),
            Some(method) => format!("{scene} of {cells} cells by {method}"),
        }
    }

    /// A strip of n cells across has n² times as many edges as one of a cell, and steps 1/n as long. A mesh twice
    /// as fine has four times as many edges, and steps that are half as long if the method is explicit.
    fn guess_s(&self, key: &Row) -> f64 {
        let cells = f64::from(key.cells);
        let Some(divisor) = key.step_divisor else {
            return STRIP_S * cells.powi(3);
        };
        let at_default = RUN_S[key.method()][key.scene as usize];
        at_default * (cells / f64::from(key.scene.cells())).powf(2.5) * f64::from(divisor)
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let run = match key.what {
            What::Run => Ok(vec![ensemble_row(key, bounds.stop)]),
            _ => strip_rows(key, bounds.stop),
        };
        let rows = run.unwrap_or_else(|(status, why)| {
            vec![Row {
                status,
                why,
                ..key.clone()
            }]
        });
        (rows[0].status != Status::Interrupted).then_some(rows)
    }

    fn rows(&self, keys: &[Row], outcomes: Vec<Option<Vec<Row>>>) -> Vec<Row> {
        let both = keys.iter().zip(outcomes);
        let rows = both.flat_map(|(key, rows)| rows.unwrap_or_else(|| vec![key.clone()]));
        rows.collect()
    }
}

/// The CPU time of the tests of a strip with a cell across, in seconds.
const STRIP_S: f64 = 5e-3;

/// By method, the CPU time of a trouser test and of a rip on their own meshes, in seconds.
const RUN_S: [[f64; 2]; 5] = [[6.0, 1.2], [2.0, 0.5], [5.0, 2.5], [2.5, 0.8], [20.0, 6.0]];

/// Pulls a strip to the end, and by two methods with two steps each to its first tear.
fn strip_rows(key: &Row, stop: &dyn Fn() -> bool) -> Result<Vec<Row>, (Status, String)> {
    let stage = key.stage();
    let whole = stage.pull(Method::Verlet, None, true, stop)?;
    let row = |what, displacement_m: Option<f64>, force_n| Row {
        what,
        status: Status::Ok,
        displacement_m,
        force_n: Some(force_n),
        ..key.clone()
    };
    let mut rows = vec![
        row(What::Largest, None, whole.largest_n()),
        row(What::Mean, None, whole.tearing_n()),
    ];
    let first = |solver: Method, divisor: u32| {
        let step_s = whole.step_s / f64::from(divisor);
        let pull = stage.pull(solver, Some(step_s), false, stop);
        pull.map(|pull| pull.first_tear())
    };
    let xpbd = Method::Xpbd(Xpbd::new(1, SWEEPS));
    for (method, step_divisor, tear) in [
        ("verlet", 1, whole.first_tear()),
        ("verlet", 2, first(Method::Verlet, 2)?),
        ("xpbd", 1, first(xpbd.clone(), 1)?),
        ("xpbd", 2, first(xpbd, 2)?),
    ] {
        // Runs that did not tear are left out.
        rows.extend(tear.map(|[distance_m, force_n]| Row {
            method: Some(method.to_owned()),
            step_divisor: Some(step_divisor),
            ..row(What::First, Some(distance_m), force_n)
        }));
    }
    let curve = whole.curve();
    rows.extend(curve.map(|[distance_m, force_n]| row(What::Curve, Some(distance_m), force_n)));
    Ok(rows)
}

fn ensemble_row(key: &Row, stop: &dyn Fn() -> bool) -> Row {
    let stage = key.stage();
    let scene = Scene {
        solver: DefaultMethod::all()[key.method()].settings.clone(),
        ..stage.scene
    };
    let subject = Subject {
        mesh: &stage.mesh,
        positions: &stage.positions,
        frame: &stage.frame,
        scene: &scene,
        strengths: None,
    };
    let divisor = key.step_divisor.and_then(NonZero::new);
    let divisor = divisor.unwrap_or(NonZero::<u32>::MIN);
    let member = ensemble::member(subject, divisor, key.seed.unwrap_or_default(), stop);
    let observed = member.observed;
    Row {
        status: match member.status {
            MemberStatus::Done => Status::Ok,
            MemberStatus::Failed => Status::Failed,
            MemberStatus::Interrupted => Status::Interrupted,
        },
        torn_m: observed.map(|one| one.torn_m),
        pieces: observed.map(|one| one.pieces),
        largest_force_n: observed.and_then(|one| one.largest_force_n),
        work_j: observed.and_then(|one| one.work_j),
        why: member.why,
        ..key.clone()
    }
}

#[cfg(test)]
mod tests;
