//! Decimal digits to numbers, correctly rounded.

/// Appends the decimal digits at the start of `bytes` to `value`, and says how many they are.
/// The value is right as long as it has at most 19 digits, zeros in front aside.
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

/// Converts up to eight digits together, expecting as many as there were the last time.
///
/// That takes fewer instructions. By itself it would take no less time: where the next
/// word starts would be known only when they are counted, while the processor foresees it from
/// digit to digit. What is expected is known before, and is only confirmed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected(usize);

impl Default for Expected {
    fn default() -> Expected {
        Expected(1)
    }
}

impl Expected {
    /// The value of the digits at the start of a word, and how many they are.
    #[inline(always)]
    pub(super) fn digits(&mut self, word: Word) -> (u64, usize) {
        let Expected(count) = *self;
        if word.count() == count {
            (word.value(count), count)
        } else {
            self.learn(word)
        }
    }

    /// Not inlined: the compiler would see that both counts are those of the word.
    #[cold]
    #[inline(never)]
    fn learn(&mut self, word: Word) -> (u64, usize) {
        match word.count() {
            0 => (0, 0),
            count => {
                self.0 = count;
                (word.value(count), count)
            }
        }
    }
}

/// How many digits the last words had, which those of the next words are likely to have.
#[derive(Debug, Default)]
pub(super) struct Widths {
    /// Behind the decimal point.
    pub(super) places: Expected,
    pub(super) index: [Expected; 3],
}

/// Eight bytes of a text, the first one lowest, each without the bits of the digit 0.
#[derive(Clone, Copy)]
pub(super) struct Word(u64);

impl Word {
    const ONES: u64 = u64::from_ne_bytes([1; 8]);

    #[inline]
    pub(super) fn new(bytes: [u8; 8]) -> Word {
        Word(u64::from_le_bytes(bytes) ^ (Word::ONES * u64::from(b'0')))
    }

    /// The high bit of the first byte that is no digit; above it there may be others.
    #[inline]
    fn marks(self) -> u64 {
        // What a byte carries into those above it does not matter: it is marked itself.
        (self.0 | self.0.wrapping_add(Word::ONES * 0x76)) & (Word::ONES * 0x80)
    }

    /// Whether all bytes are digits.
    #[inline]
    pub(super) fn is_full(self) -> bool {
        self.marks() == 0
    }

    /// How many digits are at the start.
    #[inline]
    fn count(self) -> usize {
        self.marks().trailing_zeros() as usize / 8
    }

    /// The value of one to eight digits at the start.
    #[inline]
    pub(super) fn value(self, count: usize) -> u64 {
        // With zeros in front, to pairs, to fours, to all.
        let digits = self.0.wrapping_shl(64 - 8 * count as u32);
        let pairs = (digits.wrapping_mul(1 + (10 << 8)) >> 8) & 0x00ff_00ff_00ff_00ff;
        let fours = (pairs.wrapping_mul(1 + (100 << 16)) >> 16) & 0x0000_ffff_0000_ffff;
        fours.wrapping_mul(1 + (10_000 << 32)) >> 32
    }
}

/// Reads a number of at most 19 digits, and gives what comes behind; `None` if it takes more effort.
#[inline(always)]
pub(super) fn decimal<'b>(token: &'b [u8], expected: &mut Expected) -> Option<(f64, &'b [u8])> {
    let (negative, bytes) = match token {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, token),
    };
    let mut mantissa = 0;
    let whole = digits(bytes, &mut mantissa);
    let significant = if mantissa == 0 { 0 } else { whole };
    let mut rest = &bytes[whole..];
    let mut places = 0;
    if let [b'.', behind @ ..] = rest {
        places = many_digits(behind, &mut mantissa, expected);
        rest = &behind[places..];
    }
    if whole + places == 0 || whole > 19 || significant + places > 19 {
        return None;
    }
    let mut exponent = -(places as i32);
    if let [b'e' | b'E', behind @ ..] = rest {
        let (power, length) = power(behind)?;
        exponent += power;
        rest = &behind[length..];
    }
    let value = nearest(mantissa, exponent)?;
    Some((if negative { -value } else { value }, rest))
}

/// The power of ten behind an `e`, and how long it is.
fn power(bytes: &[u8]) -> Option<(i32, usize)> {
    let signs = usize::from(matches!(bytes, [b'-' | b'+', ..]));
    let mut power = 0;
    let count = digits(&bytes[signs..], &mut power);
    let power = (1..9).contains(&count).then_some(power as i32)?;
    let is_negative = bytes.starts_with(b"-");
    Some((if is_negative { -power } else { power }, signs + count))
}

/// Does what [`digits`] does, faster if there are many: eight by eight, and of the rest as many are
/// expected as the last time.
#[inline]
pub(super) fn many_digits(bytes: &[u8], value: &mut u64, expected: &mut Expected) -> usize {
    let mut rest = bytes;
    while let Some((&word, behind)) = rest.split_first_chunk() {
        let word = Word::new(word);
        if !word.is_full() {
            let (last, count) = expected.digits(word);
            *value = value
                .wrapping_mul(LARGE_POWERS[count] as u64)
                .wrapping_add(last);
            return bytes.len() - rest.len() + count;
        }
        *value = value
            .wrapping_mul(LARGE_POWERS[8] as u64)
            .wrapping_add(word.value(8));
        rest = behind;
    }
    bytes.len() - rest.len() + digits(rest, value)
}

/// The powers of ten that are exact.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The large powers of ten as whole numbers.
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

    /// Mostly digits, and the bytes that are nearest to them.
    fn text(state: &mut u64) -> Vec<u8> {
        let length = random(state) % 32;
        let mut byte = || match random(state) % 160 {
            odd @ 0..10 => b"/:.\0 \xb0\xb9\xff\x8a\x70"[odd as usize],
            digit => b'0' + (digit % 10) as u8,
        };
        (0..length).map(|_| byte()).collect()
    }

    #[test]
    fn digits_together_are_what_they_are_one_by_one() {
        let mut state = 3;
        let mut expected = Expected::default();
        for _ in 0..200_000 {
            let text = text(&mut state);
            let start = random(&mut state) % 1_000;
            let (mut one_by_one, mut together) = (start, start);
            let counts = (
                digits(&text, &mut one_by_one),
                many_digits(&text, &mut together, &mut expected),
            );
            assert_eq!(counts.0, counts.1, "{text:?}");
            assert_eq!(one_by_one, together, "{text:?}");
        }
    }
}
