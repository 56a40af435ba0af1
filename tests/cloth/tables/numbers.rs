//! The numbers of the reference answers by a second way: closed forms, means, bisection and dense matrices.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use tearmesh::Vector;
use tearmesh_cloth::frequency_bound;

use crate::parts::nets::row;
use crate::parts::vibration::largest_frequency;
use crate::parts::{G, near};

/// The period of a pendulum of one metre by the arithmetic–geometric mean.
fn period(angle: f64) -> f64 {
    let (mut a, mut b) = (1.0, (angle / 2.0).cos());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    2.0 * PI / (G.sqrt() * a)
}

/// The root of a growing function between two numbers.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// The sag of a chain of this length whose ends are a metre apart: 2 a sinh(1/2a) is the length, and a
/// (cosh(1/2a) − 1) the sag.
fn catenary(length: f64) -> f64 {
    let a = 1.0 / bisect(1e-3, 20.0, |b| 2.0 / b * (b / 2.0).sinh() - length);
    a * ((0.5 / a).cosh() - 1.0)
}

/// The sag of a net of `n` links between nails a metre apart, and its horizontal force: link by link from
/// the middle, each as long as `length` says for its tension.
fn net(n: usize, length: impl Fn(f64) -> f64) -> [f64; 2] {
    let half = |h: f64| {
        let (mut span, mut sag) = (0.0, 0.0);
        for i in 0..n / 2 {
            let v = 0.01 * G * (i as f64 + 0.5);
            let tension = h.hypot(v);
            span += 2.0 * length(tension) * h / tension;
            sag += length(tension) * v / tension;
        }
        [span, sag]
    };
    let h = bisect(1e-6, 10.0, |h| half(h)[0] - 1.0);
    [half(h)[1], h]
}

#[test]
fn printed_numbers_follow_from_closed_forms() {
    let omega = 4000.0_f64.sqrt();
    let z = 0.01 * omega;
    let mode = |square: f64, j: f64| 2.0 * f64::sqrt(square) * (j * PI / 64.0).sin();
    let free = 2.0 * 50_000.0_f64.sqrt() * (61.0 * PI / 126.0).sin();
    let across = 1000.0 * (1.0 / 32.0 - 0.03) * 32.0 / 0.02;
    let [elastic_sag, elastic_pull] = net(16, |tension| 0.08 + tension / 200.0);
    let r = 100.0 / 190.0;
    for (name, printed, answer) in [
        ("R1 frequency", 63.245_553_203_367_6, omega),
        ("R1 limit", 0.031_622_776_601_683_8, 2.0 / omega),
        (
            "R1 Verlet",
            1.017_464_590_315_29,
            (1.0 - z * z / 2.0).acos() / z,
        ),
        (
            "R1 Euler",
            0.845_154_254_728_517,
            1.0 / (1.0 + z * z).sqrt(),
        ),
        ("R2", 1.107_91, 1.0 + 0.01 * G * 10.0 * 11.0 / 100.0),
        ("R3 slowest", 21.943_731_058_786, mode(50_000.0, 1.0)),
        ("R3 fastest", 446.674_907_138_54, mode(50_000.0, 31.0)),
        ("R3 limit", 4.477_702_091_457_5e-3, 2.0 / free),
        ("R4 slowest", 4.388_746_211_757_1, mode(across, 1.0)),
        ("R4 second", 8.766_919_549_481_3, mode(across, 2.0)),
        ("R5 from 45°", 2.086_255_872_614_367, period(FRAC_PI_4)),
        ("R5 from 90°", 2.367_841_947_576_237, period(FRAC_PI_2)),
        ("R6a long", 0.502_633_261_648_315_2, catenary(1.5)),
        ("R6a short", 0.292_343_797_600_928_8, catenary(1.2)),
        (
            "R6b of 16",
            0.503_908_189_207_115_7,
            net(16, |_| 1.5 / 16.0)[0],
        ),
        (
            "R6b of 64",
            0.502_712_302_986_202_4,
            net(64, |_| 1.5 / 64.0)[0],
        ),
        ("R6c sag", 0.390_722_835_980_581_3, elastic_sag),
        ("R6c pull", 0.441_288_464_343_035_3, elastic_pull),
        ("R7", 1.519, 50.0 * 0.1 * 0.5 - 10.0 * 0.01 * G),
        ("R10 radius", 0.526_315_789_473_684_2, r),
        (
            "R10 energy",
            2.908_587_257_617_729,
            10.0 * r * r + 50.0 * (2.0 * r - 1.0).powi(2),
        ),
    ] {
        assert!((printed / answer - 1.0).abs() < 1e-12, "{name}: {answer}");
    }
}

/// By a dense matrix, and never beyond the bound.
#[test]
fn largest_frequencies_of_chains_are_those_of_closed_forms() {
    let mut held = row(32, 0.02, 1000.0, 0.03, Vector::x() * 0.03);
    held.hold(32);
    let free = row(31, 0.02, 1000.0, 0.03, Vector::x() * 0.03);
    let oscillator = row(1, 0.01, 40.0, 1.0, Vector::x());
    for (mut system, answer, bound) in [
        (oscillator, 63.245_553_203_367_6, 63.245_553_203_367_6),
        (held, 446.674_907_138_54, 447.213_595_499_958),
        (free, 2.0 / 4.477_702_091_457_5e-3, 447.213_595_499_958),
    ] {
        near(largest_frequency(&system) / answer, 1.0, 1e-6);
        near(frequency_bound(&mut system).omega_rad_per_s, bound, 1e-9);
    }
}
