//! Figure 7 of the paper: the time to split vertices while a hanging cloth is ripped.
//!
//! "We use a scene where a hanged cloth patch is torn. We measure the time spent only in each call to the
//! splitting vertex routine and we record the sum of all these measurements taken during the whole scene. We
//! repeat this test ten times to obtain an average time value. Then, we repeat this process with triangle
//! meshes of different resolutions. For comparison purposes, we also test an implementation that do not use
//! the half-edge optimization" (Souza et al. 2014 §VI).
//!
//! Here the scene is [`Scene::rip`], with the default method and step. It is simulated once per mesh. After
//! each step, every implementation repeats the splits of that step with the same planes, on meshes of its
//! own, in ten rounds one after the other. So the processor's cache is no warmer than beside a simulation,
//! and all implementations are timed at the same moments. In the end, all must have the same triangles.
//!
//! The paper does not describe its standard implementation. Two readings are measured: one searches all
//! triangles for the faces of a vertex, and one keeps a list of faces for each vertex.

mod chart;
mod implementations;
mod splits;

use std::num::NonZero;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Point, shapes};
use tearmesh_cloth::scene::{Axis, FRAME_S, Frame, Run, Scene};
use tearmesh_cloth::statistics::median;

use self::implementations::{IMPLEMENTATIONS, Implementation};
use self::splits::{Replica, Split};
use crate::experiment::list;
use crate::experiment::{Bounds, Experiment, Status};

/// The default numbers of cells along each side of the patches.
pub const CELLS: [u32; 4] = [8, 16, 32, 64];

/// The number of times that each split is timed, as in the paper.
pub const ROUNDS: usize = 10;

/// The CPU time of a rip of a patch of one cell in seconds, on the machine on which charts were first made. A
/// patch with n cells per side has n² cells, and steps that are n times as short.
const CELL_S: f64 = 3e-5;

/// The experiment on the time of splits.
#[derive(Clone, Debug)]
pub struct Fig7 {
    /// The numbers of cells along each side of the patches. None may be 0 or more than a mesh can have.
    pub cells: Vec<u32>,
}

/// An implementation on a patch in one of its rounds. A patch whose rip was interrupted has one row without
/// times. Times are without the overhead of reading the clock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The number of cells along each side of the patch.
    pub cells: u32,
    /// The number of vertices before the first tear.
    pub vertices: Option<usize>,
    /// The number of faces, which tearing does not change.
    pub faces: Option<usize>,
    /// The number of vertex splits.
    pub splits: Option<usize>,
    /// The number of frames of the scene, each 1/60 s long.
    pub frames: Option<usize>,
    /// The number of frames with at least one split.
    pub frames_with_splits: Option<usize>,
    /// The CPU time of the simulation in seconds, including its own tearing.
    pub simulation_s: Option<f64>,
    /// The name of the implementation.
    pub implementation: String,
    /// The number of the round, from 0.
    pub round: Option<usize>,
    /// The time of all splits of the scene in this round, in seconds.
    pub sum_s: Option<f64>,
    /// The mean of `sum_s` over all rounds, which the paper shows.
    pub mean_s: Option<f64>,
    /// The median of `sum_s` over all rounds.
    pub median_s: Option<f64>,
    /// The time of all splits of the frame that took longest, in seconds: the median over all rounds.
    pub worst_frame_s: Option<f64>,
    /// Whether the rip reached its end.
    pub status: Status,
    /// The reason why there are no times.
    pub why: String,
}

impl Experiment for Fig7 {
    type Key = u32;
    type Outcome = Vec<Row>;
    type Row = Row;

    fn command(&self) -> String {
        format!("tearmesh chart fig7 --size {}", list(&self.cells))
    }

    fn is_timed(&self) -> bool {
        true
    }

    fn threads(&self) -> NonZero<usize> {
        // Rips beside each other would share the processor's cache.
        NonZero::<usize>::MIN
    }

    fn plan(&self) -> Vec<Vec<u32>> {
        self.cells.iter().map(|&cells| vec![cells]).collect()
    }

    fn name(&self, cells: &u32) -> String {
        format!("{cells} cells")
    }

    fn guess_s(&self, &cells: &u32) -> f64 {
        CELL_S * f64::from(cells).powi(3)
    }

    fn run(&self, &cells: &u32, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        rip(cells, bounds)
    }

    fn rows(&self, keys: &[u32], outcomes: Vec<Option<Vec<Row>>>) -> Vec<Row> {
        let rows = keys.iter().zip(outcomes);
        let rows = rows.flat_map(|(&cells, rows)| rows.unwrap_or_else(|| vec![interrupted(cells)]));
        rows.collect()
    }
}

fn interrupted(cells: u32) -> Row {
    Row {
        cells,
        vertices: None,
        faces: None,
        splits: None,
        frames: None,
        frames_with_splits: None,
        simulation_s: None,
        implementation: String::new(),
        round: None,
        sum_s: None,
        mean_s: None,
        median_s: None,
        worst_frame_s: None,
        status: Status::Interrupted,
        why: "the rip was interrupted".to_owned(),
    }
}

/// Rips a patch, with all implementations beside the simulation.
fn rip(cells: u32, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
    let (mesh, positions) = shapes::grid(cells, cells);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
    let mut trials = Trials::new(&mesh);
    let mut replica = Replica::new(&mesh);
    let run = Run::new(mesh, &positions, Scene::rip(&frame), &frame);
    let mut run = run.expect("the scene suits every patch");
    let mut simulation = Duration::ZERO;
    let frame_of = |end_s: f64| ((end_s / FRAME_S).ceil() as usize).saturating_sub(1);
    while !run.is_over() {
        if (bounds.stop)() {
            return None;
        }
        let began = bounds.now();
        let step = run.step();
        simulation += bounds.now().saturating_sub(began);
        step.expect("no step of a rip fails");
        let places = run.cloth().positions();
        let splits = replica.follow(run.edits(), places);
        trials.split(&splits, places, frame_of(run.elapsed_s()), bounds);
    }
    for (trials, (name, _)) in trials.of.iter().zip(IMPLEMENTATIONS).skip(1) {
        let has_same = |trial: &Trial| trial.implementation.indices() == run.mesh().indices();
        assert!(
            trials.iter().all(has_same),
            "{name}: splits leave the triangles of the simulation"
        );
    }
    Some(trials.rows(&Row {
        vertices: Some(vertices),
        faces: Some(faces),
        splits: Some(run.mesh().vertex_count() - vertices),
        frames: Some(frame_of(run.elapsed_s()) + 1),
        simulation_s: Some(simulation.as_secs_f64()),
        status: Status::Ok,
        why: String::new(),
        ..interrupted(cells)
    }))
}

/// All implementations, each in all rounds, with their times.
struct Trials {
    /// By implementation and round. The first does nothing; its time is the overhead of reading the clock.
    of: Vec<Vec<Trial>>,
    /// The number of the last frame with a split.
    frame: Option<usize>,
}

/// An implementation in one of its rounds.
struct Trial {
    implementation: Box<dyn Implementation>,
    /// The time of the splits of each frame that has any.
    frames: Vec<Duration>,
}

impl Trials {
    fn new(mesh: &Mesh) -> Trials {
        let of = IMPLEMENTATIONS.map(|(_, new)| {
            let trials = (0..ROUNDS).map(|_| Trial {
                implementation: new(mesh),
                frames: Vec::new(),
            });
            trials.collect()
        });
        Trials {
            of: of.into(),
            frame: None,
        }
    }

    /// Makes the splits of a step with every implementation, round by round.
    fn split(&mut self, splits: &[Split], places: &[Point], frame: usize, bounds: &Bounds<'_>) {
        if splits.is_empty() {
            return;
        }
        if self.frame.replace(frame) != Some(frame) {
            let trials = self.of.iter_mut().flatten();
            trials.for_each(|trial| trial.frames.push(Duration::ZERO));
        }
        for round in 0..self.of[0].len() {
            for trials in &mut self.of {
                let Trial {
                    implementation,
                    frames,
                } = &mut trials[round];
                implementation.begin();
                let began = bounds.now();
                for split in splits {
                    implementation.split(split, places);
                }
                let took = bounds.now().saturating_sub(began);
                *frames.last_mut().expect("a frame has begun") += took;
            }
        }
    }

    /// The rows of a patch, with times beyond the overhead.
    fn rows(&self, patch: &Row) -> Vec<Row> {
        let sum = |trial: &Trial| trial.frames.iter().sum();
        let worst = |trial: &Trial| trial.frames.iter().max().copied().unwrap_or_default();
        let mut rows = Vec::new();
        for (trials, (name, _)) in self.of.iter().zip(IMPLEMENTATIONS).skip(1) {
            let sums_s = beyond_s(trials, &self.of[0], sum);
            rows.extend(sums_s.iter().enumerate().map(|(round, &sum_s)| Row {
                frames_with_splits: Some(trials[round].frames.len()),
                implementation: name.to_owned(),
                round: Some(round),
                sum_s: Some(sum_s),
                mean_s: Some(sums_s.iter().sum::<f64>() / sums_s.len() as f64),
                median_s: median(sums_s.clone()),
                worst_frame_s: median(beyond_s(trials, &self.of[0], worst)),
                ..patch.clone()
            }));
        }
        rows
    }
}

/// A time of each trial beyond its median over idle ones, in seconds, and at least 0.
fn beyond_s(trials: &[Trial], idle: &[Trial], time: fn(&Trial) -> Duration) -> Vec<f64> {
    let seconds = |trial: &Trial| time(trial).as_secs_f64();
    let idle_s = median(idle.iter().map(seconds).collect()).unwrap_or(0.0);
    let beyond = trials
        .iter()
        .map(|trial| (seconds(trial) - idle_s).max(0.0));
    beyond.collect()
}

#[cfg(test)]
mod tests;
