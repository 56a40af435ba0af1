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

pub use self::limit::{LIMITS, STIFFNESS_N_PER_M, Theory};
pub use self::row::Row;
pub use self::trial::{TRIALS, Trial};

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

#[cfg(test)]
mod tests {
    use std::num::NonZero;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    use crate::experiment::{Chart, Provenance, Status, conduct, read_table, table};
    use crate::method::DEFAULTS;

    fn experiment() -> Stability {
        Stability {
            stiffness_n_per_m: vec![1e3],
        }
    }

    fn rows_of(experiment: &Stability, names: &[&str]) -> Vec<Row> {
        let bounds = Bounds {
            clock: None,
            stop: &|| false,
        };
        let plan = experiment.plan().concat();
        let keys = plan.iter().filter(|key| names.contains(&&*key.place));
        assert_eq!(keys.clone().count(), names.len());
        let rows = keys.map(|key| experiment.run(key, &bounds).expect("not interrupted"));
        experiment.assessed(rows.flatten().collect())
    }

    #[test]
    fn a_run_that_failed_without_a_message_is_silent() {
        for (measured, codes, expected) in [
            (Status::Wrong, &[][..], true),
            (Status::Wrong, &["W"][..], false),
            (Status::Ok, &[][..], false),
        ] {
            assert_eq!(trial::is_silent(measured, codes), expected);
        }
        let rows = rows_of(&experiment(), &["free fall", "wind"]);
        assert_eq!(rows.len(), 2 * DEFAULTS.len());
        for row in rows {
            let is_refused = row.place == "wind";
            assert_eq!(row.codes.contains("E-SIM-UNSTABLE"), is_refused, "{row:?}");
            assert_eq!(row.is_silent, Some(false), "{row:?}");
        }
    }

    #[test]
    fn the_figure_of_a_table_that_was_read_back_is_the_same() {
        let experiment = experiment();
        let names = ["rk4", "pbd-10", "wind"];
        let mut rows = rows_of(&experiment, &names);
        for row in &mut rows {
            row.codes = row.codes.replace("E-SIM", "E <and> \"SIM\"");
        }
        assert_eq!(rows.len(), 4 * 8 + 4 * 8 + 5);
        let text = table(&rows).expect("a table");
        let read: Vec<Row> = read_table(&text).expect("the same table");
        assert_eq!(read, rows);
        let svg = |rows: &[Row]| crate::plot::svg(&experiment.figure(rows, &Provenance::default()));
        assert_eq!(svg(&read), svg(&rows));
        assert!(!svg(&rows).contains("NaN") && !svg(&rows).contains("inf"));
        assert!(svg(&rows).contains("No method failed silently"));
    }

    #[test]
    fn an_interrupted_table_has_a_row_for_each_part() {
        let experiment = experiment();
        let count = AtomicUsize::new(0);
        let stop = || count.fetch_add(1, Ordering::Relaxed) > 10;
        let bounds = Bounds {
            clock: None,
            stop: &stop,
        };
        let (rows, done) = conduct(&experiment, NonZero::<usize>::MIN, &bounds, |_| {});
        let planned = experiment.plan().concat().len();
        assert_eq!((done, rows.len()), (0, planned));
        let is_interrupted = |row: &Row| row.status == Status::Interrupted && row.agrees.is_none();
        assert!(rows.iter().all(is_interrupted));
        assert!(count.load(Ordering::Relaxed) < 1000);
        let figure = experiment.figure(&rows, &Provenance::default());
        assert!(crate::plot::svg(&figure).contains("INTERRUPTED"));
    }
}
