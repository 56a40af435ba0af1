//! Text that was carried through, taken apart again into its statements.

use super::lines::logical_line_length;
use super::scan::Scan;
use crate::keyword::Class;

/// How many bytes at the start of a text are foreign statements, which belong to the
/// statement before it: whole lines, each with `\n` at its end.
pub(crate) fn attached_length(text: &[u8]) -> usize {
    let mut length = 0;
    while length < text.len() {
        let rest = &text[length..];
        let mut scan = Scan::new(rest);
        if !scan.find_token() || rest[..scan.at].contains(&b'\n') {
            break;
        }
        if Class::of(scan.token()) != Class::Foreign {
            break;
        }
        length += logical_line_length(rest);
    }
    length
}

/// The statements of a text, each with its keyword (empty for a comment or a blank line) and its
/// whole lines, each with `\n` at its end.
pub(crate) fn statements(mut text: &[u8]) -> impl Iterator<Item = (&[u8], &[u8])> {
    std::iter::from_fn(move || {
        if text.is_empty() {
            return None;
        }
        let (statement, rest) = text.split_at(logical_line_length(text));
        text = rest;
        let mut scan = Scan::new(statement);
        scan.find_token();
        Some((scan.token(), statement))
    })
}
