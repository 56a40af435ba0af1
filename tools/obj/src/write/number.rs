//! Numbers to text: the shortest digits that read back as the same bits.

/// Appends a finite number: a whole number without `.0`, decimal between 1e-7 and 1e21, with an
/// exponent outside. Minus zero keeps its sign.
pub(super) fn write_number(out: &mut Vec<u8>, number: f64) {
    let size = number.abs();
    if size < 9e15 && size.fract() == 0.0 {
        if number.is_sign_negative() {
            out.push(b'-');
        }
        return write_integer(out, size as u64);
    }
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format_finite(number);
    match digits.split_once('e') {
        None => out.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes()),
        Some(_) if (1e-7..1e21).contains(&size) => {
            out.extend_from_slice(number.to_string().as_bytes()); // Slower, and rare.
        }
        Some((digits, exponent)) => {
            out.extend_from_slice(digits.as_bytes());
            out.push(b'e');
            out.extend_from_slice(exponent.trim_start_matches('+').as_bytes());
        }
    }
}

/// Appends a whole number.
#[inline]
pub(super) fn write_integer(out: &mut Vec<u8>, number: u64) {
    out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
}
