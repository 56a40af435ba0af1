//! The page that answers which method to use for which scene.
//!
//! The ready scenes are played by every method at its default, and with a step four times and twice as long and
//! half as long. The cost is CPU time per simulated second. The error is that of what the scene is about
//! ([`Topic`]): the shape at rest of a sheet that hangs by two corners, the mean place and the spread of the free
//! corner of a flag, and the time and the force of the first tear of a rip and of a trouser test. What follows
//! the first tear is chaotic, so for that there are distributions over many seeds and no error.
//!
//! Errors are relative to a reference on the same mesh. A second reference, by a method that shares no stepping
//! code, gives the *error floor*: no error below ten times their distance is told from zero. The *mesh error* is
//! that of the first reference or of Verlet's method on meshes with other diagonals: nothing below it is worth
//! paying for. The gate of [`pareto`](crate::pareto) is run on each mesh.

mod chart;
mod play;

pub use self::play::{Role, Topic};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::statistics::{Random, median, quantile};

use self::play::{Measured, Play, Stage};
use crate::experiment::{Bounds, Experiment, Status};
use crate::method::DefaultMethod;
use crate::pareto::AMPLIFICATION_MAX;

/// The options of the page.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The number of cells along the longest side of the meshes, at least 8.
    pub cells: u32,
    /// The number of seeds of ensembles.
    pub seeds: u64,
    /// The number of meshes with other diagonals.
    pub diagonals: u64,
    /// The number of runs that may go on at a time.
    pub threads: NonZero<usize>,
}

impl Options {
    /// The default number of cells.
    pub const CELLS: u32 = 64;
    /// The default number of seeds of ensembles.
    pub const SEEDS: u64 = 16;
    /// The default number of meshes with other diagonals.
    pub const DIAGONALS: u64 = 8;
}

/// The multiples of its default step that each method is played with, beside the default.
pub const STEP_MULTIPLES: [f64; 3] = [4.0, 2.0, 0.5];

/// The experiment behind the page.
#[derive(Debug)]
pub struct Guide {
    options: Options,
    stages: Vec<Stage>,
}

/// A run.
#[derive(Clone, Debug)]
pub struct Key {
    stage: usize,
    role: Role,
    /// The index of the method in [`DefaultMethod::NAMES`].
    method: usize,
    step_multiple: Option<f64>,
    seed: u64,
}

/// A run with its errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    /// The time of the first tear in seconds.
    pub first_tear_s: Option<f64>,
    /// The force of the hand at the first tear, in newtons.
    pub first_force_n: Option<f64>,
    /// The torn length at the end, in metres.
    pub torn_m: Option<f64>,
    /// The work of all holds until the end, in joules.
    pub work_j: Option<f64>,
    /// The mean distance of the free corner from its place at rest, in metres.
    pub corner_m: Option<f64>,
    /// The rms distance of the free corner from its mean place, in metres.
    pub corner_spread_m: Option<f64>,
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

impl Guide {
    /// Creates the experiment.
    ///
    /// # Panics
    ///
    /// If the number of cells is less than 8 or more than a mesh can have.
    #[must_use]
    pub fn new(options: Options) -> Guide {
        assert!(options.cells >= 8, "at least 8 cells along a side");
        let mut stages = Vec::new();
        for topic in Topic::ALL {
            // Half of the cells only where there is a curve.
            let coarser = (topic != Topic::Aftermath).then_some(options.cells / 2);
            for cells in coarser.into_iter().chain([options.cells]) {
                let diagonals = if Some(cells) == coarser {
                    1
                } else {
                    options.diagonals
                };
                stages.extend((1..=diagonals).map(|seed| Stage::new(topic, cells, seed)));
            }
        }
        Guide { options, stages }
    }

    /// The keys of a stage: all roles on the first mesh of a topic, and one on its other meshes.
    fn keys(&self, number: usize) -> Vec<Key> {
        let stage = &self.stages[number];
        let key = |role: Role, method: usize, step_multiple: Option<f64>, seed: u64| Key {
            stage: number,
            role,
            method,
            step_multiple,
            seed,
        };
        let seeds = match stage.topic {
            Topic::Flag | Topic::Aftermath => self.options.seeds,
            Topic::Hang | Topic::Rip | Topic::Trouser => 0,
        };
        // Without an ensemble there is one run without noise.
        let all_seeds = seeds.min(1)..=seeds;
        if stage.diagonals > 1 {
            let few = seeds.min(1)..=seeds.min(MESH_SEEDS);
            return few.map(|seed| key(Role::Mesh, 0, None, seed)).collect();
        }
        let mut keys = Vec::new();
        for seed in all_seeds {
            if stage.topic != Topic::Aftermath {
                // Seeds of its own, as the same runs would have no error.
                let own = if seed > 0 { seed + REFERENCE_SEEDS } else { 0 };
                keys.push(key(Role::Reference, 0, None, own));
                keys.push(key(Role::Second, 0, None, own));
            }
            for method in 0..DefaultMethod::NAMES.len() {
                keys.push(key(Role::Method, method, None, seed));
                if stage.topic != Topic::Aftermath {
                    let multiples = STEP_MULTIPLES.into_iter().map(Some);
                    keys.extend(
                        multiples.map(|multiple| key(Role::Method, method, multiple, seed)),
                    );
                }
            }
        }
        if stage.topic != Topic::Aftermath {
            keys.extend([0, GATE_SEED].map(|seed| key(Role::Gate, 0, None, seed)));
        }
        keys
    }
}

/// The number of seeds of an ensemble on a mesh with other diagonals.
const MESH_SEEDS: u64 = 4;

/// The difference between the seeds of references and those of methods.
const REFERENCE_SEEDS: u64 = 1000;

/// The seed of the noise of the gate.
const GATE_SEED: u64 = 1;

impl Experiment for Guide {
    type Key = Key;
    type Outcome = Play;
    type Row = Row;

    fn command(&self) -> String {
        let Options {
            cells,
            seeds,
            diagonals,
            ..
        } = self.options;
        format!("tearmesh chart guide --size {cells} --seeds {seeds} --diagonals {diagonals}")
    }

    fn is_timed(&self) -> bool {
        true
    }

    fn threads(&self) -> NonZero<usize> {
        self.options.threads
    }

    fn plan(&self) -> Vec<Vec<Key>> {
        let keys: Vec<Key> = (0..self.stages.len())
            .flat_map(|number| self.keys(number))
            .collect();
        let group = |key: &Key| (self.stages[key.stage].topic, self.stages[key.stage].cells);
        keys.chunk_by(|a, b| group(a) == group(b))
            .map(<[Key]>::to_vec)
            .collect()
    }

    fn name(&self, key: &Key) -> String {
        let stage = &self.stages[key.stage];
        format!(
            "{} of {} cells by {}",
            stage.topic.name(),
            stage.cells,
            DefaultMethod::NAMES[key.method]
        )
    }

    fn guess_s(&self, key: &Key) -> f64 {
        self.stages[key.stage].guess_s(
            key.role,
            DefaultMethod::NAMES[key.method],
            key.step_multiple,
        )
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Play> {
        let stage = &self.stages[key.stage];
        stage.play(key.role, key.method, key.step_multiple, key.seed, bounds)
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Play>>) -> Vec<Row> {
        let plays: Vec<(&Key, Option<&Play>)> = keys
            .iter()
            .zip(outcomes.iter().map(Option::as_ref))
            .collect();
        let stage = |key: &Key| &self.stages[key.stage];
        // Of those that reached their end.
        let of = |role: Role| -> Vec<(&Key, &Measured)> {
            let of = plays.iter().filter(|(key, _)| key.role == role);
            of.filter_map(|(key, play)| Some((*key, play.as_ref()?.measured.as_ref()?)))
                .collect()
        };
        let bare = |of: &[(&Key, &Measured)]| -> Vec<Measured> {
            of.iter().map(|(_, measured)| (*measured).clone()).collect()
        };
        let [reference, second] = [Role::Reference, Role::Second].map(|role| bare(&of(role)));
        let gate = bare(&of(Role::Gate));
        let noise_amplification = match &gate[..] {
            [calm, noisy] => calm.apart_m(noisy).map(|apart_m| apart_m / NOISE_M),
            _ => None,
        };
        // Without a start in a given shape, only displacements are barred, and there are none.
        let grows = noise_amplification.is_none_or(|grown| grown > AMPLIFICATION_MAX);
        let is_barred = grows
            && keys
                .first()
                .is_some_and(|key| stage(key).topic == Topic::Hang);
        let has_reference = !reference.is_empty() && !second.is_empty() && !is_barred;
        let error = |ensemble: &[Measured]| match has_reference {
            true => play::error(ensemble, &reference),
            false => None,
        };
        let error_floor = error(&second);
        let error_noise = match &gate[..] {
            [calm, noisy] => play::error(std::slice::from_ref(noisy), std::slice::from_ref(calm)),
            _ => None,
        };
        let on_meshes = of(Role::Mesh);
        let on_meshes = on_meshes.chunk_by(|a, b| a.0.stage == b.0.stage);
        let error_mesh = median(on_meshes.filter_map(|of| error(&bare(of))).collect());
        plays
            .iter()
            .map(|(key, play)| {
                let is_it = |other: &&Key| {
                    let same =
                        |key: &Key| (key.role, key.method, key.step_multiple.map(f64::to_bits));
                    other.stage == key.stage && same(other) == same(key)
                };
                let ensemble: Vec<Measured> = plays
                    .iter()
                    .filter(|(other, _)| is_it(other))
                    .filter_map(|(_, play)| play.as_ref()?.measured.clone())
                    .collect();
                let errors = match key.role {
                    Role::Method => resampled(&ensemble, error),
                    _ => None,
                };
                let play = play.as_ref();
                let measured = play.and_then(|play| play.measured.as_ref());
                Row {
                    topic: stage(key).topic,
                    cells: stage(key).cells,
                    diagonals: stage(key).diagonals,
                    role: key.role,
                    method: match key.role {
                        Role::Second => "bdf2".to_owned(),
                        _ => DefaultMethod::NAMES[key.method].to_owned(),
                    },
                    step_multiple: key.step_multiple,
                    seed: key.seed,
                    status: play.map_or(Status::Interrupted, |play| play.status),
                    dt_s: play.map(|play| play.dt_s),
                    cpu_s_per_s: play.and_then(|play| play.cpu_s_per_s),
                    first_tear_s: measured.and_then(|one| one.first_tear_s),
                    first_force_n: measured.and_then(|one| one.first_force_n),
                    torn_m: measured.and_then(|one| one.torn_m),
                    work_j: measured.and_then(|one| one.work_j),
                    corner_m: measured.and_then(|one| Some(one.corner?.away_m)),
                    corner_spread_m: measured.and_then(|one| Some(one.corner?.spread_m)),
                    error: errors.map(|[_, middle, _]| middle),
                    error_low: errors.map(|[low, ..]| low),
                    error_high: errors.map(|[.., high]| high),
                    error_floor,
                    error_mesh,
                    error_noise,
                    noise_amplification,
                    why: play.map_or(String::new(), |play| play.why.clone()),
                }
            })
            .collect()
    }
}

/// The number of times that an ensemble is resampled.
const DRAWS: usize = 200;

/// The 10 %, 50 % and 90 % points of the error over resampled members of an ensemble; of one run, its error.
fn resampled(
    ensemble: &[Measured],
    error: impl Fn(&[Measured]) -> Option<f64>,
) -> Option<[f64; 3]> {
    if ensemble.len() < 2 {
        return error(ensemble).map(|error| [error; 3]);
    }
    let mut random = Random::new(2014);
    let mut draw = || -> Vec<Measured> {
        let draw = (0..ensemble.len()).map(|_| ensemble[random.below(ensemble.len())].clone());
        draw.collect()
    };
    let mut errors: Vec<f64> = (0..DRAWS).filter_map(|_| error(&draw())).collect();
    errors.sort_by(f64::total_cmp);
    let at = |fraction: f64| quantile(&errors, fraction);
    Some([at(0.1)?, at(0.5)?, at(0.9)?])
}

#[cfg(test)]
mod tests;
