//! Exact arithmetic on `f64`: powers of two, and sums without rounding.
//!
//! A ledger that compares float sums needs a tolerance, and a tolerance hides lost mass.
//! [`ExactSum`] has none: it adds every bit, in any order, and two sums are equal exactly when the
//! numbers they stand for are. It is a fixed-point number as wide as the whole range of `f64`
//! (Kulisch's long accumulator), cut into 32-bit digits with room for carries. An addition costs
//! two digit multiplications, and 2^30 additions fit between two normalisations.

/// Numbers whose size rounding alone explains: 32 · 2^-53 of what they were computed
/// from. An error bound, not a tolerance.
pub(crate) const ROUNDING: f64 = 32.0 * f64::EPSILON / 2.0;

/// Two to the power `exponent`.
///
/// # Panics
///
/// Outside −1074 … 1023, where `f64` has no such number.
#[must_use]
pub(crate) fn power_of_two(exponent: i32) -> f64 {
    match exponent {
        -1022..=1023 => f64::from_bits(((exponent + 1023) as u64) << 52),
        -1074..=-1023 => f64::from_bits(1 << (exponent + 1074)),
        _ => panic!("2^{exponent} is no f64"),
    }
}

/// The exponent `e` with `2^(e-1) <= x < 2^e`, for positive finite `x`.
#[must_use]
pub(crate) fn exponent_above(x: f64) -> i32 {
    debug_assert!(x > 0.0 && x.is_finite());
    if x < f64::MIN_POSITIVE {
        exponent_above(x * power_of_two(100)) - 100
    } else {
        ((x.to_bits() >> 52) & 0x7ff) as i32 - 1022
    }
}

/// The product of two numbers as a sum of two, without rounding: the nearest `f64` and what is
/// missing (Dekker, "A floating-point technique for extending the available precision", 1971). That
/// holds while the product is above 2^-960 in size or zero, and the factors are below 2^990.
pub(crate) fn product(a: f64, b: f64) -> [f64; 2] {
    // Veltkamp's halves, of 26 bits each, whose products are exact.
    let halves = |x: f64| {
        let large = x * f64::from((1 << 27) + 1);
        let high = large - (large - x);
        [high, x - high]
    };
    let ([ah, al], [bh, bl]) = (halves(a), halves(b));
    let high = a * b;
    [high, al * bl - (((high - ah * bh) - al * bh) - ah * bl)]
}

/// 2^-1074 is the lowest bit of an `f64`; 2^1024 is above every one. 66 digits
/// of 32 bits hold that range, and two more hold the carries of 2^60 additions.
const DIGITS: usize = 68;
const DIGIT_BITS: usize = 32;

/// The exact sum of any number of finite `f64` numbers.
///
/// ```
/// use tearmesh::ExactSum;
///
/// let there: ExactSum = [1e300, 1.0, -1e300].into_iter().collect();
/// let back: ExactSum = [1.0].into_iter().collect();
/// assert_eq!(there, back); // a float sum gives 0
/// assert_eq!(there.to_f64(), 1.0);
/// ```
#[derive(Clone)]
pub struct ExactSum {
    /// Digit `i` counts units of 2^(32 i − 1074); any sign, not normalised.
    digits: [i64; DIGITS],
    /// Additions since the digits were last normalised.
    pending: u32,
}

impl ExactSum {
    /// Creates the sum of no numbers, which is zero.
    #[must_use]
    pub const fn new() -> Self {
        ExactSum {
            digits: [0; DIGITS],
            pending: 0,
        }
    }

    /// Adds `x` to the sum, without rounding.
    ///
    /// # Panics
    ///
    /// If `x` is not finite.
    pub fn add(&mut self, x: f64) {
        assert!(
            x.is_finite(),
            "an exact sum takes finite numbers only, not {x}"
        );
        if self.pending == 1 << 30 {
            self.digits = self.normalised();
            self.pending = 0;
        }
        self.pending += 1;
        let bits = x.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as usize;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, shift) = if biased == 0 {
            (fraction, 0)
        } else {
            (fraction | (1 << 52), biased - 1)
        };
        let sign = if x < 0.0 { -1 } else { 1 };
        let (digit, offset) = (shift / DIGIT_BITS, shift % DIGIT_BITS);
        let mut rest = u128::from(mantissa) << offset;
        for place in &mut self.digits[digit..digit + 3] {
            *place += sign * i64::from(rest as u32);
            rest >>= DIGIT_BITS;
        }
    }

    /// Returns the sum, rounded once to the nearest `f64` (ties to even). A sum beyond the largest
    /// finite `f64` becomes infinite.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        let digits = self.normalised();
        if digits[DIGITS - 1] < 0 {
            let mut negated = self.clone();
            for digit in &mut negated.digits {
                *digit = -*digit;
            }
            return -negated.to_f64();
        }
        let Some(top) = digits.iter().rposition(|&digit| digit != 0) else {
            return 0.0;
        };
        // The leading three digits hold at least 65 bits. What lies below them
        // matters only as "something is there" when the rounding is decided.
        let low = top.saturating_sub(2);
        let head = digits[low..=top]
            .iter()
            .rev()
            .fold(0u128, |n, &d| n << DIGIT_BITS | d as u128);
        if low == 0 {
            return head as f64 * power_of_two(-1074);
        }
        let below = u128::from(digits[..low].iter().any(|&digit| digit != 0));
        (head << 1 | below) as f64 * power_of_two((DIGIT_BITS * low) as i32 - 1075)
    }

    /// Every digit in 0 … 2^32 − 1, but for the top one, which carries the sign.
    fn normalised(&self) -> [i64; DIGITS] {
        let mut digits = self.digits;
        for i in 0..DIGITS - 1 {
            let carry = digits[i] >> DIGIT_BITS;
            digits[i] -= carry << DIGIT_BITS;
            digits[i + 1] += carry;
        }
        digits
    }
}

impl Default for ExactSum {
    fn default() -> Self {
        Self::new()
    }
}

impl PartialEq for ExactSum {
    fn eq(&self, other: &Self) -> bool {
        self.normalised() == other.normalised()
    }
}

impl Eq for ExactSum {}

impl std::fmt::Debug for ExactSum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ExactSum(about {:?})", self.to_f64())
    }
}

impl Extend<f64> for ExactSum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, numbers: I) {
        numbers.into_iter().for_each(|x| self.add(x));
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut sum = ExactSum::new();
        sum.extend(numbers);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_bracket_their_numbers() {
        for x in [
            1.0,
            0.75,
            1.5,
            3e300,
            1e-300,
            5e-324,
            f64::MAX,
            f64::MIN_POSITIVE,
        ] {
            let e = exponent_above(x);
            assert!(x >= power_of_two(e - 1), "{x}");
            assert!(e == 1024 || x < power_of_two(e), "{x}");
        }
        assert_eq!(power_of_two(-1074), 5e-324);
        assert_eq!(power_of_two(0), 1.0);
    }
}
