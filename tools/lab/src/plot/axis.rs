//! Axes: which numbers they hold, where those stand, and which are written along them.

use std::ops::Range;

use super::number::short;

/// An axis of a panel.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// The label, with its unit.
    pub label: String,
    /// How numbers are spaced.
    pub scale: Scale,
    /// The numbers at the ends; `None` to fit what is drawn.
    pub range: Option<Range<f64>>,
    /// The names that stand in place of numbers: the first in the middle between 0 and 1, and so on.
    pub names: Vec<String>,
}

/// How numbers are spaced along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences are equally long.
    #[default]
    Linear,
    /// Equal ratios are equally long. Numbers that are not positive have no place.
    Log,
}

/// How far an axis that is fitted goes beyond what is drawn, as a fraction of its length.
const BEYOND: f64 = 0.05;

/// The most numbers along an axis.
const TICKS: usize = 7;

impl Axis {
    /// Returns a linear axis that is fitted to what is drawn.
    #[must_use]
    pub fn linear(label: &str) -> Axis {
        Axis {
            label: label.to_owned(),
            ..Axis::default()
        }
    }

    /// Returns a logarithmic axis that is fitted to what is drawn.
    #[must_use]
    pub fn log(label: &str) -> Axis {
        Axis {
            scale: Scale::Log,
            ..Axis::linear(label)
        }
    }

    /// Returns an axis with names in place of numbers.
    #[must_use]
    pub fn named(names: Vec<String>) -> Axis {
        Axis {
            range: Some(0.0..names.len() as f64),
            names,
            ..Axis::default()
        }
    }

    /// Returns the axis with these ends.
    #[must_use]
    pub fn from_to(self, from: f64, to: f64) -> Axis {
        Axis {
            range: Some(from..to),
            ..self
        }
    }

    /// The numbers at the ends of the axis, given those that are drawn.
    pub(super) fn fitted(&self, drawn: impl Iterator<Item = f64>) -> Range<f64> {
        if let Some(range) = &self.range {
            return range.clone();
        }
        let ends = drawn
            .map(|number| self.scaled(number))
            .filter(|number| number.is_finite())
            .fold(None, |ends: Option<[f64; 2]>, x| match ends {
                None => Some([x, x]),
                Some([least, most]) => Some([x.min(least), x.max(most)]),
            });
        let [least, most] = ends.unwrap_or([0.0, 1.0]);
        let beyond = match most - least {
            0.0 => 0.5 * least.abs().max(0.3),
            length => BEYOND * length,
        };
        let back = |x: f64| match self.scale {
            Scale::Linear => x,
            Scale::Log => x.exp(),
        };
        back(least - beyond)..back(most + beyond)
    }

    /// The place of a number along the axis, from 0 at its beginning to 1 at its end.
    pub(super) fn place(&self, number: f64, range: &Range<f64>) -> f64 {
        let [at, from, to] = [number, range.start, range.end].map(|x| self.scaled(x));
        (at - from) / (to - from)
    }

    fn scaled(&self, number: f64) -> f64 {
        match self.scale {
            Scale::Linear => number,
            Scale::Log => number.ln(),
        }
    }

    /// The numbers that are written along the axis, with their text.
    pub(super) fn ticks(&self, range: &Range<f64>) -> Vec<(f64, String)> {
        if !self.names.is_empty() {
            let named = self.names.iter().enumerate();
            return named
                .map(|(i, name)| (i as f64 + 0.5, name.clone()))
                .collect();
        }
        let numbers = match self.scale {
            Scale::Linear => evenly(range),
            Scale::Log => logarithmically(range),
        };
        let numbers: Vec<f64> = numbers
            .into_iter()
            .filter(|number| range.contains(number))
            .collect();
        // As many digits as tell neighbours apart.
        let texts = |digits: u32| -> Vec<String> {
            let texts = numbers.iter().map(|&number| short(number, digits));
            texts.collect()
        };
        let is_distinct = |texts: &Vec<String>| texts.windows(2).all(|pair| pair[0] != pair[1]);
        let texts = (3..9).map(texts).find(is_distinct).unwrap_or_default();
        numbers.into_iter().zip(texts).collect()
    }
}

/// Multiples of 1, 2 or 5 times a power of ten.
fn evenly(range: &Range<f64>) -> Vec<f64> {
    let length = range.end - range.start;
    let power = 10.0_f64.powi((length / TICKS as f64).log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    let fits = |step: &&f64| length / **step <= TICKS as f64;
    let step = steps.iter().find(fits).copied().unwrap_or(length);
    let first = (range.start / step).ceil() as i64;
    let last = (range.end / step).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Powers of ten; with few of them also twice and five times those, with many only some.
fn logarithmically(range: &Range<f64>) -> Vec<f64> {
    let [first, last] = [range.start, range.end].map(|end| end.log10().floor() as i32);
    let multiples = |digits: &[f64]| -> Vec<f64> {
        let powers = (first..=last).map(|power| 10.0_f64.powi(power));
        let all = powers.flat_map(|power| digits.iter().map(move |digit| digit * power));
        all.filter(|number| range.contains(number)).collect()
    };
    let tens = multiples(&[1.0]);
    match tens.len() {
        0..=1 => multiples(&[1.0, 2.0, 3.0, 5.0, 7.0]),
        2..=3 => multiples(&[1.0, 3.0]),
        count if count <= TICKS => tens,
        count => tens.into_iter().step_by(count.div_ceil(TICKS)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let of = |axis: &Axis, range: Range<f64>| -> Vec<String> {
            axis.ticks(&range)
                .into_iter()
                .map(|(_, text)| text)
                .collect()
        };
        let (linear, log) = (Axis::linear(""), Axis::log(""));
        assert_eq!(of(&linear, 0.0..0.9), ["0", "0.2", "0.4", "0.6", "0.8"]);
        assert_eq!(of(&linear, -3.0..12.0), ["0", "5", "10"]);
        assert_eq!(of(&log, 0.9e-2..1.2), ["0.01", "0.03", "0.1", "0.3", "1"]);
        assert_eq!(of(&log, 2.5..6.0), ["3", "5"]);
        assert_eq!(of(&log, 1e-9..1.0).len(), 5);
    }
}
