//! Decimal digits to numbers, correctly rounded.

/// Appends the decimal digits at the start of `bytes` to `value`, and says how many they are.
/// The value is right as long as it has at most 19 digits, zeros in front aside.
///
/// To convert eight digits at once takes fewer instructions, and no less time: where the next word
/// starts would be known only then, while the processor foresees it from digit to digit.
#[inline]
pub(super) fn digits(bytes: &[u8], value: &mut u64) -> usize {
    let mut rest = bytes;
    while let Some((digit @ b'0'..=b'9', behind)) = rest.split_first() {
        let digit = u64::from(digit - b'0');
        *value = value.wrapping_mul(10).wrapping_add(digit);
        rest = behind;
    }
    bytes.len() - rest.len()
}

/// The powers of ten that are exact.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The same powers, as whole numbers.
const LARGE_POWERS: [i128; POWERS.len()] = {
    let mut powers = [1; POWERS.len()];
    let mut at = 1;
    while at < powers.len() {
        powers[at] = 10 * powers[at - 1];
        at += 1;
    }
    powers
};

/// The number nearest to `mantissa` · 10^`exponent`, where that is found with little effort: for
/// all but the largest, the smallest, and those halfway between two. `None` otherwise.
///
/// Where the mantissa has at most 53 bits and the power of ten is exact (up to 10^22), one
/// multiplication or division of two exact numbers is correctly rounded; that is nearly every
/// number of a file with six or nine digits.
#[inline]
pub(super) fn nearest(mantissa: u64, exponent: i32) -> Option<f64> {
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    if mantissa > 1 << 53 {
        return nearest_quotient(mantissa, exponent);
    }
    let value = mantissa as f64;
    Some(if exponent < 0 {
        value / power
    } else {
        value * power
    })
}

/// The number nearest to a long mantissa, of more than 53 bits, over 10^(−`exponent`).
///
/// The quotient of the rounded mantissa is less than two units off in its last place. By how much,
/// whole numbers of 128 bits tell exactly.
fn nearest_quotient(mantissa: u64, exponent: i32) -> Option<f64> {
    const FRACTION: u64 = (1 << 52) - 1;
    let places = exponent.unsigned_abs();
    let quotient = mantissa as f64 / POWERS[places as usize];
    let bits = quotient.to_bits();
    // quotient = units · 2^−shift, with units of 53 bits.
    let units = (bits & FRACTION) | (FRACTION + 1);
    let shift = 1075_u32.checked_sub((bits >> 52) as u32)?;
    // Above a power of two the units are twice as large as below, and numbers of 2^53 and more
    // would have to be shifted the other way: both are rare.
    if exponent > 0 || bits & FRACTION == 0 {
        return None;
    }
    // Both products are about units · power, which is below 2^53 · 10^22 < 2^127.
    let power = LARGE_POWERS[places as usize];
    let excess = (i128::from(mantissa) << shift) - i128::from(units) * power;
    let (bits, excess) = match () {
        () if 2 * excess > power => (bits + 1, excess - power),
        () if 2 * excess < -power => (bits - 1, excess + power),
        () => (bits, excess),
    };
    (2 * excess.abs() < power).then_some(f64::from_bits(bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sequence of numbers without a pattern.
    fn random(state: &mut u64) -> u64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        state.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    #[track_caller]
    fn check(mantissa: u64, exponent: i32) -> bool {
        let text = format!("{mantissa}e{exponent}");
        let truth: f64 = text.parse().expect("a number");
        let found = nearest(mantissa, exponent);
        if let Some(found) = found {
            assert_eq!(found.to_bits(), truth.to_bits(), "{text}");
        }
        found.is_some()
    }

    #[test]
    fn nearest_numbers_are_those_of_the_library_bit_for_bit() {
        let mut state = 11;
        let (mut all, mut found) = (0, 0);
        for _ in 0..400_000 {
            let mantissa = random(&mut state) >> (random(&mut state) % 64);
            let exponent = (random(&mut state) % 48) as i32 - 24;
            check(mantissa, exponent);
            // What models have: 17 digits below a thousand.
            let mantissa = 10_u64.pow(16) + random(&mut state) % (9 * 10_u64.pow(16));
            all += 1;
            found += usize::from(check(mantissa, -14 - (random(&mut state) % 6) as i32));
        }
        assert!(found > all - all / 1_000, "{found} of {all}");
    }

    #[test]
    fn nearest_numbers_are_right_beside_halves_and_powers_of_two() {
        let mut state = 5;
        for _ in 0..100_000 {
            // A point in the middle between two numbers, cut to 19 digits, and what is beside it.
            let places = random(&mut state) as i32 % 19;
            let places = places.abs();
            let units = (1 << 53) | (random(&mut state) >> 11) | 1;
            let exponent = (random(&mut state) % 12) as u32;
            for middle in [units, 1 << 53, (1 << 53) + 1, (1 << 54) - 1] {
                let scaled = u128::from(middle) * 10_u128.pow(places as u32);
                let mut shift = exponent;
                while scaled >> shift >= 10_u128.pow(19) {
                    shift += 1;
                }
                let mantissa = (scaled >> shift) as u64;
                for near in mantissa.saturating_sub(2)..=mantissa + 2 {
                    check(near, -places);
                }
            }
        }
    }
}
