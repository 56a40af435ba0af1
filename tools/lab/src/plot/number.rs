//! Numbers as text.

/// Returns a number with so many significant digits, as short as it can be written: in full from 0.001 to
/// 99999, and else as a power of ten.
#[must_use]
pub fn short(number: f64, digits: u32) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    let decade = number.abs().log10().floor() as i32;
    if !(-3..5).contains(&decade) {
        let decimals = digits.saturating_sub(1) as usize;
        let text = format!("{number:.decimals$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa = match mantissa.contains('.') {
            true => mantissa.trim_end_matches('0').trim_end_matches('.'),
            false => mantissa,
        };
        return format!("{mantissa}e{exponent}");
    }
    let decimals = (digits as i32 - 1 - decade).max(0);
    let scale = 10.0_f64.powi(decimals);
    format!("{}", (number * scale).round() / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

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
