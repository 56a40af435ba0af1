//! The words in the lines of a record.

use std::ops::Range;

use super::fault::{Fault, Parsed, quoted};
use super::scan::Scan;
use crate::record::VERSION;

pub(super) const CODE: &str = "W-OBJ-RECORD";

pub(super) const DAMAGED: &str = "the record is damaged";

/// The version of a record, which must be one that is known.
pub(super) fn version(scan: &mut Scan<'_>) -> Parsed<i64> {
    let start = scan.token_start();
    match scan.integer().filter(|_| scan.at_token_end()) {
        Some(version @ 1..=VERSION) => Ok(version),
        Some(later) if later > VERSION => {
            let message = "this record is of a later version, and not used";
            let expected = format!("expected {VERSION} at most, not {later}");
            let fault = Fault::new(CODE, start..scan.at(), message, expected);
            Err(fault.help("a later tearmesh reads it"))
        }
        _ => {
            scan.go_to(start);
            exactly(scan, "1").map(|()| 1)
        }
    }
}

pub(super) fn hexadecimal(scan: &mut Scan<'_>) -> Parsed<u64> {
    let start = scan.token_start();
    let token = scan.token();
    scan.skip(token.len());
    let digits = std::str::from_utf8(token).unwrap_or_default();
    match u64::from_str_radix(digits, 16) {
        Ok(number) if digits.len() == 16 => Ok(number),
        _ => {
            let message = format!("{} is no checksum", quoted(token));
            let expected = "expected 16 hexadecimal digits";
            Err(Fault::new(CODE, start..scan.at(), message, expected))
        }
    }
}

pub(super) fn exactly(scan: &mut Scan<'_>, word: &str) -> Parsed<()> {
    let start = scan.token_start();
    let token = scan.token();
    scan.skip(token.len());
    if token == word.as_bytes() {
        return Ok(());
    }
    let message = format!("this record has {} where `{word}` should be", quoted(token));
    damaged(scan, start, message)
}

pub(super) fn out_of_range(span: Range<usize>, least: i64, most: i64) -> Box<Fault> {
    let message = "a number of this record is out of its range";
    Fault::new(CODE, span, message, format!("expected {least} to {most}"))
}

/// Reads the numbers up to the end of the line, at most as many as `numbers` has room for.
pub(super) fn numbers(scan: &mut Scan<'_>, numbers: &mut [f64]) -> Parsed<usize> {
    let mut count = 0;
    while count < numbers.len() && scan.find_token() {
        numbers[count] = scan.number()?;
        count += 1;
    }
    nothing_more(scan).map(|()| count)
}

/// A whole number.
pub(super) fn whole(
    scan: &mut Scan<'_>,
    least: impl Into<i64>,
    most: impl Into<i64>,
) -> Parsed<u32> {
    let (start, least, most) = (scan.token_start(), least.into(), most.into());
    match scan.integer() {
        Some(number) if scan.at_token_end() && least <= number && number <= most => {
            Ok(number as u32)
        }
        _ => {
            scan.go_to(start);
            Err(out_of_range(start..start + scan.token().len(), least, most))
        }
    }
}

/// A number above `last` and at most `most`, counted from 0.
pub(super) fn index(scan: &mut Scan<'_>, last: impl Into<i64>, most: u32) -> Parsed<u32> {
    whole(scan, last.into() + 1, most).map(|number| number - 1)
}

/// The refusal of a part of a line of a damaged record: from `start` to the cursor.
pub(super) fn damaged<T>(scan: &Scan<'_>, start: usize, message: impl Into<String>) -> Parsed<T> {
    Err(Fault::new(CODE, start..scan.at(), message, DAMAGED))
}

pub(super) fn nothing_more(scan: &mut Scan<'_>) -> Parsed<()> {
    let start = scan.token_start();
    if start == scan.line.bytes.len() {
        return Ok(());
    }
    scan.go_to(scan.line.bytes.len());
    damaged(scan, start, "this line of a record has extra words")
}
