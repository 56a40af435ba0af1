//! What charts have in common: areas, numbers along axes, and words.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

/// A part of a drawing.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Whether it was drawn.
pub(crate) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Makes a drawing of this size. `None` where the drawing library fails, which a drawing in memory has no
/// reason for.
pub(crate) fn drawn(size: (u32, u32), draw: impl FnOnce(&Area<'_>) -> Drawn) -> Option<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
        root.fill(&WHITE).ok()?;
        draw(&root).ok()?;
        root.present().ok()?;
    }
    Some(text)
}

/// 1, 2 and 5 times the powers of ten, as far as they are in a range above zero.
pub(crate) fn round_numbers(range: &Range<f64>) -> Vec<f64> {
    of_decades(range, &[1.0, 2.0, 5.0])
}

/// So many times the powers of ten, as far as they are in a range above zero.
pub(crate) fn of_decades(range: &Range<f64>, digits: &[f64]) -> Vec<f64> {
    let tens = |end: f64| end.log10().floor() as i32;
    let powers = tens(range.start)..=tens(range.end);
    let all = powers.flat_map(|power| digits.iter().map(move |digit| digit * 10_f64.powi(power)));
    all.filter(|number| range.contains(number)).collect()
}

/// Lines of at most so many letters.
pub(crate) fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(last) if last.chars().count() + word.chars().count() < most => {
                if !last.is_empty() {
                    last.push(' ');
                }
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// From a bit below the least to a bit above the most.
pub(crate) fn spread(numbers: impl Iterator<Item = f64>, beyond: f64) -> Range<f64> {
    let ends = numbers.fold((f64::INFINITY, 0.0_f64), |(least, most), x| {
        (least.min(x), most.max(x))
    });
    ends.0 / beyond..ends.1 * beyond
}

/// A number as it stands along an axis: plain between this and a thousand, and else as a power of ten.
pub(crate) fn axis_number(x: f64, plain_from: f64) -> String {
    if (plain_from..1000.0).contains(&x) {
        format!("{}", (x * 1e6).round() / 1e6)
    } else {
        format!("{x:.0e}")
    }
}
