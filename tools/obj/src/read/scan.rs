//! A cursor over a logical line: blanks, tokens, numbers, indices.

use super::decimal::{digits, nearest};
use super::fault::{Fault, Parsed};
use super::line::quoted;

/// A cursor over a logical line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<'l> {
    pub(super) bytes: &'l [u8],
    pub(super) at: usize,
}

/// Whether a byte separates tokens. Line ends do, where a line is continued.
#[inline]
pub(super) const fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c)
}

impl<'l> Scan<'l> {
    #[inline]
    pub(super) fn new(bytes: &'l [u8]) -> Self {
        Scan { bytes, at: 0 }
    }

    #[inline]
    pub(super) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Skips blanks and continuations; whether a token follows, and not the end of
    /// the line or a comment.
    #[inline]
    pub(super) fn find_token(&mut self) -> bool {
        loop {
            match self.peek() {
                None | Some(b'#') => return false,
                Some(b'\\') if self.is_continuation() => self.at += 1,
                Some(byte) if is_blank(byte) => self.at += 1,
                Some(_) => return true,
            }
        }
    }

    /// The bytes up to the next blank, comment, continuation, or the end. Does not move.
    #[inline]
    pub(super) fn token(&self) -> &'l [u8] {
        let mut end = *self;
        while !end.at_token_end() {
            end.at += 1;
        }
        &self.bytes[self.at..end.at]
    }

    /// Whether no token continues here.
    #[inline]
    pub(super) fn at_token_end(&self) -> bool {
        match self.peek() {
            None | Some(b'#') => true,
            Some(b'\\') => self.is_continuation(),
            Some(byte) => is_blank(byte),
        }
    }

    /// Whether nothing but blanks comes between this `\` and the end of its line.
    #[cold]
    fn is_continuation(&self) -> bool {
        let rest = &self.bytes[self.at + 1..];
        let end = rest
            .iter()
            .position(|&byte| !is_blank(byte) || matches!(byte, b'\n' | b'\r'));
        end.is_none_or(|end| is_blank(rest[end]))
    }

    /// Where the tokens of the line end: behind the last one.
    pub(super) fn end_of_tokens(mut self) -> usize {
        let mut end = self.at;
        while self.find_token() {
            self.at += self.token().len();
            end = self.at;
        }
        end
    }

    /// Reads the number at the cursor, correctly rounded. What [`nearest`] does not find is left to
    /// `str::parse`.
    #[inline]
    pub(super) fn number(&mut self) -> Parsed<f64> {
        let start = self.at;
        let negative = self.sign();
        let mut mantissa = 0_u64;
        let mut digits = self.digits(&mut mantissa);
        let mut exponent = 0_i32;
        if self.peek() == Some(b'.') {
            self.at += 1;
            let fraction = self.digits(&mut mantissa);
            digits += fraction;
            exponent = -(fraction.min(1 << 20) as i32);
        }
        if digits == 0 {
            return Err(self.unreadable(start));
        }
        if let Some(b'e' | b'E') = self.peek() {
            self.at += 1;
            let negative = self.sign();
            let mut power = 0;
            let digits = self.digits(&mut power);
            if digits == 0 {
                return Err(self.unreadable(start));
            }
            let power = if digits < 9 { power as i32 } else { 1 << 20 };
            exponent += if negative { -power } else { power };
        }
        match self.peek() {
            None | Some(b' ') => {}
            Some(b'#') if is_mark_of_a_non_number(&self.bytes[self.at..]) => {
                return Err(self.unreadable(start));
            }
            _ if self.at_token_end() => {}
            _ => return Err(self.unreadable(start)),
        }
        if digits <= 19
            && let Some(value) = nearest(mantissa, exponent)
        {
            return Ok(if negative { -value } else { value });
        }
        self.number_by_library(start)
    }

    #[inline]
    fn sign(&mut self) -> bool {
        match self.peek() {
            Some(b'-') => {
                self.at += 1;
                true
            }
            Some(b'+') => {
                self.at += 1;
                false
            }
            _ => false,
        }
    }

    /// Appends digits to a number, and says how many; the number is right up to 19 of them.
    #[inline]
    fn digits(&mut self, value: &mut u64) -> usize {
        let count = digits(&self.bytes[self.at..], value);
        self.at += count;
        count
    }

    fn number_by_library(&self, start: usize) -> Parsed<f64> {
        let token = &self.bytes[start..self.at];
        let text = std::str::from_utf8(token).expect("signs, digits, point and exponent are ASCII");
        let value: f64 = text.parse().expect("this form was checked digit by digit");
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.unreadable(start))
        }
    }

    /// What is wrong with the number that starts here.
    #[cold]
    fn unreadable(&self, start: usize) -> Box<Fault> {
        let mut scan = Scan { at: start, ..*self };
        let mut token = scan.token();
        scan.at += token.len();
        if is_mark_of_a_non_number(&scan.bytes[scan.at..]) {
            scan.at += 1;
            scan.at += scan.token().len();
            token = &scan.bytes[start..scan.at];
        }
        let span = start..scan.at;
        if is_non_number(token) {
            let message = format!("{} is not a finite number", quoted(token));
            return Fault::new("E-OBJ-FINITE", span, message, "expected a finite number")
                .help("the program that wrote this file computed something undefined; repair the model in that program");
        }
        if std::str::from_utf8(token).is_ok_and(|text| text.parse::<f64>().is_ok()) {
            let message = format!("{} is beyond the range of 64-bit numbers", quoted(token));
            return Fault::new("E-OBJ-FINITE", span, message, "expected at most 1.8e308");
        }
        let comma = token.iter().position(|&byte| byte == b',');
        let example = match comma {
            Some(_) if quoted(token).chars().count() < 30 => quoted(token).replace(',', "."),
            _ => "`0.5`".to_owned(),
        };
        let label = format!("expected a finite decimal number such as {example}");
        let fault = Fault::new(
            "E-OBJ-FLOAT",
            span,
            format!("cannot read number {}", quoted(token)),
            label,
        );
        match comma {
            Some(_) => fault.help("OBJ uses `.` as the decimal mark; re-export with the C locale"),
            None => fault,
        }
    }

    /// Reads a whole number with an optional sign, at most `i64::MAX` in size;
    /// `None` if there is no digit.
    #[inline]
    pub(super) fn integer(&mut self) -> Option<i64> {
        let negative = self.sign();
        let start = self.at;
        let mut value = 0;
        let digits = self.digits(&mut value);
        if digits == 0 {
            return None;
        }
        let is_short = digits <= 18 || {
            let digits = &self.bytes[start..self.at];
            digits.iter().skip_while(|&&digit| digit == b'0').count() <= 18
        };
        let value = if is_short { value as i64 } else { i64::MAX };
        Some(if negative { -value } else { value })
    }
}

/// `nan`, `-inf`, `infinity`, `1.#IND` and the like.
fn is_non_number(token: &[u8]) -> bool {
    let word = token
        .strip_prefix(b"-")
        .or(token.strip_prefix(b"+"))
        .unwrap_or(token);
    let word = word.to_ascii_lowercase();
    matches!(
        &word[..],
        b"nan" | b"inf" | b"infinity" | b"nan(ind)" | b"nan(snan)"
    ) || word
        .iter()
        .position(|&byte| byte == b'#')
        .is_some_and(|at| is_mark_of_a_non_number(&word[at..]))
}

/// Old Microsoft libraries print `1.#IND`, `1.#QNAN` and `1.#INF`; the `#` must not pass
/// for a comment, or the number for 1.
#[cold]
fn is_mark_of_a_non_number(bytes: &[u8]) -> bool {
    [&b"#ind"[..], b"#inf", b"#qnan", b"#snan", b"#nan"]
        .iter()
        .any(|mark| {
            bytes
                .get(..mark.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(mark))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_library_bit_for_bit() {
        let mut state = 7_u64;
        let mut random = |bound: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) % bound
        };
        for _ in 0..200_000 {
            let mut text = ["", "-", "+"][random(3) as usize].to_owned();
            let (whole, fraction) = (random(12), random(14));
            text.extend((0..whole).map(|_| (b'0' + random(10) as u8) as char));
            if fraction > 0 || whole == 0 {
                text.push('.');
                text.extend((0..fraction).map(|_| (b'0' + random(10) as u8) as char));
            }
            if whole + fraction == 0 {
                text.push('5');
            }
            if random(3) == 0 {
                text += ["e", "E", "e+", "e-"][random(4) as usize];
                text += &random(40).to_string();
            }
            let value = Scan::new(text.as_bytes()).number().expect(&text);
            let truth: f64 = text.parse().expect("a number");
            assert_eq!(value.to_bits(), truth.to_bits(), "{text}");
        }
    }

    #[test]
    fn a_token_ends_at_a_blank_a_comment_and_a_continuation() {
        for (bytes, token) in [
            (&b"ab"[..], &b"ab"[..]),
            (b"ab c", b"ab"),
            (b"ab#c", b"ab"),
            (b"ab\\\nc", b"ab"),
            (b"ab\\ \t\r\nc", b"ab"),
            (b"ab\\", b"ab"),
            (b"a\\b", b"a\\b"),
            (b"a\\ b", b"a\\"),
        ] {
            assert_eq!(
                Scan::new(bytes).token(),
                token,
                "{:?}",
                String::from_utf8_lossy(bytes)
            );
        }
    }
}
