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

use std::time::Duration;

use serde::{Deserialize, Serialize};
use tearmesh::geometry::{Plane, Side};
use tearmesh::{Edit, Edits, Mesh, Point, VertexId, classify, shapes, split};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};

use self::implementations::{IDLE, IMPLEMENTATIONS, Implementation, New, Split};
use crate::experiment::{Bounds, Experiment, Status};
use crate::statistics::median;

/// The number of times that each split is timed, as in the paper.
pub(crate) const ROUNDS: usize = 10;

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
/// times. Times of splits are without the overhead of reading the clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The number of cells along each side of the patch.
    pub(crate) cells: u32,
    /// The number of faces, which tearing does not change.
    pub(crate) faces: Option<usize>,
    /// The number of vertex splits.
    pub(crate) splits: Option<usize>,
    /// The CPU time of the simulation in seconds, including its own tearing.
    pub(crate) simulation_s: Option<f64>,
    /// The name of the implementation.
    pub(crate) implementation: String,
    /// The number of the round, from 0.
    pub(crate) round: Option<usize>,
    /// The time of all splits of the scene in this round, in seconds.
    pub(crate) sum_s: Option<f64>,
    /// Whether the rip reached its end.
    pub(crate) status: Status,
}

impl Experiment for Fig7 {
    type Row = Row;

    const IS_ALONE: bool = true;
    const IS_TIMED: bool = true;

    fn plan(&self) -> Vec<Vec<Row>> {
        let key = |&cells: &u32| Row {
            cells,
            ..Row::default()
        };
        vec![self.cells.iter().map(key).collect()]
    }

    fn guess_s(&self, patch: &Row) -> f64 {
        CELL_S * f64::from(patch.cells).powi(3)
    }

    /// Rips a patch, with all implementations beside the simulation.
    fn run(&self, patch: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let (mesh, positions) = shapes::grid(patch.cells, patch.cells);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let trial = |(name, new): (_, New)| Trial {
            name,
            implementation: new(&mesh),
            time: Duration::ZERO,
        };
        let trials = (0..ROUNDS).flat_map(|_| IMPLEMENTATIONS.map(trial));
        let mut trials: Vec<Trial> = trials.collect();
        let mut replica = mesh.clone();
        let run = Run::new(mesh, &positions, Scene::rip(&frame), &frame);
        let mut run = run.expect("the scene suits every patch");
        let mut simulation = Duration::ZERO;
        while !run.is_over() {
            if (bounds.stop)() {
                return None;
            }
            let began = bounds.now();
            let step = run.step();
            simulation += bounds.now().saturating_sub(began);
            step.expect("no step of a rip fails");
            let places = run.cloth().positions();
            let splits = follow(&mut replica, run.edits(), places);
            measure(&mut trials, &splits, places, bounds);
        }
        for trial in trials.iter().filter(|trial| trial.name != IDLE) {
            let is_same = trial.implementation.indices() == run.mesh().indices();
            assert!(is_same, "{}: splits as in the simulation", trial.name);
        }
        let patch = Row {
            faces: Some(replica.face_count()),
            splits: Some(replica.vertex_count() - positions.as_slice().len()),
            simulation_s: Some(simulation.as_secs_f64()),
            status: Status::Ok,
            ..patch.clone()
        };
        Some(rows(&trials, &patch))
    }
}

/// Repeats the log of a step on a copy of the mesh, given the places of the vertices after it, and returns its
/// splits.
///
/// The log has the faces that went to a new vertex, and not the plane that divided them. By the paper's rule the
/// plane goes through the vertex, and its normal leads to the other end of the overstretched edge. So it is the
/// plane toward the first neighbour that divides the faces as they were divided.
fn follow(replica: &mut Mesh, edits: &Edits, places: &[Point]) -> Vec<Split> {
    let splits = edits.iter().map(|edit| {
        let Edit::Split(done) = edit else {
            panic!("a rip does nothing but split");
        };
        let (vertex, at) = (done.old, places[done.old.index()]);
        let toward = |other: VertexId| {
            let plane = Plane::new(at, places[other.index()] - at).ok()?;
            let divides = replica.corners_of(vertex).all(|h| {
                let side = classify::face(replica, h.face(), &plane, places);
                (side == Side::Back) == done.corners.contains(&h)
            });
            divides.then_some(plane)
        };
        let plane = replica
            .corners_of(vertex)
            .flat_map(|h| [replica.target(h), replica.origin(h.prev())])
            .find_map(toward);
        let plane = plane.expect("a rip splits by a plane that leads to a neighbour");
        let mut again = Edits::new();
        split::by_plane(replica, vertex, &plane, places, &mut again);
        assert!(!again.is_empty(), "a split can be repeated on a copy");
        Split { vertex, plane }
    });
    splits.collect()
}

/// An implementation in one of its rounds.
struct Trial {
    name: &'static str,
    implementation: Box<dyn Implementation>,
    /// The time of all splits.
    time: Duration,
}

/// Makes the splits of a step in every trial.
fn measure(trials: &mut [Trial], splits: &[Split], places: &[Point], bounds: &Bounds<'_>) {
    if splits.is_empty() {
        return;
    }
    for trial in trials {
        let began = bounds.now();
        for split in splits {
            trial.implementation.split(split, places);
        }
        trial.time += bounds.now().saturating_sub(began);
    }
}

/// The rows of a patch, with times beyond the median of the idle trials, and at least 0.
fn rows(trials: &[Trial], patch: &Row) -> Vec<Row> {
    let of = |name| trials.iter().filter(move |trial| trial.name == name);
    let idle_s = of(IDLE).map(|trial| trial.time.as_secs_f64()).collect();
    let idle_s = median(idle_s).unwrap_or(0.0);
    let names = IMPLEMENTATIONS[1..].iter().map(|(name, _)| *name);
    let rows = names.flat_map(|name| {
        of(name).enumerate().map(move |(round, trial)| Row {
            implementation: name.to_owned(),
            round: Some(round),
            sum_s: Some((trial.time.as_secs_f64() - idle_s).max(0.0)),
            ..patch.clone()
        })
    });
    rows.collect()
}

#[cfg(test)]
mod tests;
