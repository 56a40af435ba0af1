//! Interleaved rounds, medians, and the table of a contest.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use crate::options::Options;

/// Somebody who does a job; `None` if it is none of theirs.
pub(crate) struct Contestant<'c, J> {
    pub(crate) name: &'static str,
    /// What the result is worth knowing about, in a few words.
    pub(crate) note: &'static str,
    /// Does the job, and says how long it took: to drop the result is not part of it.
    pub(crate) run: &'c dyn Fn(&J) -> Option<Duration>,
}

/// How long a job takes. Its result is dropped afterwards.
pub(crate) fn timed<T>(job: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let result = job();
    let time = start.elapsed();
    (result, time)
}

/// Lets all contestants do a job of some bytes, each once a round, and tabulates the medians
/// beside those of the `references`.
pub(crate) fn contest<J>(
    job: &J,
    bytes: usize,
    contestants: &[Contestant<'_, J>],
    references: &[&str],
    options: &Options,
) -> String {
    let names: Vec<&str> = contestants.iter().map(|c| c.name).collect();
    let contestants: Vec<_> = contestants
        .iter()
        .filter(|contestant| options.picks(contestant.name, &names))
        .collect();
    let mut times = vec![Vec::new(); contestants.len()];
    for _ in 0..options.rounds {
        for (contestant, times) in contestants.iter().zip(&mut times) {
            times.extend((contestant.run)(job));
        }
    }
    let medians: Vec<Option<f64>> = times.into_iter().map(median_seconds).collect();
    let reference = |name: &str| {
        let at = contestants.iter().position(|c| c.name == name)?;
        medians[at]
    };

    let mut table = format!("  {:14}{:>8}{:>8}", "", "MB/s", "ms");
    for name in references {
        write!(table, "{:>10}", format!("x {name}")).expect("a string takes all");
    }
    table.push('\n');
    for (contestant, median) in contestants.iter().zip(&medians) {
        let Some(seconds) = median else { continue };
        let rate = bytes as f64 / 1e6 / seconds;
        let row = format!("  {:14}{rate:8.0}{:8.0}", contestant.name, seconds * 1e3);
        table.push_str(&row);
        for name in references {
            let ratio = reference(name).map(|time| format!("{:.2}", time / seconds));
            write!(table, "{:>10}", ratio.unwrap_or_default()).expect("a string takes all");
        }
        table.push_str(&format!("  {}", contestant.note));
        table.truncate(table.trim_end().len());
        table.push('\n');
    }
    table
}

fn median_seconds(mut times: Vec<Duration>) -> Option<f64> {
    times.sort_unstable();
    Some(times.get(times.len() / 2)?.as_secs_f64())
}
