//! Interleaved rounds, medians, and the table of a contest.

use std::fmt::Write as _;
use std::time::Duration;

use crate::options::Options;

/// Somebody who does a job; `None` if it is none of theirs.
pub(crate) struct Contestant<'c, J> {
    pub(crate) name: &'static str,
    /// What the result is worth knowing about, in a few words.
    pub(crate) note: &'static str,
    /// Does the job, and says how long it took: to drop the result is not part of it.
    pub(crate) run: &'c dyn Fn(&J) -> Option<Duration>,
}

/// How much time the CPU spends on a job, which other programs on the machine disturb less than the
/// wall clock. The result is dropped afterwards.
pub(crate) fn timed_on_cpu<T>(job: impl FnOnce() -> T) -> (T, Duration) {
    let start = cpu_time::ProcessTime::now();
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
    let results = rounds(job, contestants, options);
    let reference = |name: &str| {
        let (_, times) = results.iter().find(|(c, _)| c.name == name)?;
        median_seconds(times)
    };

    let mut table = format!("  {:14}{:>8}{:>8}", "", "MB/s", "ms");
    for name in references {
        write!(table, "{:>10}", format!("x {name}")).expect("a string takes all");
    }
    table.push('\n');
    for (contestant, times) in &results {
        let Some(seconds) = median_seconds(times) else {
            continue;
        };
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

/// Lets all contestants that are picked do a job, each once a round. Their times are sorted.
pub(crate) fn rounds<'c, 'j, J>(
    job: &J,
    contestants: &'c [Contestant<'j, J>],
    options: &Options,
) -> Vec<(&'c Contestant<'j, J>, Vec<Duration>)> {
    let names: Vec<&str> = contestants.iter().map(|c| c.name).collect();
    let picked = contestants
        .iter()
        .filter(|contestant| options.picks(contestant.name, &names));
    let mut results: Vec<_> = picked.map(|contestant| (contestant, Vec::new())).collect();
    for _ in 0..options.rounds {
        for (contestant, times) in &mut results {
            times.extend((contestant.run)(job));
        }
    }
    for (_, times) in &mut results {
        times.sort_unstable();
    }
    results
}

/// The median of sorted times.
pub(crate) fn median_seconds(times: &[Duration]) -> Option<f64> {
    Some(times.get(times.len() / 2)?.as_secs_f64())
}

/// The median of numbers in any order.
pub(crate) fn median(numbers: &[f64]) -> Option<f64> {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}
