//! Time steps: whether the result of a scene depends on its time step.
//!
//! Tearing is chaotic, so two single runs say nothing. The scene is played with many seeds
//! (an ensemble) at its step and at half of it, and the medians of both are compared.

mod chart;

pub use crate::ensemble::Subject;

use std::num::NonZero;

use serde::{Deserialize, Serialize};

use crate::ensemble;
use crate::experiment::{Bounds, Experiment, Status};

/// The experiment on the time step of a scene, and its options.
#[derive(Clone, Debug)]
pub struct Step<'a> {
    /// The cloth and the scene to play; `None` if a table of earlier runs is drawn.
    pub subject: Option<Subject<'a>>,
    /// The time step of the scene, in seconds.
    pub step_s: f64,
    /// The number of seeds at each step.
    pub seeds: u64,
}

/// The default number of seeds at each step.
pub const SEEDS: u64 = 8;

/// The numbers by which the step is divided. The shorter step costs more, and begins first.
const STEP_DIVISORS: [u32; 2] = [2, 1];

/// The CPU time of a step for each half-edge, in seconds, on the machine on which charts were first made.
const PER_HALF_EDGE_S: f64 = 3e-8;

/// A run. Without results it is the key of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The number by which the step was divided.
    step_divisor: u32,
    /// The divided step, in seconds.
    step_s: f64,
    /// The seed.
    seed: u64,
    /// The way in which the run ended.
    status: Status,
    /// The time of the first tear, in seconds; empty if nothing tore.
    first_tear_s: Option<f64>,
    /// The force at the first tear, in newtons, where the method knows it.
    first_force_n: Option<f64>,
    /// The rest length of the edges that tore, in metres.
    torn_m: Option<f64>,
    /// The number of components of the mesh at the end.
    pieces: Option<usize>,
    /// The largest force at a hold, in newtons, as a mean over 1/60 s.
    largest_force_n: Option<f64>,
    /// The work of all holds, in joules.
    work_j: Option<f64>,
    /// The reason of a failure.
    why: String,
}

impl Experiment for Step<'_> {
    type Row = Row;

    fn plan(&self) -> Vec<Vec<Row>> {
        let keys = STEP_DIVISORS.into_iter().flat_map(|step_divisor| {
            (1..=self.seeds).map(move |seed| Row {
                step_divisor,
                step_s: self.step_s / f64::from(step_divisor),
                seed,
                ..Row::default()
            })
        });
        vec![keys.collect()]
    }

    fn guess_s(&self, key: &Row) -> f64 {
        self.subject.map_or(0.0, |subject| {
            let steps = subject.scene.duration_s / key.step_s;
            steps * subject.mesh.half_edges().count() as f64 * PER_HALF_EDGE_S
        })
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let step_divisor = NonZero::new(key.step_divisor)?;
        let row = match ensemble::observe(self.subject?, step_divisor, key.seed, bounds.stop)? {
            Ok(observed) => Row {
                status: Status::Ok,
                first_tear_s: observed.first_tear_s,
                first_force_n: observed.first_force_n,
                torn_m: Some(observed.torn_m),
                pieces: Some(observed.pieces),
                largest_force_n: observed.largest_force_n,
                work_j: observed.work_j,
                ..key.clone()
            },
            Err(why) => Row {
                status: Status::Failed,
                why,
                ..key.clone()
            },
        };
        Some(vec![row])
    }
}

#[cfg(test)]
mod tests;
