//! Axes: which numbers they hold, where those stand, and which are written along them; and numbers as text.

use std::ops::Range;

/// An axis of a panel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Axis {
    /// The label, with its unit.
    pub(crate) label: String,
    /// Whether equal ratios are equally long, and not equal differences. Then numbers that are not positive have
    /// no place.
    pub(crate) is_log: bool,
    /// The names that stand in place of numbers: the first in the middle between 0 and 1, and so on.
    pub(crate) names: Vec<String>,
}

/// How far an axis that is fitted goes beyond what is drawn, as a fraction of its length.
const BEYOND: f64 = 0.05;

/// The most numbers along an axis.
const TICKS: usize = 7;

impl Axis {
    /// Returns a linear axis that is fitted to what is drawn.
    #[must_use]
    pub(crate) fn linear(label: &str) -> Axis {
        Axis {
            label: label.to_owned(),
            ..Axis::default()
        }
    }

    /// Returns a logarithmic axis that is fitted to what is drawn.
    #[must_use]
    pub(crate) fn log(label: &str) -> Axis {
        Axis {
            is_log: true,
            ..Axis::linear(label)
        }
    }

    /// Returns an axis with names in place of numbers.
    #[must_use]
    pub(crate) fn named(names: Vec<String>) -> Axis {
        Axis {
            names,
            ..Axis::default()
        }
    }

    /// Places the axis, given what is drawn, with its ends at these pixels.
    pub(super) fn placed(&self, drawn: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Placed<'_> {
        Placed {
            axis: self,
            numbers: match self.names.len() {
                0 => self.fitted(drawn),
                count => 0.0..count as f64,
            },
            pixels,
        }
    }

    /// The ends of an axis that holds these numbers.
    fn fitted(&self, drawn: impl Iterator<Item = f64>) -> Range<f64> {
        let drawn = drawn.map(|number| self.scaled(number));
        let drawn: Vec<f64> = drawn.filter(|number| number.is_finite()).collect();
        let least = drawn.iter().copied().reduce(f64::min).unwrap_or(0.0);
        let most = drawn.iter().copied().reduce(f64::max).unwrap_or(1.0);
        let beyond = match most - least {
            0.0 => 0.5 * least.abs().max(0.3),
            length => BEYOND * length,
        };
        let back = |x: f64| if self.is_log { x.exp() } else { x };
        back(least - beyond)..back(most + beyond)
    }

    fn scaled(&self, number: f64) -> f64 {
        if self.is_log { number.ln() } else { number }
    }
}

/// An axis with the numbers at its ends, and their places in pixels.
pub(super) struct Placed<'a> {
    axis: &'a Axis,
    numbers: Range<f64>,
    pub(super) pixels: [f64; 2],
}

impl Placed<'_> {
    /// The place of a number in pixels.
    pub(super) fn at(&self, number: f64) -> f64 {
        let Range { start, end } = self.numbers;
        let [number, from, to] = [number, start, end].map(|x| self.axis.scaled(x));
        self.pixels[0] + (number - from) / (to - from) * (self.pixels[1] - self.pixels[0])
    }

    /// The numbers that are written along the axis: their places in pixels, and their text.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        if !self.axis.names.is_empty() {
            let names = self.axis.names.iter().zip(0..);
            let names = names.map(|(name, i)| (self.at(f64::from(i) + 0.5), name.clone()));
            return names.collect();
        }
        let mut numbers = match self.axis.is_log {
            true => logarithmically(&self.numbers),
            false => evenly(&self.numbers),
        };
        numbers.retain(|number| self.numbers.contains(number));
        // Enough digits for round numbers, and too few for their rounding errors.
        let ticks = numbers.iter().map(|&x| (self.at(x), short(x, 9)));
        ticks.collect()
    }
}

/// Multiples of 1, 2 or 5 times a power of ten.
fn evenly(range: &Range<f64>) -> Vec<f64> {
    let length = range.end - range.start;
    let power = 10.0_f64.powi((length / TICKS as f64).log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    let fits = |step: &f64| length / step <= TICKS as f64;
    let step = steps.into_iter().find(fits).unwrap_or(length);
    let first = (range.start / step).ceil() as i64;
    let last = (range.end / step).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Powers of ten with multiples of those, as many as there is room for; evenly where that leaves fewer than three.
fn logarithmically(range: &Range<f64>) -> Vec<f64> {
    let [first, last] = [range.start, range.end].map(|end| end.log10().floor() as i32);
    let multiples = |digits: &[f64]| -> Vec<f64> {
        let powers = (first..=last).map(|power| 10.0_f64.powi(power));
        let all = powers.flat_map(|power| digits.iter().map(move |digit| digit * power));
        all.filter(|number| range.contains(number)).collect()
    };
    let digits = [
        &[1.0, 2.0, 3.0, 5.0, 7.0][..],
        &[1.0, 2.0, 5.0],
        &[1.0, 3.0],
        &[1.0],
    ];
    let mut sets = digits.into_iter().map(multiples);
    match sets.find(|ticks| ticks.len() <= TICKS) {
        Some(ticks) if ticks.len() < 3 => evenly(range),
        Some(ticks) => ticks,
        None => {
            let step = 1 + (last - first) as usize / TICKS;
            multiples(&[1.0]).into_iter().step_by(step).collect()
        }
    }
}

/// Returns a number with so many significant digits, as short as it can be written: in full from 0.001 to
/// 99999, and else as a power of ten.
#[must_use]
pub(crate) fn short(number: f64, digits: u32) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    let decade = number.abs().log10().floor() as i32;
    if !(-3..5).contains(&decade) {
        let decimals = digits.saturating_sub(1) as usize;
        let rounded: f64 = format!("{number:.decimals$e}").parse().unwrap_or(number);
        return format!("{rounded:e}");
    }
    let decimals = (digits as i32 - 1 - decade).max(0);
    let scale = 10.0_f64.powi(decimals);
    format!("{}", (number * scale).round() / scale)
}

/// Returns a fraction in per cent, with two significant digits.
#[must_use]
pub(crate) fn percent(fraction: f64) -> String {
    format!("{} %", short(100.0 * fraction, 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let of = |axis: &Axis, range: Range<f64>| -> Vec<String> {
            let placed = Placed {
                axis,
                numbers: range,
                pixels: [0.0, 1.0],
            };
            placed.ticks().into_iter().map(|(_, text)| text).collect()
        };
        let (linear, log) = (Axis::linear(""), Axis::log(""));
        assert_eq!(of(&linear, 0.0..0.9), ["0", "0.2", "0.4", "0.6", "0.8"]);
        assert_eq!(of(&linear, -3.0..12.0), ["0", "5", "10"]);
        let decades = ["0.003", "0.01", "0.03", "0.1", "0.3", "1", "3"];
        assert_eq!(of(&log, 2e-3..4.0), decades);
        assert_eq!(of(&log, 4e-2..1.2), ["0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(of(&log, 6.0..44.0), ["7", "10", "20", "30"]);
        assert_eq!(of(&log, 2.5..4.2), ["2.5", "3", "3.5", "4"]);
        assert_eq!(of(&log, 1.55..1.95), ["1.6", "1.7", "1.8", "1.9"]);
        assert_eq!(of(&log, 1e-9..1.1).len(), 5);
    }

    #[test]
    fn short_numbers_have_the_digits_that_are_asked_for() {
        for (number, digits, text) in [
            (0.0, 3, "0"),
            (0.123_456, 3, "0.123"),
            (1234.5, 2, "1235"),
            (99_999.0, 2, "99999"),
            (1.0e-5, 3, "1e-5"),
            (-2.345e-6, 2, "-2.3e-6"),
            (1.0e6, 1, "1e6"),
            (f64::INFINITY, 3, "inf"),
        ] {
            assert_eq!(short(number, digits), text);
        }
    }
}
