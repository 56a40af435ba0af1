//! Statistics against definitions that are simpler: published numbers, counts, and all draws of a
//! small sample.

use super::*;

/// Published results of splitmix64 for the seed 1234567.
const SPLITMIX64: [u64; 5] = [
    6_457_827_717_110_365_317,
    3_203_168_211_198_807_973,
    9_817_491_932_198_370_423,
    4_593_380_528_125_082_431,
    16_408_922_859_458_223_821,
];

#[test]
fn random_numbers_are_those_of_splitmix64() {
    let mut random = [(); 2].map(|()| Random::new(1_234_567));
    for expected in SPLITMIX64 {
        let expected = (expected / 2048) as f64 / 2_f64.powi(53);
        assert_eq!(random[0].next(), expected);
        assert_eq!(random[1].below(1000), (1000.0 * expected) as usize);
    }
}

/// `count` values within `width` of `middle`, in proportion to it.
fn around(middle: f64, width: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut value = || middle * (1.0 + width * (2.0 * random.next() - 1.0));
    (0..count).map(|_| value()).collect()
}

/// How many of all 5⁵ draws of five ascending values have each of them as their median.
fn medians_of_all_draws() -> [f64; 5] {
    let mut counts = [0.0; 5];
    for draw in 0..5_usize.pow(5) {
        let mut places = [1, 5, 25, 125, 625].map(|power| draw / power % 5);
        places.sort_unstable();
        counts[places[2]] += 1.0;
    }
    counts
}

/// The ratio of medians below which a fraction of all pairs of draws lies.
fn exact_point(first: [f64; 5], second: [f64; 5], fraction: f64) -> f64 {
    let counts = medians_of_all_draws();
    let mut weighted_ratios = Vec::new();
    for (a, a_count) in first.into_iter().zip(counts) {
        for (b, b_count) in second.into_iter().zip(counts) {
            weighted_ratios.push((b / a, a_count * b_count));
        }
    }
    weighted_ratios.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut remaining = fraction * 5_f64.powi(10);
    for (ratio, weight) in weighted_ratios {
        remaining -= weight;
        if remaining < 0.0 {
            return ratio;
        }
    }
    panic!("a fraction below 1");
}

/// The fraction of 2000 draws that is below an exact 2.5 % point has a standard deviation of 0.35 %.
/// The limits are 3.7 of these away.
#[test]
fn the_interval_is_that_of_all_draws() {
    for seed in 0..50 {
        let sample = |seed| {
            let mut values: [f64; 5] = around(3.0, 0.5, 5, seed).try_into().expect("five");
            values.sort_by(f64::total_cmp);
            values
        };
        let (first, second) = (sample(2 * seed), sample(2 * seed + 1));
        let [low, high] = compare(&first, &second).interval;
        let point = |fraction| exact_point(first, second, fraction);
        assert!((point(0.012)..=point(0.038)).contains(&low), "seed {seed}");
        assert!((point(0.962)..=point(0.988)).contains(&high), "seed {seed}");
    }
}

#[test]
fn verdicts_on_known_medians_are_rarely_wrong() {
    let verdicts = |ratio: f64, width: f64| {
        let mut counts = [0; 3];
        for seed in 0..200 {
            let first = around(3.0, width, 8, 2 * seed);
            let second = around(3.0 * ratio, width, 8, 2 * seed + 1);
            counts[compare(&first, &second).verdict as usize] += 1;
        }
        counts
    };
    // Eight values that vary by nine tenths hide a ratio of 1.15.
    for (ratio, width, verdict, least) in [
        (1.0, 0.1, Verdict::Same, 190),
        (2.0, 0.1, Verdict::Differ, 195),
        (1.15, 0.9, Verdict::CannotTell, 150),
    ] {
        let counts = verdicts(ratio, width);
        assert!(counts[verdict as usize] > least, "{counts:?}");
        assert!(ratio > 1.0 || counts[Verdict::Differ as usize] == 0);
    }
}

#[test]
fn zeros_and_infinities_are_the_same_as_themselves_alone() {
    for value in [0.0, f64::INFINITY] {
        let equal = compare(&[value; 4], &[value; 4]);
        assert_eq!((equal.ratio, equal.verdict), (1.0, Verdict::Same));
        let different = compare(&[value; 4], &[2.0; 4]);
        assert_eq!(different.verdict, Verdict::Differ, "{different:?}");
    }
}

#[test]
fn quantiles_are_values_and_straight_lines_between() {
    let sorted = [1.0, 2.0, 4.0, 8.0, 16.0];
    for (i, value) in sorted.into_iter().enumerate() {
        assert_eq!(quantile(&sorted, i as f64 / 4.0), Some(value));
    }
    assert_eq!(quantile(&sorted, 0.625), Some(6.0));
    assert_eq!(quantile(&[], 0.5), None);
    assert_eq!(spread(&[3.0, 1.0, 2.0]), [1.2, 2.0, 2.8]);
    assert_eq!(spread(&[f64::INFINITY; 3]), [f64::INFINITY; 3]);
}
