//! The tasks: scenes at random, each with a tolerance.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::statistics::Random;

use crate::pareto::{Case, Held, MeshKind, Observable, Scene, Start, Until};

/// A scene drawn at random, and the error that is allowed in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The place of the task in the sequence of its seed, from 1.
    pub number: u32,
    /// The motion.
    pub motion: Motion,
    /// The stiffness of the edges, in N/m.
    pub stiffness_n_per_m: f64,
    /// The number of cells along each side of the mesh.
    pub cells: u32,
    /// Whether the mesh is a Delaunay triangulation of random points rather than a grid.
    pub is_delaunay: bool,
    /// The rate at which velocities decay by drag, in 1/s.
    pub drag_per_s: f64,
    /// The factor by which the mass of the particle nearest to the centre is multiplied.
    pub middle_mass_ratio: f64,
    /// The time that the scene takes, in seconds.
    pub seconds: f64,
    /// The largest relative error that is allowed.
    pub tolerance: f64,
}

/// The motions that a task can have.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// A sheet held by its upper edge is let go at 30°.
    Swing,
    /// A sheet in a frame, stretched by this fraction, sags under its weight.
    Taut(f64),
    /// A sheet in a frame, flat and at rest length, falls into its middle.
    Fall,
}

impl Motion {
    /// Returns the name of the motion in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Motion::Swing => "swing",
            Motion::Taut(_) => "taut",
            Motion::Fall => "fall",
        }
    }
}

/// The range of the stiffness of tasks, in N/m.
pub const STIFFNESS_N_PER_M: RangeInclusive<f64> = 1e2..=1e6;

/// The range of the mass ratio of tasks that have a light particle.
pub const MASS_RATIO: RangeInclusive<f64> = 1e-4..=1.0;

/// The range of the drag of tasks that have drag, in 1/s.
pub const DRAG_PER_S: RangeInclusive<f64> = 0.1..=100.0;

/// The range of the tolerances.
pub const TOLERANCE: RangeInclusive<f64> = 0.01..=0.2;

/// The range of the numbers of cells along a side.
pub const CELLS: RangeInclusive<u32> = 6..=20;

/// The range of the pretension of taut sheets, as a fraction of the length.
pub const PRETENSION: RangeInclusive<f64> = 0.002..=0.05;

/// The observables that are compared with the tolerance.
pub const OBSERVABLES: [Observable; 3] = [
    Observable::Displacement,
    Observable::ForceRms,
    Observable::ReactionLargest,
];

const ASKED: &[Observable] = &OBSERVABLES;

/// Returns the tasks of these numbers in the sequence of a seed.
#[must_use]
pub fn tasks(seed: u64, numbers: RangeInclusive<u32>, seconds: f64) -> Vec<Task> {
    let mut random = Random::new(seed);
    let all = (1..=*numbers.end()).map(|number| Task::drawn(number, &mut random, seconds));
    all.filter(|task| numbers.contains(&task.number)).collect()
}

impl Task {
    /// Each task takes as many numbers from the sequence, whether it needs them or not, so that a range
    /// that changes moves nothing else.
    fn drawn(number: u32, random: &mut Random, seconds: f64) -> Task {
        let mut between = |range: RangeInclusive<f64>| {
            let (from, to) = (range.start().ln(), range.end().ln());
            (from + (to - from) * random.next()).exp()
        };
        let stiffness_n_per_m = between(STIFFNESS_N_PER_M);
        let (drag_per_s, ratio) = (between(DRAG_PER_S), between(MASS_RATIO));
        let (pretension, tolerance) = (between(PRETENSION), between(TOLERANCE));
        let cells = CELLS.start() + random.below((CELLS.end() - CELLS.start() + 1) as usize) as u32;
        let motion = [Motion::Swing, Motion::Taut(pretension), Motion::Fall][random.below(3)];
        let is_delaunay = random.below(2) == 1;
        let has_drag = random.below(4) > 0;
        let is_light = random.below(2) == 1;
        Task {
            number,
            motion,
            stiffness_n_per_m,
            cells,
            is_delaunay,
            drag_per_s: if has_drag { drag_per_s } else { 0.0 },
            middle_mass_ratio: if is_light { ratio } else { 1.0 },
            seconds,
            tolerance,
        }
    }

    /// Returns the scene on its mesh.
    #[must_use]
    pub fn case(&self) -> Case {
        const G: f64 = 9.81;
        let (start, held, gravity_m_per_s2) = match self.motion {
            Motion::Swing => (Start::Turned, Held::Top, [0.0, -G, 0.0]),
            Motion::Taut(part) => (Start::Taut(part), Held::Frame, [0.0, 0.0, -G]),
            Motion::Fall => (Start::Flat, Held::Frame, [0.0, 0.0, -G]),
        };
        let scene = Scene {
            name: "task",
            about: "drawn at random",
            stiffness_n_per_m: self.stiffness_n_per_m,
            side_m: 1.0,
            gravity_m_per_s2,
            drag_per_s: self.drag_per_s,
            start,
            middle_mass_ratio: self.middle_mass_ratio,
            held,
            until: Until::Time(self.seconds),
            observables: ASKED,
            is_gated: true,
        };
        let mesh = match self.is_delaunay {
            true => MeshKind::Delaunay,
            false => MeshKind::Grid,
        };
        Case::new(&scene, mesh, self.cells)
    }

    /// Returns an estimate of the work, in visits of edges: steps of a length at which a pull travels an
    /// edge, by edges, by what all runs take of them.
    #[must_use]
    pub fn guess(&self) -> f64 {
        const RUNS: f64 = 600.0;
        let cells = f64::from(self.cells);
        let steps = self.seconds * (self.stiffness_n_per_m / 0.15).sqrt() * cells;
        RUNS * (steps + 100.0) * 3.0 * cells * cells
    }
}
