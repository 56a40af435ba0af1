//! Figure 7 of the paper: the time to split vertices while a hanging cloth is ripped.
//!
//! "We use a scene where a hanged cloth patch is torn. We measure the time spent only in each call to the
//! splitting vertex routine and we record the sum of all these measurements taken during the whole scene. We
//! repeat this test ten times to obtain an average time value. Then, we repeat this process with triangle
//! meshes of different resolutions. For comparison purposes, we also test an implementation that do not use
//! the half-edge optimization" (Souza et al. 2014 §VI).
//!
//! Here the scene is [`Scene::rip`], with the default method and step. It is played once per mesh. After
//! each step, every implementation repeats the splits of that step with the same planes, on meshes of its
//! own, in ten rounds one after the other. So the processor's cache is no warmer than beside a simulation,
//! and all implementations are timed at the same moments. In the end, all must have the same triangles.
//!
//! The paper does not describe its standard implementation. Two readings are measured: one searches all
//! triangles for the faces of a vertex, and one keeps a list of faces for each vertex.

mod csv;
mod svg;
#[cfg(test)]
mod tests;
mod wanted;
mod way;

pub use self::csv::csv;
pub use self::svg::svg;

use std::fmt;
use std::time::Duration;

use serde::Serialize;
use tearmesh::{Mesh, Point, shapes};
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Axis, FRAME_S, Frame, Run, Scene};
use tearmesh_cloth::statistics;

use self::wanted::Wanted;
use self::way::Way;
use crate::parts::Missing;
use crate::provenance::Provenance;

/// The default numbers of cells along each side of the patches.
pub const CELLS: [u32; 4] = [8, 16, 32, 64];

/// The default number of times that each split is timed, as in the paper.
pub const ROUNDS: usize = 10;

/// The results of the experiment on the time of splits.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: &'static str,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The number of times that each split was timed.
    pub rounds: usize,
    /// The results of each patch, in the order of the `cells` of [`study`].
    pub tests: Vec<Test>,
    /// A summary of the results of the last patch, in words.
    pub conclusion: String,
    /// The patches whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

/// The results of one patch.
#[derive(Clone, Debug, Serialize)]
pub struct Test {
    /// The number of cells along each side of the patch.
    pub cells: u32,
    /// The number of vertices before the first tear.
    pub vertices: usize,
    /// The number of faces, which tearing does not change.
    pub faces: usize,
    /// The number of vertex splits.
    pub splits: usize,
    /// The number of frames of the scene, each 1/60 s long.
    pub frames: usize,
    /// The number of frames with at least one split.
    pub frames_with_splits: usize,
    /// The CPU time of the simulation in seconds, including its own tearing.
    pub simulation_s: f64,
    /// The times of each implementation.
    pub ways: Vec<Timed>,
}

/// The times of one implementation on one patch, without the overhead of reading the clock.
#[derive(Clone, Debug, Serialize)]
pub struct Timed {
    /// The name of the implementation in tables.
    pub way: &'static str,
    /// The time of all splits of the scene in seconds, for each round.
    pub sums_s: Vec<f64>,
    /// The mean of `sums_s`, which the paper shows.
    pub mean_s: f64,
    /// The median of `sums_s`.
    pub median_s: f64,
    /// The smallest and the largest of `sums_s`.
    pub range_s: [f64; 2],
    /// The time of all splits of the frame that took longest, in seconds: the median over all rounds.
    pub worst_frame_s: f64,
}

impl Timed {
    /// Returns `worst_frame_s` as a fraction of a frame of 1/60 s.
    #[must_use]
    pub fn part_of_frame(&self) -> f64 {
        self.worst_frame_s / FRAME_S
    }
}

/// An error of the experiment. Since the scene is fixed, it is a bug.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene was refused, or a step failed.
    Scene {
        /// The number of cells along each side of the patch.
        cells: u32,
        /// The reason in words.
        why: String,
    },
    /// An implementation ended with other triangles than the simulation.
    Differs {
        /// The number of cells along each side of the patch.
        cells: u32,
        /// The name of the implementation.
        way: &'static str,
    },
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StudyError::Scene { cells, why } => write!(f, "{cells} cells a side: {why}"),
            StudyError::Differs { cells, way } => {
                write!(
                    f,
                    "{cells} cells a side: {way} splits otherwise than the simulation"
                )
            }
        }
    }
}

impl std::error::Error for StudyError {}

/// Rips one patch for each entry of `cells`, which is its number of cells along each side.
///
/// `clock` returns the CPU time of the calling thread. `watch` is called after each step with the index of
/// the patch, from 0, and the fraction of its scene that is done. If `watch` returns false, the study stops,
/// and patches that were not finished are missing. The result is `None` if that leaves no patch.
///
/// # Errors
///
/// [`StudyError`], which would be a bug.
///
/// # Panics
///
/// If a number of cells is 0 or more than a mesh can have.
pub fn study(
    cells: &[u32],
    rounds: usize,
    provenance: Provenance,
    clock: &dyn Fn() -> Duration,
    mut watch: impl FnMut(usize, f64) -> bool,
) -> Result<Option<Study>, StudyError> {
    let (mut tests, mut missing) = (Vec::new(), Vec::new());
    for (i, &cells) in cells.iter().enumerate() {
        match rip(cells, rounds, clock, |part| watch(i, part))? {
            Some(test) => tests.push(test),
            None => missing.push(Missing::interrupted(format!("{cells} cells"))),
        }
    }
    if tests.is_empty() && !missing.is_empty() {
        return Ok(None);
    }
    Ok(Some(Study {
        schema: "tearmesh.chart.fig7/1",
        provenance,
        rounds,
        conclusion: conclude(&tests),
        tests,
        missing,
    }))
}

fn rip(
    cells: u32,
    rounds: usize,
    clock: &dyn Fn() -> Duration,
    mut watch: impl FnMut(f64) -> bool,
) -> Result<Option<Test>, StudyError> {
    let refused = |why: String| StudyError::Scene { cells, why };
    let (mesh, positions) = shapes::grid(cells, cells);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = Scene::rip(&frame);
    let mut stopwatch = Stopwatch::new(&mesh, rounds, clock);
    let mut wanted = Wanted::new(&mesh);
    let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
    let run = Run::new(mesh, &positions, scene, &frame);
    let mut run = run.map_err(|error| refused(error.to_string()))?;
    let mut simulation = Duration::ZERO;
    while !run.is_over() {
        let began = clock();
        let step = run.step();
        simulation += clock().saturating_sub(began);
        step.map_err(|error: StepError| refused(error.to_string()))?;
        let places = run.cloth().positions();
        let splits = wanted.of_step(run.edits(), places);
        let frame = frame_of(run.elapsed_s());
        stopwatch.play(splits, places, frame);
        let steps = run.steps_planned().max(1) as f64;
        if !watch(run.tally().steps as f64 / steps) {
            return Ok(None);
        }
    }
    let frames = frame_of(run.elapsed_s()) + 1;
    if let Some(way) = stopwatch.differs_from(run.mesh().indices()) {
        return Err(StudyError::Differs { cells, way });
    }
    Ok(Some(Test {
        cells,
        vertices,
        faces,
        splits: run.mesh().vertex_count() - vertices,
        frames,
        frames_with_splits: stopwatch.frames_with_splits,
        simulation_s: simulation.as_secs_f64(),
        ways: stopwatch.times(),
    }))
}

/// The frame in which a step ends.
fn frame_of(end_s: f64) -> usize {
    ((end_s / FRAME_S).ceil() as usize).saturating_sub(1)
}

/// All ways, each as often as there are rounds, and how long each took.
struct Stopwatch<'c> {
    clock: &'c dyn Fn() -> Duration,
    /// By way; the first does nothing, and is what it takes to look at the clock.
    lanes: Vec<Vec<Lane>>,
    /// The frame that is on.
    frame: Option<usize>,
    frames_with_splits: usize,
}

/// A way in one of its rounds.
struct Lane {
    way: Box<dyn Way>,
    /// In all, in this frame, and in the frame that had most.
    sum: Duration,
    now: Duration,
    most: Duration,
}

impl<'c> Stopwatch<'c> {
    fn new(mesh: &Mesh, rounds: usize, clock: &'c dyn Fn() -> Duration) -> Stopwatch<'c> {
        let lanes = way::all().into_iter().map(|make| {
            let lanes = (0..rounds).map(|_| Lane {
                way: make(mesh),
                sum: Duration::ZERO,
                now: Duration::ZERO,
                most: Duration::ZERO,
            });
            lanes.collect()
        });
        Stopwatch {
            clock,
            lanes: lanes.collect(),
            frame: None,
            frames_with_splits: 0,
        }
    }

    /// Has all ways make the splits of a step.
    fn play(&mut self, splits: &[wanted::Split], places: &[Point], frame: usize) {
        if splits.is_empty() {
            return;
        }
        if self.frame != Some(frame) {
            self.frame = Some(frame);
            self.frames_with_splits += 1;
            self.all().for_each(|lane| lane.now = Duration::ZERO);
        }
        let rounds = self.lanes.first().map_or(0, Vec::len);
        for round in 0..rounds {
            for lanes in &mut self.lanes {
                let lane = &mut lanes[round];
                lane.way.begin();
                let began = (self.clock)();
                for split in splits {
                    lane.way.split(split.vertex, &split.plane, places);
                }
                let took = (self.clock)().saturating_sub(began);
                lane.sum += took;
                lane.now += took;
                lane.most = lane.most.max(lane.now);
            }
        }
    }

    fn all(&mut self) -> impl Iterator<Item = &mut Lane> {
        self.lanes.iter_mut().flatten()
    }

    /// The name of a way that has other triangles than these.
    fn differs_from(&mut self, indices: &[u32]) -> Option<&'static str> {
        let mut ways = self.all().map(|lane| &lane.way);
        let other = ways.find(|way| way.indices().is_some_and(|other| other != indices));
        other.map(|way| way.name())
    }

    /// What each way took beyond what the clock does.
    fn times(&self) -> Vec<Timed> {
        let Some((nothing, ways)) = self.lanes.split_first() else {
            return Vec::new();
        };
        let idle = median(nothing.iter().map(|lane| lane.sum.as_secs_f64()).collect());
        let idle_frame = median(nothing.iter().map(|lane| lane.most.as_secs_f64()).collect());
        let timed = ways.iter().filter_map(|lanes| {
            let beyond = |of: fn(&Lane) -> Duration, idle: f64| -> Vec<f64> {
                let all = lanes.iter().map(|lane| of(lane).as_secs_f64() - idle);
                all.map(|seconds| seconds.max(0.0)).collect()
            };
            let sums_s = beyond(|lane| lane.sum, idle);
            let least = sums_s.iter().copied().fold(f64::INFINITY, f64::min);
            let most = sums_s.iter().copied().fold(0.0, f64::max);
            Some(Timed {
                way: lanes.first()?.way.name(),
                mean_s: sums_s.iter().sum::<f64>() / sums_s.len() as f64,
                median_s: median(sums_s.clone()),
                range_s: [least, most],
                worst_frame_s: median(beyond(|lane| lane.most, idle_frame)),
                sums_s,
            })
        });
        timed.collect()
    }
}

/// The median of some times; 0 of none.
fn median(seconds: Vec<f64>) -> f64 {
    statistics::median(seconds).unwrap_or(0.0)
}

fn conclude(tests: &[Test]) -> String {
    let Some(finest) = tests.last() else {
        return "nothing was ripped".to_owned();
    };
    let each = finest.ways.iter().map(|timed| {
        format!(
            "{} {:.3} ms ({:.2} % of the worst frame)",
            timed.way,
            1e3 * timed.mean_s,
            100.0 * timed.part_of_frame()
        )
    });
    let each: Vec<String> = each.collect();
    format!(
        "{n} x {n} cells: {} splits in {} of {} frames take {}; the simulation takes {:.0} ms",
        finest.splits,
        finest.frames_with_splits,
        finest.frames,
        each.join(", "),
        1e3 * finest.simulation_s,
        n = finest.cells,
    )
}
