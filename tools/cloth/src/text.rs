//! Numbers and counts as sentences for people have them.

/// Returns a number of things, such as `1 step` or `2 steps`.
#[must_use]
pub fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// Returns a number with six digits at most.
#[must_use]
pub fn short(x: f64) -> String {
    let rounded = format!("{x:.5e}").parse().unwrap_or(x);
    match rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        true => rounded.to_string(),
        false => format!("{rounded:e}"),
    }
}

/// Returns a number with three digits, or with all of those before the point; 0 below a billionth.
#[must_use]
pub fn three_digits(x: f64) -> String {
    if x.abs() < 1e-9 {
        return "0".to_owned();
    }
    let mut scale = 1.0;
    while (x * scale).abs() < 100.0 {
        scale *= 10.0;
    }
    short((x * scale).round() / scale)
}

/// Returns a positive number with two digits, rounded down: a step that is typed like this stays below its limit.
#[must_use]
pub fn two_digits(x: f64) -> String {
    let mut scale = 1.0;
    while x * scale < 10.0 && scale < 1e15 {
        scale *= 10.0;
    }
    let rounded = (x * scale).floor() / scale;
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people_have_six_digits() {
        for (x, text) in [
            (1.0, "1"),
            (0.0, "0"),
            (4.123_456_789, "4.12346"),
            (0.1 + 0.2, "0.3"),
            (1e-12, "1e-12"),
            (123_456_789.0, "123457000"),
            (1e300, "1e300"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn steps_are_rounded_down() {
        for (x, text) in [
            (0.005_39, "0.0053"),
            (0.0333, "0.033"),
            (0.001_01, "0.001"),
            (1.29e-5, "0.000012"),
        ] {
            assert_eq!(two_digits(x), text);
            assert!(two_digits(x).parse::<f64>().expect("a number") <= x);
        }
    }
}
