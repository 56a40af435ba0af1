//! Experiments: a plan of runs, a table with a row for each, and a figure of the table.
//!
//! An `Experiment` lists the keys of its runs, in groups that are assessed together, and carries out a run by
//! its key. [`Chart::run`] does all runs of the plan on a pool of threads, group by group. A run that failed, or that
//! an interruption left out, is a row with a status. The table has the rows as CSV; [`Chart::draw`] draws it, and
//! nothing else, so a table from a file gives the same figure.

use std::num::NonZero;
use std::sync::{Mutex, mpsc};
use std::thread;
use std::time::Duration;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::plot::{Figure, svg};

/// An experiment: what is run, and what is written down of it.
pub(crate) trait Experiment: Sync {
    /// A line of the table. Without results, as [`plan`](Experiment::plan) returns it, it is the key of a run.
    type Row: Clone + Send + Sync + Serialize + DeserializeOwned;

    /// Whether runs go on one by one, since beside each other they would wait for the same memory, or share the
    /// processor's cache.
    const IS_ALONE: bool = false;

    /// Whether the experiment measures CPU time.
    const IS_TIMED: bool = false;

    /// Returns how many of so many threads are used; see [`IS_ALONE`](Experiment::IS_ALONE).
    fn threads(&self, most: NonZero<usize>) -> NonZero<usize> {
        if Self::IS_ALONE {
            NonZero::<usize>::MIN
        } else {
            most
        }
    }

    /// Returns the keys of all runs, in groups that are assessed together, and in the order in which they begin.
    /// The costliest of a group are best first, since the last ones may leave a thread idle.
    fn plan(&self) -> Vec<Vec<Self::Row>>;

    /// Returns an estimate of the CPU time of a run, in seconds.
    fn guess_s(&self, key: &Self::Row) -> f64;

    /// Carries out a run and returns its rows, at least one. Returns `None` if it was interrupted; then its key is
    /// its row.
    fn run(&self, key: &Self::Row, bounds: &Bounds<'_>) -> Option<Vec<Self::Row>>;

    /// Returns the rows of the table, given those of all runs of a group in the order of their keys.
    fn assessed(&self, rows: Vec<Self::Row>) -> Vec<Self::Row> {
        rows
    }
}

/// An experiment that is drawn and summed up in words, from its table alone.
pub(crate) trait Draw: Experiment {
    /// Returns the figure of a table. Its footer is how to read it; the origin is added.
    fn figure(&self, rows: &[Self::Row]) -> Figure;

    /// Returns a summary of a table in words.
    fn summary(&self, rows: &[Self::Row]) -> String;
}

/// An experiment whose rows are hidden: it is run to a table, and drawn from one.
pub trait Chart {
    /// Returns whether the experiment measures CPU time.
    fn is_timed(&self) -> bool;

    /// Returns the number of runs.
    fn runs(&self) -> usize;

    /// Returns an estimate of the time of all runs on up to `threads` threads, in seconds.
    fn guess_s(&self, threads: NonZero<usize>) -> f64;

    /// Carries out all runs on up to `threads` threads. Returns their table as CSV, and the number of runs that were
    /// not interrupted.
    ///
    /// `watch` is called after each run with the estimated fraction of all work that is done. Once `bounds.stop`
    /// returns true, no other run is begun.
    fn run(
        &self,
        threads: NonZero<usize>,
        bounds: &Bounds<'_>,
        watch: &mut dyn FnMut(f64),
    ) -> (String, usize);

    /// Draws a table.
    ///
    /// # Errors
    ///
    /// [`csv::Error`] with the line of the first row that is not one of this chart.
    fn draw(&self, table: &str, provenance: &Provenance) -> Result<Drawing, csv::Error>;
}

/// A table as a figure and in words.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The figure as SVG.
    pub svg: String,
    /// The table as CSV, as experiments write it; empty if it has no rows.
    pub table: String,
    /// The summary in words.
    pub summary: String,
}

impl<E: Draw> Chart for E {
    fn is_timed(&self) -> bool {
        E::IS_TIMED
    }

    fn runs(&self) -> usize {
        self.plan().iter().map(Vec::len).sum()
    }

    fn guess_s(&self, threads: NonZero<usize>) -> f64 {
        guess_s(self, &self.plan()) / self.threads(threads).get() as f64
    }

    fn run(
        &self,
        threads: NonZero<usize>,
        bounds: &Bounds<'_>,
        watch: &mut dyn FnMut(f64),
    ) -> (String, usize) {
        let (rows, done) = conduct(self, threads, bounds, watch);
        (table(&rows), done)
    }

    fn draw(&self, text: &str, provenance: &Provenance) -> Result<Drawing, csv::Error> {
        let rows: Vec<E::Row> = read_table(text)?;
        let ends: Vec<End> = read_table(text)?;
        let mut figure = self.figure(&rows);
        figure.footer.push(provenance.line());
        if ends.iter().any(|end| end.status == Status::Interrupted) {
            let missing = "INTERRUPTED: runs that were not done are missing.";
            figure.footer.push(missing.to_owned());
        }
        Ok(Drawing {
            svg: svg(&figure),
            table: table(&rows),
            summary: self.summary(&rows),
        })
    }
}

/// The column that all tables have.
#[derive(Deserialize)]
struct End {
    status: Status,
}

/// The means that a run is given from outside.
#[derive(Clone, Copy)]
pub struct Bounds<'a> {
    /// The function that returns the CPU time of the calling thread; `None` to measure no times.
    pub clock: Option<&'a (dyn Fn() -> Duration + Sync)>,
    /// The function that returns whether all runs must end.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl std::fmt::Debug for Bounds<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bounds").finish_non_exhaustive()
    }
}

impl Bounds<'_> {
    /// Returns the CPU time of the calling thread; zero without a clock.
    #[must_use]
    pub(crate) fn now(&self) -> Duration {
        self.clock.map_or(Duration::ZERO, |clock| clock())
    }
}

/// Carries out the plan of an experiment on up to `threads` threads. Returns the rows of the table in the order of the
/// plan, and the number of runs that were not interrupted.
///
/// `watch` is called after each run with the estimated fraction of all work that is done. Once `bounds.stop`
/// returns true, no other run is begun.
pub(crate) fn conduct<E: Experiment>(
    experiment: &E,
    threads: NonZero<usize>,
    bounds: &Bounds<'_>,
    mut watch: impl FnMut(f64),
) -> (Vec<E::Row>, usize) {
    let plan = experiment.plan();
    let whole_s = guess_s(experiment, &plan);
    let (mut table, mut done, mut done_s) = (Vec::new(), 0, 0.0);
    for keys in &plan {
        let outcomes = side_by_side(
            keys,
            experiment.threads(threads),
            |key| match (bounds.stop)() {
                true => None,
                false => experiment.run(key, bounds),
            },
            |i| {
                done_s += experiment.guess_s(&keys[i]);
                watch(done_s / whole_s);
            },
        );
        done += outcomes.iter().flatten().count();
        let rows = keys.iter().zip(outcomes);
        let rows = rows.flat_map(|(key, rows)| rows.unwrap_or_else(|| vec![key.clone()]));
        table.extend(experiment.assessed(rows.collect()));
    }
    (table, done)
}

/// Returns the number of threads that this machine can run at once, or 1 if that is not known.
#[must_use]
pub fn workers() -> NonZero<usize> {
    thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN)
}

/// Returns the name of the processor if the system has one, or else its architecture.
#[must_use]
pub fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = text.lines().filter(|line| line.starts_with("model name"));
    let named = lines.next().and_then(|line| line.split_once(':'));
    let named = named.map_or(std::env::consts::ARCH, |(_, name)| name.trim());
    named.to_owned()
}

/// Does `work` for each job on up to `workers` threads, and returns the results. Jobs are begun in their order.
/// `watch` is called on this thread after each job, with its index.
///
/// Results are handed over one at a time, so a thread starts at most one more job before `watch` has been
/// called for its last. Work that can end early must return that as its result.
///
/// # Panics
///
/// If `work` panics.
pub fn side_by_side<J: Sync, R: Send>(
    jobs: &[J],
    workers: NonZero<usize>,
    work: impl Fn(&J) -> R + Sync,
    mut watch: impl FnMut(usize),
) -> Vec<R> {
    let waiting = Mutex::new(jobs.iter().enumerate());
    let (done, results) = mpsc::sync_channel(0);
    thread::scope(|scope| {
        for _ in 0..workers.get().min(jobs.len()) {
            let (waiting, done, work) = (&waiting, done.clone(), &work);
            scope.spawn(move || {
                while let Some((i, job)) = waiting.lock().ok().and_then(|mut jobs| jobs.next()) {
                    if done.send((i, work(job))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(done);
        let mut found: Vec<(usize, R)> = results.into_iter().inspect(|(i, _)| watch(*i)).collect();
        found.sort_by_key(|(i, _)| *i);
        // A worker's panic ends the scope, so that all jobs have been done.
        found.into_iter().map(|(_, result)| result).collect()
    })
}

/// Returns an estimate of the CPU time of a plan, in seconds.
fn guess_s<E: Experiment>(experiment: &E, plan: &[Vec<E::Row>]) -> f64 {
    let keys = plan.iter().flatten();
    keys.map(|key| experiment.guess_s(key)).sum()
}

/// Returns rows as CSV: a header with the names of the columns, and a line per row.
pub(crate) fn table<R: Serialize>(rows: &[R]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("rows have the same columns");
    }
    let bytes = writer.into_inner().expect("memory takes all");
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Reads rows from CSV, as [`table`] writes them. An error has the line of the first row that is not one.
fn read_table<R: DeserializeOwned>(text: &str) -> Result<Vec<R>, csv::Error> {
    csv::Reader::from_reader(text.as_bytes())
        .deserialize()
        .collect()
}

/// The ways in which a run ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Status {
    /// The run reached its end.
    Ok,
    /// The run reached its end with a right result, but the method lost much of the energy of its motion.
    Dissipated,
    /// The run reached its end, but its result is not right.
    Wrong,
    /// A step was refused, at the start or later.
    Refused,
    /// The energy grew without bound, or a number was infinite, NaN or too large.
    BlownUp,
    /// The equations of an implicit step were not solved.
    Unsolved,
    /// The time of the scene passed before what it waits for.
    Restless,
    /// The run exceeded its limit of visits of edges.
    TooDear,
    /// The run could not be begun, or failed for another reason.
    Failed,
    /// The experiment was interrupted before the run was done.
    #[default]
    Interrupted,
}

impl Status {
    /// Returns the name of the status in tables.
    #[must_use]
    pub(crate) fn name(self) -> String {
        table(&[self]).trim().to_owned()
    }
}

/// The origin of a chart: the program, the commit and the machine that produced it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// The command line that produced the chart.
    pub command: String,
    /// The version of the program.
    pub version: String,
    /// The commit from which the program was built.
    pub commit: String,
    /// The compiler that built the program.
    pub compiler: String,
    /// The processor on which times were measured; `None` if no times were measured.
    pub processor: Option<String>,
}

impl Provenance {
    /// Returns the origin as a line of a figure.
    fn line(&self) -> String {
        let processor = self.processor.as_ref();
        let processor = processor.map_or(String::new(), |name| format!(" · {name}"));
        format!(
            "{} · version {}, commit {} · {}{processor}",
            self.command, self.version, self.commit, self.compiler
        )
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    use super::*;

    #[test]
    fn workers_wait_until_they_were_heard_of() {
        let (begun, mut heard) = (AtomicUsize::new(0), 0);
        let workers = NonZero::<usize>::MIN.saturating_add(2);
        let jobs: Vec<usize> = (0..40).collect();
        let work = |&job: &usize| {
            begun.fetch_add(1, Ordering::SeqCst);
            2 * job
        };
        let doubled = side_by_side(&jobs, workers, work, |_| {
            heard += 1;
            thread::sleep(Duration::from_millis(2));
            let ahead = begun.load(Ordering::SeqCst) - heard;
            assert!(ahead <= workers.get(), "{ahead}");
        });
        let expected: Vec<usize> = jobs.iter().map(|job| 2 * job).collect();
        assert_eq!((doubled, heard), (expected, jobs.len()));
    }
}
