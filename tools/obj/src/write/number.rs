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

#[cfg(test)]
mod tests {
    use super::*;

    fn text(number: f64) -> String {
        let mut out = Vec::new();
        write_number(&mut out, number);
        String::from_utf8(out).expect("digits are ASCII")
    }

    #[test]
    fn numbers_read_back_as_the_same_bits() {
        let mut bits = 1_u64;
        for _ in 0..200_000 {
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            // Random bits, and numbers of a size that models have.
            let small = ((bits >> 40) as f64 - 8e6) / 1e6 * [1.0, 1e-6, 1e9][(bits % 3) as usize];
            for number in [f64::from_bits(bits), small] {
                if number.is_finite() {
                    let back: f64 = text(number).parse().expect("a number");
                    assert_eq!(back.to_bits(), number.to_bits(), "{number:e}");
                }
            }
        }
    }
}
