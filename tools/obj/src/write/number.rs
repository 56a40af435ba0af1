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
    let mut buffer = ryu::Buffer::new();
    let digits = buffer.format_finite(number);
    if digits.contains('e') && (1e-7..1e21).contains(&size) {
        out.extend_from_slice(number.to_string().as_bytes()); // Slower, and rare.
    } else {
        out.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes());
    }
}

/// Appends a whole number.
#[inline]
pub(super) fn write_integer(out: &mut Vec<u8>, mut number: u64) {
    let mut digits = [0; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[start..]);
}
