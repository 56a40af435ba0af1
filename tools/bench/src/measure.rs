//! Interleaved rounds, medians, and the table of a contest.

use tearmesh_lab::statistics::median;

use crate::options::Options;
use crate::table::{line, table};

/// Somebody who does a job; `None` if it is none of theirs.
pub(crate) struct Contestant<'c, J> {
    pub(crate) name: &'static str,
    /// What the result is worth knowing about, in a few words.
    pub(crate) note: &'static str,
    /// Does the job, and says how many seconds it took: to drop the result is not part of it.
    pub(crate) run: &'c dyn Fn(&J) -> Option<f64>,
}

/// How many seconds the CPU spends on a job, which other programs on the machine disturb less than the
/// wall clock. The result is dropped afterwards.
pub(crate) fn timed_on_cpu<T>(job: impl FnOnce() -> T) -> (T, f64) {
    let start = cpu_time::ProcessTime::now();
    let result = job();
    let time = start.elapsed();
    (result, time.as_secs_f64())
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
    let medians = results.into_iter();
    let medians = medians.filter_map(|(contestant, times)| Some((contestant, median(times)?)));
    let medians: Vec<(&Contestant<'_, J>, f64)> = medians.collect();
    let mut lines = vec![line(["", "MB/s", "ms"])];
    lines[0].extend(references.iter().map(|name| format!("x {name}")));
    lines[0].push(String::new());
    for (contestant, seconds) in &medians {
        let rate = bytes as f64 / 1e6 / seconds;
        let [rate, ms] = [rate, seconds * 1e3].map(|number| format!("{number:.0}"));
        let mut cells = line([contestant.name, &rate, &ms]);
        cells.extend(references.iter().map(|name| {
            let reference = medians.iter().find(|(other, _)| other.name == *name);
            reference.map_or(String::new(), |(_, time)| format!("{:.2}", time / seconds))
        }));
        cells.push(contestant.note.to_owned());
        lines.push(cells);
    }
    table(&lines)
}

/// Lets all contestants that are picked do a job, each once a round.
pub(crate) fn rounds<'c, 'j, J>(
    job: &J,
    contestants: &'c [Contestant<'j, J>],
    options: &Options,
) -> Vec<(&'c Contestant<'j, J>, Vec<f64>)> {
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
    results
}

/// The median of a number of each round.
pub(crate) fn median_of<T>(rounds: &[T], number: impl Fn(&T) -> f64) -> f64 {
    let numbers = rounds.iter().map(number);
    median(numbers.collect()).expect("there is a round")
}
