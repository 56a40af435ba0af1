//! Stability: the steps at which each method fails, in theory and as measured, and the messages that users get.
//!
//! A *limit* concerns small motions of a net of springs: the step from which they grow without bound. Steps below
//! and above it are tried without the guard that refuses unstable steps, and compared with theory. The frequency
//! in theory comes from a dense matrix, which shares no code with the methods. The same steps with the guard show
//! which of them it refuses.
//!
//! A *scene* is played as a user would play it, by all methods at their default settings. Each scene is made
//! such that some of them fail, and it says which.
//!
//! A run is *dissipated* if its result is right, but it warns that the method lost more than a tenth of the energy
//! that went into motion (`W-SIM-DAMPED`). A run that failed without a message is *silent*. A run *differs* if its outcome is not the expected one.
//! There should be neither.

mod chart;
mod limit;
mod net;
mod row;
mod trial;

use self::limit::LIMITS;
pub use self::limit::STIFFNESS_N_PER_M;
pub(crate) use self::row::Row;
pub(crate) use self::trial::{TRIALS, Trial};

use crate::experiment::{Bounds, Experiment};

/// The experiment on stability.
#[derive(Clone, Debug)]
pub struct Stability {
    /// The stiffness values of the springs, in N/m. Each method is tried on each net at each of them.
    pub stiffness_n_per_m: Vec<f64>,
}

/// The CPU time of all steps at one stiffness, and of all scenes, in seconds, on the machine on which charts were
/// first made.
const LIMITS_S: f64 = 3.0;
const TRIALS_S: f64 = 9.0;

/// The scene of a key; `None` for the steps of a method on all nets.
fn trial(key: &Row) -> Option<&'static Trial> {
    TRIALS.iter().find(|trial| trial.name == key.place)
}

impl Experiment for Stability {
    type Row = Row;

    fn plan(&self) -> Vec<Vec<Row>> {
        let limits = LIMITS.iter().map(|(method, _)| *method);
        let names = limits.chain(TRIALS.iter().map(|trial| trial.name));
        let key = |name: &str| Row {
            place: name.to_owned(),
            ..Row::default()
        };
        vec![names.map(key).collect()]
    }

    fn guess_s(&self, key: &Row) -> f64 {
        match trial(key) {
            Some(_) => TRIALS_S / TRIALS.len() as f64,
            None => LIMITS_S / LIMITS.len() as f64 * self.stiffness_n_per_m.len() as f64,
        }
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        if let Some(trial) = trial(key) {
            return trial.rows(bounds.stop);
        }
        let (method, theory) = LIMITS.iter().find(|(method, _)| *method == key.place)?;
        theory.rows(method, &self.stiffness_n_per_m, bounds.stop)
    }
}
