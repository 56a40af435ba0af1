//! Numbers to text: the shortest digits that read back as the same bits.

/// Appends a finite number: a whole number without `.0`, decimal between 1e-7 and 1e21, with an
/// exponent outside. Minus zero keeps its sign.
pub(super) fn write_number(out: &mut Vec<u8>, number: f64) {
    let size = number.abs();
    // Not `fract`, which is a call of a function without the instructions of newer processors.
    if size < 9e15 && size as i64 as f64 == size {
        if number.is_sign_negative() {
            out.push(b'-');
        }
        return write_integer(out, size as u64);
    }
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format_finite(number);
    if (1e-5..9e15).contains(&size) {
        // As nearly all: there is no exponent to look for.
        return out.extend_from_slice(digits.as_bytes());
    }
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
    if number >= 100_000_000 {
        return out.extend_from_slice(itoa::Buffer::new().format(number).as_bytes());
    }
    // Eight digits at once, the first one lowest; to pairs of digits, to digits.
    let fours = (number / 10_000) | ((number % 10_000) << 32);
    let hundreds = ((fours * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let pairs = hundreds | ((fours - 100 * hundreds) << 16);
    let tens = ((pairs * 103) >> 10) & 0x000f_000f_000f_000f;
    let digits = tens | ((pairs - 10 * tens) << 8);
    // The last one is written even if it is 0.
    let zeros = (digits | (1 << 56)).trailing_zeros() / 8;
    let text = (digits | u64::from_ne_bytes([b'0'; 8])) >> (8 * zeros);
    // All eight bytes are copied, which is a single instruction, and those in excess dropped.
    let end = out.len() + 8 - zeros as usize;
    out.extend_from_slice(&text.to_le_bytes());
    out.truncate(end);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(number: u64) -> String {
        let mut out = b"f".to_vec();
        write_integer(&mut out, number);
        String::from_utf8(out).expect("digits")
    }

    #[test]
    fn whole_numbers_are_written_as_the_library_writes_them() {
        let powers = (0..18).map(|power| 10_u64.pow(power));
        let beside = powers.flat_map(|power| [power - 1, power, power + 1, 7 * power]);
        let all = (0..100_000).chain((0..100_000_000).step_by(9_973));
        for number in all.chain(beside) {
            assert_eq!(written(number), format!("f{number}"));
        }
    }
}
