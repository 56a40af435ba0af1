//! Comparisons and quantiles of samples, and a random generator.
//!
//! Results of chaotic runs cannot be compared one by one, but their distributions can. [`compare`]
//! decides whether the medians of two samples differ, by bootstrap (Efron 1979): it draws both
//! samples many times with replacement, and takes the 95 % interval of the ratio of their medians.
//! It needs no model of the distribution, and values may be infinite. With n values per sample it
//! costs O(n log n) for each of 2000 draws.
//!
//! Random numbers come from [`Random`] with fixed seeds, so every result is the same on every
//! machine.

/// A comparison of the medians of two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The median of the second sample divided by that of the first; 1 if both are equal, even to
    /// 0.
    pub ratio: f64,
    /// The 95 % interval of the ratio by bootstrap: its 2.5 % and 97.5 % points.
    pub interval: [f64; 2],
    /// The verdict that follows from the interval.
    pub verdict: Verdict,
}

/// The conclusion of a comparison of two samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The medians differ by more than a tenth: the 95 % interval of their ratio lies outside
    /// 0.9 … 1.1.
    Differ,
    /// The medians are within a quarter of each other: the 95 % interval of their ratio lies in
    /// 0.8 … 1.25.
    Same,
    /// The samples are too small for either conclusion.
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

/// The number of times that each sample is drawn again.
const DRAWS: usize = 2000;

/// Medians differ if the interval of their ratio lies outside this range.
const ABOUT_ONE: [f64; 2] = [0.9, 1.1];

/// Medians are the same if the interval of their ratio lies within this range.
const CLOSE_TO_ONE: [f64; 2] = [0.8, 1.25];

/// Compares the medians of two samples. The same samples give the same result.
///
/// ```
/// use tearmesh_lab::statistics::{Verdict, compare};
///
/// let whole_step_m = [1.01, 0.97, 1.02, 0.99, 1.0];
/// let half_step_m = [2.03, 1.98, 2.0, 1.99, 2.02];
/// let comparison = compare(&whole_step_m, &half_step_m);
/// assert_eq!((comparison.ratio, comparison.verdict), (2.0, Verdict::Differ));
/// ```
///
/// # Panics
///
/// If a sample is empty.
#[must_use]
pub fn compare(first: &[f64], second: &[f64]) -> Comparison {
    assert!(!first.is_empty(), "the first sample has values");
    assert!(!second.is_empty(), "the second sample has values");
    let ratio = |first: f64, second: f64| if first == second { 1.0 } else { second / first };
    let mut random = Random::new(2014);
    let mut redrawn_median = |sample: &[f64]| {
        let draw = (0..sample.len()).map(|_| sample[random.below(sample.len())]);
        median(draw.collect()).expect("a draw is as large as its sample")
    };
    let draws = (0..DRAWS).map(|_| ratio(redrawn_median(first), redrawn_median(second)));
    let mut ratios: Vec<f64> = draws.collect();
    ratios.sort_by(f64::total_cmp);
    let at = |fraction: f64| ratios[(fraction * DRAWS as f64) as usize];
    let interval @ [low, high] = [at(0.025), at(0.975)];
    let verdict = if high < ABOUT_ONE[0] || low > ABOUT_ONE[1] {
        Verdict::Differ
    } else if CLOSE_TO_ONE[0] <= low && high <= CLOSE_TO_ONE[1] {
        Verdict::Same
    } else {
        Verdict::CannotTell
    };
    let medians = [first, second].map(|sample| median(sample.to_vec()).expect("it has values"));
    Comparison {
        ratio: ratio(medians[0], medians[1]),
        interval,
        verdict,
    }
}

/// Returns the 10 %, 50 % and 90 % quantiles of a sample in any order, interpolated linearly.
///
/// # Panics
///
/// If the sample is empty.
#[must_use]
pub fn spread(sample: &[f64]) -> [f64; 3] {
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.1, 0.5, 0.9].map(|fraction| quantile(&sorted, fraction).expect("the sample has values"))
}

/// Returns the middle value of a sample in any order, or the mean of the two in the middle; `None`
/// if the sample is empty.
#[must_use]
pub fn median(mut sample: Vec<f64>) -> Option<f64> {
    sample.sort_by(f64::total_cmp);
    quantile(&sample, 0.5)
}

/// The value at `fraction` of the way from the first to the last value of a sorted sample,
/// interpolated linearly between neighbours; `None` if the sample is empty.
fn quantile(sorted: &[f64], fraction: f64) -> Option<f64> {
    let place = fraction * sorted.len().checked_sub(1)? as f64;
    let below = sorted[place.floor() as usize];
    let above = sorted[place.ceil() as usize];
    if below == above {
        return Some(below); // The difference of two infinities is not a number.
    }
    Some(below + (above - below) * place.fract())
}

/// A small random generator (splitmix64, Steele et al. 2014). A seed gives the same numbers on
/// every machine. It is not for secrets.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates a generator. Different seeds, even successive ones, give unrelated numbers.
    #[must_use]
    pub fn new(seed: u64) -> Random {
        Random { state: seed }
    }

    /// Returns a number from 0 up to, but not including, 1.
    #[expect(
        clippy::should_implement_trait,
        reason = "an iterator may end, and a generator does not"
    )]
    pub fn next(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a whole number from 0 up to, but not including, `count`.
    ///
    /// # Panics
    ///
    /// If `count` is 0.
    pub fn below(&mut self, count: usize) -> usize {
        assert!(count > 0, "a number below 0 does not exist");
        // The product may be rounded up to `count`.
        ((self.next() * count as f64) as usize).min(count - 1)
    }
}

#[cfg(test)]
mod tests;
