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
//! A run that failed without a message is *silent*. A run *differs* if its outcome is not the expected one.
//! There should be neither.

mod chart;
mod limit;
mod net;
mod row;
mod trial;

pub use self::limit::{LIMITS, STIFFNESS_N_PER_M, Theory};
pub use self::row::Row;
pub use self::trial::{TRIALS, Trial};

use std::num::NonZero;

use crate::experiment::{Bounds, Experiment, list};

/// The experiment on stability.
#[derive(Clone, Debug)]
pub struct Stability {
    /// The stiffness values of the springs, in N/m. Each method is tried on each net at each of them.
    pub stiffness_n_per_m: Vec<f64>,
    /// The number of runs that may go on at a time.
    pub threads: NonZero<usize>,
}

/// A part of the experiment.
#[derive(Clone, Copy, Debug)]
pub enum Key {
    /// The steps of a method on all nets.
    Limit(&'static str, Theory),
    /// A scene, played by all methods.
    Trial(&'static Trial),
}

/// The CPU time of all steps at one stiffness, and of all scenes, in seconds, on the machine on which charts were
/// first made.
const LIMITS_S: f64 = 3.0;
const TRIALS_S: f64 = 9.0;

impl Experiment for Stability {
    type Key = Key;
    type Outcome = Vec<Row>;
    type Row = Row;

    fn command(&self) -> String {
        let stiffness = list(&self.stiffness_n_per_m);
        format!("tearmesh chart stability --stiffness {stiffness}")
    }

    fn threads(&self) -> NonZero<usize> {
        self.threads
    }

    fn plan(&self) -> Vec<Vec<Key>> {
        let limits = LIMITS.iter();
        let limits = limits.map(|&(method, theory)| Key::Limit(method, theory));
        vec![limits.chain(TRIALS.iter().map(Key::Trial)).collect()]
    }

    fn guess_s(&self, key: &Key) -> f64 {
        match key {
            Key::Limit(..) => LIMITS_S / LIMITS.len() as f64 * self.stiffness_n_per_m.len() as f64,
            Key::Trial(_) => TRIALS_S / TRIALS.len() as f64,
        }
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        match key {
            Key::Limit(method, theory) => {
                let stiffness = &self.stiffness_n_per_m;
                theory.rows(method, stiffness, bounds.stop)
            }
            Key::Trial(trial) => trial.rows(bounds.stop),
        }
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Vec<Row>>>) -> Vec<Row> {
        let interrupted = |key: &Key| {
            let (Key::Limit(name, _) | Key::Trial(Trial { name, .. })) = key;
            let place = (*name).to_owned();
            Row {
                place,
                ..Row::default()
            }
        };
        let each = keys.iter().zip(outcomes);
        let each = each.map(|(key, rows)| rows.unwrap_or_else(|| vec![interrupted(key)]));
        each.flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    use crate::experiment::{Chart, Provenance, Status, conduct, read_table, table};
    use crate::method::DEFAULTS;

    fn experiment() -> Stability {
        Stability {
            stiffness_n_per_m: vec![1e3],
            threads: NonZero::<usize>::MIN,
        }
    }

    fn name(key: &Key) -> &'static str {
        match key {
            Key::Limit(method, _) => method,
            Key::Trial(trial) => trial.name,
        }
    }

    fn rows_of(experiment: &Stability, names: &[&str]) -> Vec<Row> {
        let bounds = Bounds {
            clock: None,
            stop: &|| false,
        };
        let plan = experiment.plan().concat();
        let keys = plan.into_iter();
        let keys = keys.filter(|key| names.contains(&name(key)));
        let keys: Vec<Key> = keys.collect();
        assert_eq!(keys.len(), names.len());
        let outcomes = keys.iter().map(|key| experiment.run(key, &bounds));
        experiment.rows(&keys, outcomes.collect())
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
        let conducted = conduct(&experiment, &bounds, |_| {});
        assert_eq!(
            (conducted.done, conducted.rows.len()),
            (0, conducted.planned)
        );
        let is_interrupted = |row: &Row| row.status == Status::Interrupted && row.agrees.is_none();
        assert!(conducted.rows.iter().all(is_interrupted));
        assert!(count.load(Ordering::Relaxed) < 1000);
        let figure = experiment.figure(&conducted.rows, &Provenance::default());
        assert!(crate::plot::svg(&figure).contains("INTERRUPTED"));
    }
}
