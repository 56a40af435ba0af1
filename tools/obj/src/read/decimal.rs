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

/// How many bytes a number is read from. That a word lies within them is known without a look at where
/// the text ends.
pub(super) const WINDOW: usize = 48;

/// Reads a number of at most 19 digits at the start of a window, and says how long it is; `None` if it
/// takes more effort.
#[inline(always)]
pub(super) fn decimal(window: &[u8; WINDOW], expected: &mut Expected) -> Option<(f64, usize)> {
    // Without a branch: signs are what a processor foresees least.
    let is_negative = window[0] == b'-';
    let start = usize::from(is_negative);
    let (mut at, mut mantissa) = (start, 0);
    while at < 19 && window[at].is_ascii_digit() {
        mantissa = 10 * mantissa + u64::from(window[at] - b'0');
        at += 1;
    }
    let whole = at - start;
    let significant = if mantissa == 0 { 0 } else { whole };
    let mut places = 0;
    if window[at] == b'.' {
        at += 1;
        places = many_digits(&window[at..], &mut mantissa, expected);
        at += places;
    }
    let has_power = matches!(window.get(at)?, b'e' | b'E');
    // Below 10^15 all whole numbers are exact, and so are these powers.
    let value = match whole + places {
        1..=15 if !has_power => mantissa as i64 as f64 / POWERS[places],
        0 => return None,
        _ if significant + places > 19 => return None,
        _ if has_power => {
            let (power, length) = power(&window[at + 1..])?;
            at += 1 + length;
            nearest(mantissa, power - places as i32)?
        }
        _ => nearest(mantissa, -(places as i32))?,
    };
    let sign = u64::from(is_negative) << 63;
    Some((f64::from_bits(value.to_bits() | sign), at))
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
