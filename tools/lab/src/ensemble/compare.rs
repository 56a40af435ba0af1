//! Whether two samples of a number that is chaotic have the same median.

use serde::Serialize;

use crate::random::Random;
use crate::sample::{median, point};

/// The result of a comparison of two ensembles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The medians differ by more than a tenth: the 95 % interval of their ratio lies outside 0.9 … 1.1.
    Differ,
    /// The medians are within a quarter of each other: the 95 % interval of their ratio lies in 0.8 … 1.25.
    Same,
    /// The runs are too few for either conclusion.
    CannotTell,
}

impl Verdict {
    /// Returns the verdict in words, in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Differ => "differ",
            Verdict::Same => "same",
            Verdict::CannotTell => "cannot tell",
        }
    }
}

/// A comparison of the medians of two samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The median of the second sample divided by that of the first; 1 if both are equal, even to 0.
    pub ratio: f64,
    /// The 95 % interval of the ratio by bootstrap: its 2.5 % and 97.5 % points.
    pub interval: [f64; 2],
    /// The verdict that follows from the interval.
    pub verdict: Verdict,
}

/// How often samples are drawn anew.
const DRAWS: usize = 2000;

/// Medians that are surely outside of this differ.
const APART: [f64; 2] = [0.9, 1.1];

/// Medians that are surely within this are the same.
const CLOSE: [f64; 2] = [0.8, 1.25];

/// Compares the medians of two samples. The same samples give the same result.
///
/// # Panics
///
/// If a sample is empty.
#[must_use]
pub fn compare(first: &[f64], second: &[f64]) -> Comparison {
    assert!(
        !first.is_empty() && !second.is_empty(),
        "numbers to compare"
    );
    let mut random = Random(2014);
    let mut drawn = |of: &[f64]| {
        let draw: Vec<f64> = (0..of.len()).map(|_| of[random.below(of.len())]).collect();
        median(draw).expect("a draw is as large as its sample")
    };
    let mut ratios: Vec<f64> = (0..DRAWS)
        .map(|_| ratio(drawn(first), drawn(second)))
        .collect();
    ratios.sort_by(f64::total_cmp);
    let at = |part: f64| ratios[((part * DRAWS as f64) as usize).min(DRAWS - 1)];
    let interval @ [low, high] = [at(0.025), at(0.975)];
    let verdict = if high < APART[0] || low > APART[1] {
        Verdict::Differ
    } else if CLOSE[0] <= low && high <= CLOSE[1] {
        Verdict::Same
    } else {
        Verdict::CannotTell
    };
    let whole = [first, second].map(|of| median(of.to_vec()).expect("numbers to compare"));
    Comparison {
        ratio: ratio(whole[0], whole[1]),
        interval,
        verdict,
    }
}

fn ratio(first: f64, second: f64) -> f64 {
    if first == second { 1.0 } else { second / first }
}

/// Returns the 10 %, 50 % and 90 % points of a sample in any order, interpolated linearly.
///
/// # Panics
///
/// If the sample is empty.
#[must_use]
pub fn spread(numbers: &[f64]) -> [f64; 3] {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.1, 0.5, 0.9].map(|part| point(&sorted, part).expect("a sample of something"))
}
