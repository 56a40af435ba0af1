//! Whether two samples of a number that is chaotic have the same median.

use serde::Serialize;

use crate::random::Random;
use crate::sample::{median, point};

/// What can be said of two ensembles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The medians are surely a tenth apart: the interval has no point in common with 0.9 … 1.1.
    Differ,
    /// They are surely within a quarter: the interval lies within 0.8 … 1.25.
    Same,
    /// Neither, with so many runs.
    CannotTell,
}

impl Verdict {
    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Differ => "differ",
            Verdict::Same => "same",
            Verdict::CannotTell => "cannot tell",
        }
    }
}

/// Two samples, compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The median of the second over that of the first; 1 where they are equal, whatever they are.
    pub ratio: f64,
    /// The 2.5 and 97.5 per cent points of that ratio, by bootstrap.
    pub interval: [f64; 2],
    /// What follows.
    pub verdict: Verdict,
}

/// How often samples are drawn anew.
const DRAWS: usize = 2000;

/// Medians that are surely outside of this differ.
const APART: [f64; 2] = [0.9, 1.1];

/// Medians that are surely within this are the same.
const CLOSE: [f64; 2] = [0.8, 1.25];

/// Compares two samples that are not empty.
///
/// # Panics
///
/// If one is empty.
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

/// The 10 %, 50 % and 90 % points of some numbers, between neighbours in proportion.
///
/// # Panics
///
/// If there is none.
#[must_use]
pub fn spread(numbers: &[f64]) -> [f64; 3] {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.1, 0.5, 0.9].map(|part| point(&sorted, part).expect("a sample of something"))
}
