//! Stability: the steps at which each method fails, in theory and as measured, and the messages that users get.
//!
//! A *limit* concerns small motions of a net of springs: the step from which they grow without bound. It is
//! found by bisection without the guard that refuses unstable steps, and compared with theory. The frequency
//! in theory comes from a dense matrix, which shares no code with the methods. Single steps below and above
//! the limit also show which of them the guard refuses.
//!
//! A *scene* is played as a user would play it, by all methods at their default settings. Each scene is made
//! such that some of them fail, and it says which.
//!
//! A run that failed without a message is *silent*. A run *differs* if its outcome is not the expected one.
//! There should be neither.

mod chart;
mod limit;
mod net;
mod outcome;
mod trial;

pub use self::limit::{AGREEMENT, LimitKey, STIFFNESS_N_PER_M, Theory};
pub use self::outcome::{Class, Message, Messages, Row, RowKind};
pub use self::trial::{ENERGY_GAIN_MAX, POSITION_ERROR_MAX, TRIALS, Trial};

use std::num::NonZero;

use self::limit::LIMITED;
use self::net::NETS;
use crate::experiment::list;
use crate::experiment::{Bounds, Experiment};

/// The options of the experiment on stability.
#[derive(Clone, Debug)]
pub struct Options {
    /// The stiffness values of the springs, in N/m. Each method is tried on each net at each of them.
    pub stiffness_n_per_m: Vec<f64>,
    /// The number of runs that may go on at a time.
    pub threads: NonZero<usize>,
}

/// The experiment on stability.
#[derive(Clone, Debug)]
pub struct Stability<M> {
    options: Options,
    messages: M,
}

/// A part of the experiment.
#[derive(Clone, Copy, Debug)]
pub enum Key {
    /// The limit of a method on a net.
    Limit(LimitKey),
    /// A scene, played by all methods.
    Trial(&'static Trial),
}

impl<M: Messages> Stability<M> {
    /// Creates the experiment.
    #[must_use]
    pub fn new(options: Options, messages: M) -> Stability<M> {
        Stability { options, messages }
    }
}

/// The CPU time of a limit and of a scene in seconds, on the machine on which charts were first made: 7 s for all
/// limits of one stiffness, and 10 s for all scenes.
const LIMIT_S: f64 = 7.0 / (LIMITED.len() * NETS.len()) as f64;
const TRIAL_S: f64 = 10.0 / TRIALS.len() as f64;

impl<M: Messages> Experiment for Stability<M> {
    type Key = Key;
    type Outcome = Vec<Row>;
    type Row = Row;

    fn command(&self) -> String {
        let stiffness = list(&self.options.stiffness_n_per_m);
        format!("tearmesh chart stability --stiffness {stiffness}")
    }

    fn threads(&self) -> NonZero<usize> {
        self.options.threads
    }

    fn plan(&self) -> Vec<Vec<Key>> {
        let limits = limit::keys(&self.options.stiffness_n_per_m).into_iter();
        let limits = limits.map(Key::Limit);
        vec![limits.chain(TRIALS.iter().map(Key::Trial)).collect()]
    }

    fn name(&self, key: &Key) -> String {
        match key {
            Key::Limit(key) => key.name(),
            Key::Trial(trial) => trial.name.to_owned(),
        }
    }

    fn guess_s(&self, key: &Key) -> f64 {
        match key {
            Key::Limit(_) => LIMIT_S,
            Key::Trial(_) => TRIAL_S,
        }
    }

    fn run(&self, key: &Key, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        match key {
            Key::Limit(key) => key.rows(&self.messages, bounds.stop),
            Key::Trial(trial) => trial.rows(&self.messages, bounds.stop),
        }
    }

    fn rows(&self, keys: &[Key], outcomes: Vec<Option<Vec<Row>>>) -> Vec<Row> {
        let interrupted = |key: &Key| match key {
            Key::Limit(key) => key.row(),
            Key::Trial(trial) => Row::new(RowKind::Scene, trial.name, ""),
        };
        let each = keys.iter().zip(outcomes);
        let each = each.map(|(key, rows)| rows.unwrap_or_else(|| vec![interrupted(key)]));
        each.flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use tearmesh_cloth::StepError;
    use tearmesh_cloth::scene::{Frame, Run};

    use super::*;

    use crate::experiment::{Chart, Provenance, Status, conduct, read_table, table};
    use crate::method::DefaultMethod;

    /// Says one word about what failed, or nothing.
    pub(super) struct Terse {
        pub(super) is_mute: bool,
    }

    impl Messages for Terse {
        fn of_step(&self, _: &StepError) -> Message {
            Message {
                code: "E".to_owned(),
                text: "\"no\", <and> that is that".to_owned(),
            }
        }

        fn of_run(&self, _: &Run, _: &Frame, error: Option<&StepError>) -> Vec<Message> {
            let error = error.filter(|_| !self.is_mute);
            error.map(|error| self.of_step(error)).into_iter().collect()
        }
    }

    fn experiment(is_mute: bool) -> Stability<Terse> {
        let options = Options {
            stiffness_n_per_m: vec![1e3],
            threads: NonZero::<usize>::MIN,
        };
        Stability::new(options, Terse { is_mute })
    }

    fn rows_of(experiment: &Stability<Terse>, names: &[&str]) -> Vec<Row> {
        let bounds = Bounds {
            clock: None,
            stop: &|| false,
        };
        let plan = experiment.plan().concat();
        let keys = plan.into_iter();
        let keys = keys.filter(|key| names.contains(&experiment.name(key).as_str()));
        let keys: Vec<Key> = keys.collect();
        assert_eq!(keys.len(), names.len());
        let outcomes = keys.iter().map(|key| experiment.run(key, &bounds));
        experiment.rows(&keys, outcomes.collect())
    }

    #[test]
    fn a_run_that_failed_without_a_message_is_silent() {
        for is_mute in [false, true] {
            let rows = rows_of(&experiment(is_mute), &["free fall", "wind"]);
            let silent = rows
                .iter()
                .map(|row| (&*row.place, &*row.method, row.is_silent));
            let expected = [("free fall", false), ("wind", is_mute)];
            let expected = expected.into_iter().flat_map(|(place, is_silent)| {
                DefaultMethod::NAMES.map(|method| (place, method, Some(is_silent)))
            });
            assert!(silent.eq(expected), "{rows:?}");
        }
    }

    #[test]
    fn the_figure_of_a_table_that_was_read_back_is_the_same() {
        let experiment = experiment(false);
        let names = [
            "string at 1e3 N/m by RK4",
            "chain at 1e3 N/m by PBD",
            "wind",
        ];
        let rows = rows_of(&experiment, &names);
        assert_eq!(rows.len(), 8 + 5 + 5);
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
        let experiment = experiment(false);
        let count = AtomicUsize::new(0);
        let stop = || count.fetch_add(1, Ordering::Relaxed) > 10;
        let bounds = Bounds {
            clock: None,
            stop: &stop,
        };
        let conducted = conduct(&experiment, &bounds, |_, _| {});
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
