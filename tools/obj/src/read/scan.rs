//! A cursor over a statement: blanks, tokens, numbers, indices.
//!
//! The cursor runs over the bytes of a block, in which the statement's line end is not known in
//! advance. Digits, single blanks and line feeds are looked at where they are met; all
//! else that a statement may have (continuations, comments, tabs) is set apart as cold.

use std::ops::Range;

use super::decimal::{Expected, WINDOW, decimal, digits};
use super::fault::{Fault, Line, Parsed, quoted};

/// A cursor over a logical line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<'l> {
    /// The line, and perhaps more lines behind its end.
    pub(super) line: Line<'l>,
    /// What the cursor has not passed.
    pub(super) rest: &'l [u8],
    /// How many line ends the cursor has passed.
    pub(super) continuations: u32,
}

impl<'l> Scan<'l> {
    #[inline]
    pub(super) fn new(line: Line<'l>) -> Self {
        Scan {
            line,
            rest: line.bytes,
            continuations: 0,
        }
    }

    /// Moves to the start of the next line, where the cursor stands.
    #[inline(always)]
    pub(super) fn start_next_line(&mut self) {
        *self = Scan::new(Line {
            bytes: self.rest,
            number: self.line.number + 1 + self.continuations,
        });
    }

    /// The bytes of the line that the cursor has passed.
    #[inline(always)]
    pub(super) fn at(&self) -> usize {
        self.line.bytes.len() - self.rest.len()
    }

    #[inline(always)]
    pub(super) fn skip(&mut self, count: usize) {
        self.rest = &self.rest[count..];
    }

    /// This cursor behind some bytes.
    #[inline(always)]
    pub(super) fn behind(&mut self, count: usize) -> &mut Self {
        self.skip(count);
        self
    }

    pub(super) fn go_to(&mut self, at: usize) {
        self.rest = &self.line.bytes[at..];
    }

    /// This cursor at another place of its line.
    pub(super) fn moved_to(mut self, at: usize) -> Self {
        self.go_to(at);
        self
    }

    #[inline(always)]
    pub(super) fn peek(&self) -> Option<u8> {
        self.rest.first().copied()
    }

    /// Skips blanks; whether the line ends here. What else may be here is left to
    /// [`Scan::find_token`].
    #[inline(always)]
    pub(super) fn at_line_end(&mut self) -> bool {
        while let [b' ', rest @ ..] = self.rest {
            self.rest = rest;
        }
        matches!(self.rest, [b'\n' | b'\r', ..])
    }

    /// Skips blanks and continuations; whether a token follows, and not the end of
    /// the line or a comment.
    #[inline(always)]
    pub(super) fn find_token(&mut self) -> bool {
        // By value, here and elsewhere: a cursor whose address is taken is no register.
        *self = self.behind_blanks();
        !matches!(self.peek(), None | Some(b'#' | b'\n' | b'\r'))
    }

    /// Moves to the next token; where it starts.
    pub(super) fn token_start(&mut self) -> usize {
        self.find_token();
        self.at()
    }

    #[cold]
    #[inline(never)]
    fn behind_blanks(mut self) -> Self {
        loop {
            if let Some(b' ' | b'\t' | 0x0b | 0x0c) = self.peek() {
                self.skip(1);
            } else if let Some(length) = self.continuation() {
                self.skip(length);
                self.continuations += 1;
            } else {
                return self;
            }
        }
    }

    /// The length of a `\` with the line end behind it, if it is here and nothing but blanks
    /// comes between.
    #[cold]
    fn continuation(self) -> Option<usize> {
        let behind = self.rest.strip_prefix(b"\\")?;
        let blanks = behind.iter();
        let blanks = blanks.take_while(|byte| matches!(byte, b' ' | b'\t' | 0x0b | 0x0c));
        let blanks = blanks.count();
        match behind[blanks..] {
            [] => Some(1 + blanks),
            [b'\r', b'\n', ..] => Some(3 + blanks),
            [b'\r' | b'\n', ..] => Some(2 + blanks),
            [..] => None,
        }
    }

    /// The bytes up to the next blank, comment, continuation, or the end. Does not move.
    #[inline]
    pub(super) fn token(&self) -> &'l [u8] {
        let mut end = *self;
        while let [byte, rest @ ..] = end.rest
            && (*byte > b'#' && *byte != b'\\' || !end.at_token_end())
        {
            end.rest = rest;
        }
        &self.rest[..self.rest.len() - end.rest.len()]
    }

    /// Whether no token continues here.
    #[inline(always)]
    pub(super) fn at_token_end(&self) -> bool {
        match self.peek() {
            None | Some(b' ' | b'\n' | b'\r' | b'\t' | 0x0b | 0x0c | b'#') => true,
            Some(b'\\') => self.continuation().is_some(),
            Some(_) => false,
        }
    }

    /// Where the tokens of the line end: behind the last one.
    pub(super) fn end_of_tokens(&self) -> usize {
        let mut scan = Scan::new(self.line);
        let mut end = 0;
        while scan.find_token() {
            scan.skip(scan.token().len());
            end = scan.at();
        }
        end
    }

    /// Where a token of the line is, counted from 0 behind the keyword.
    pub(super) fn argument(&self, number: usize) -> Range<usize> {
        let mut scan = Scan::new(self.line);
        scan.find_token();
        for _ in 0..=number {
            scan.skip(scan.token().len());
            scan.find_token();
        }
        scan.at()..scan.at() + scan.token().len()
    }

    /// Reads the numbers of a statement as most lines have it: as many as are asked for, one blank
    /// between them and the line end behind, correctly rounded. Does not move if it is another.
    #[inline(always)]
    pub(super) fn usual_numbers<const COUNT: usize>(
        &mut self,
        places: &mut Expected,
    ) -> Option<[f64; COUNT]> {
        let mut rest = self.rest;
        let mut numbers = [0.0; COUNT];
        for (at, number) in numbers.iter_mut().enumerate() {
            if at > 0 {
                rest = rest.strip_prefix(b" ")?;
            }
            let length;
            (*number, length) = decimal(rest.first_chunk()?, places)?;
            rest = rest.get(length..)?;
        }
        matches!(rest, [b'\n' | b'\r', ..]).then(|| {
            self.rest = rest;
            numbers
        })
    }

    /// Reads a number in front of a blank, correctly rounded, unless that takes more effort.
    #[inline(always)]
    pub(super) fn usual_number(&mut self, places: &mut Expected) -> Option<f64> {
        let (value, length) = match self.rest.first_chunk() {
            Some(window) => decimal(window, places)?,
            None => {
                let mut window = [0; WINDOW];
                window[..self.rest.len()].copy_from_slice(self.rest);
                decimal(&window, places)?
            }
        };
        let rest = self.rest.get(length..)?;
        matches!(rest, [b' ' | b'\n' | b'\r', ..]).then(|| {
            self.rest = rest;
            value
        })
    }

    /// Reads the number at the cursor, correctly rounded.
    pub(super) fn number(&mut self) -> Parsed<f64> {
        let (value, length) = self.any_number()?;
        self.skip(length);
        Ok(value)
    }

    #[cold]
    #[inline(never)]
    fn any_number(self) -> Parsed<(f64, usize)> {
        let token = self.token();
        let number = std::str::from_utf8(token).ok();
        let number = number.and_then(|text| text.parse().ok());
        let rest = &self.line.bytes[self.at() + token.len()..];
        match number.filter(|value: &f64| value.is_finite()) {
            Some(value) if !is_mark_of_a_non_number(rest) => Ok((value, token.len())),
            _ => Err(self.unreadable()),
        }
    }

    /// What is wrong with the number that starts here.
    #[cold]
    fn unreadable(self) -> Box<Fault> {
        let start = self.at();
        let mut scan = self;
        let mut token = scan.token();
        scan.skip(token.len());
        if is_mark_of_a_non_number(&scan.line.bytes[scan.at()..]) {
            scan.skip(1);
            scan.skip(scan.token().len());
            token = &scan.line.bytes[start..scan.at()];
        }
        let span = start..scan.at();
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
        let message = format!("cannot read number {}", quoted(token));
        let fault = Fault::new("E-OBJ-FLOAT", span, message, label);
        match comma {
            Some(_) => fault.help("OBJ uses `.` as the decimal mark; re-export with the C locale"),
            None => fault,
        }
    }

    /// Reads a whole number with an optional sign, at most `i64::MAX` in size;
    /// `None` if there is no digit.
    pub(super) fn integer(&mut self) -> Option<i64> {
        let is_negative = self.peek() == Some(b'-');
        self.skip(usize::from(matches!(self.peek(), Some(b'-' | b'+'))));
        let mut value = 0;
        let length = digits(self.rest, &mut value);
        let zeros = || self.rest.iter().take_while(|&&digit| digit == b'0').count();
        let value = match length {
            0 => return None,
            19.. if length - zeros() > 18 => i64::MAX,
            _ => value as i64,
        };
        self.skip(length);
        Some(if is_negative { -value } else { value })
    }
}

/// `nan`, `-inf`, `infinity`, `1.#IND` and the like.
fn is_non_number(token: &[u8]) -> bool {
    let word = token.strip_prefix(b"-").or(token.strip_prefix(b"+"));
    let word = word.unwrap_or(token).to_ascii_lowercase();
    let mark = word.iter().position(|&byte| byte == b'#');
    matches!(
        &word[..],
        b"nan" | b"inf" | b"infinity" | b"nan(ind)" | b"nan(snan)"
    ) || mark.is_some_and(|at| is_mark_of_a_non_number(&word[at..]))
}

/// Old Microsoft libraries print `1.#IND`, `1.#QNAN` and `1.#INF`; the `#` must not pass
/// for a comment, or the number for 1.
fn is_mark_of_a_non_number(bytes: &[u8]) -> bool {
    let marks = [&b"#ind"[..], b"#inf", b"#qnan", b"#snan", b"#nan"];
    marks.iter().any(|mark| {
        let start = bytes.get(..mark.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(mark))
    })
}
