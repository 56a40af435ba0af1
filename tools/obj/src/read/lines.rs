//! Bytes to logical lines, in chunks.
//!
//! A line ends with LF, CR LF or a lone CR, or with the file. A `\` before the end of a line,
//! blanks between them or not, joins the next line to it, unless a `#` comes first: a comment
//! such as `# C:\cloth\` must not swallow the statement after it. Only the current logical
//! line is held in memory.

use std::io::{ErrorKind, Read};

use super::fault::Fault;
use super::line::Line;
use crate::diagnostic::ReadError;

/// How much is asked of the input at once.
const CHUNK: usize = 64 << 10;

/// The most bytes of a logical line. Real lines of some megabytes exist (a whole curve
/// in one statement); 64 MiB is the memory that even the smallest file may use.
pub(super) const LINE_MAX: usize = 64 << 20;

/// The source of logical lines.
#[derive(Debug)]
pub(super) struct Lines<R> {
    input: R,
    buffer: Vec<u8>,
    /// What was read and not yet handed out.
    start: usize,
    end: usize,
    exhausted: bool,
    /// The number of the next physical line.
    number: u32,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(input: R) -> Self {
        Lines {
            input,
            buffer: vec![0; CHUNK],
            start: 0,
            end: 0,
            exhausted: false,
            number: 1,
        }
    }

    /// The first bytes: at least `count` of them, if the input has that many.
    pub(super) fn peek(&mut self, count: usize) -> Result<&[u8], ReadError> {
        while self.end - self.start < count && !self.exhausted {
            self.fill()?;
        }
        Ok(&self.buffer[self.start..self.end])
    }

    /// Drops bytes that were peeked at.
    pub(super) fn skip(&mut self, count: usize) {
        self.start += count;
    }

    /// What was read from the input and not yet handed out: it begins with a line.
    pub(super) fn buffered(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// Drops `count` whole lines, which together have `bytes` bytes, from the start of the buffer.
    pub(super) fn skip_lines(&mut self, count: u32, bytes: usize) {
        self.number += count;
        self.start += bytes;
    }

    /// The number of the line after the last one that was handed out.
    pub(super) fn number(&self) -> u32 {
        self.number
    }

    /// The next logical line.
    #[inline]
    pub(super) fn next(&mut self) -> Result<Option<Line<'_>>, ReadError> {
        let number = self.number;
        let mut physical = 0; // Where the current physical line starts, from `start`.
        let mut searched = 0;
        loop {
            let data = &self.buffer[self.start..self.end];
            let Some(at) = find_line_end(&data[searched..]).map(|at| at + searched) else {
                searched = data.len();
                if self.exhausted {
                    return Ok(self.last_line(number, physical));
                }
                self.fill_for(number)?;
                continue;
            };
            let ending = match (data[at], data.get(at + 1)) {
                (b'\r', Some(b'\n')) => 2,
                (b'\r', None) if !self.exhausted => {
                    searched = at;
                    self.fill_for(number)?;
                    continue;
                }
                _ => 1,
            };
            self.number = self
                .number
                .checked_add(1)
                .ok_or_else(|| too_many_lines(number))?;
            searched = at + ending;
            // What comes before is continued, and so holds no comment.
            if !is_continued(&data[physical..at]) {
                let start = self.start;
                self.start += searched;
                return Ok(Some(Line {
                    bytes: &self.buffer[start..start + at],
                    number,
                }));
            }
            physical = searched;
        }
    }

    /// What is left where the file ends without a line end.
    fn last_line(&mut self, number: u32, physical: usize) -> Option<Line<'_>> {
        let start = self.start;
        self.start = self.end;
        let mut bytes = &self.buffer[start..self.end];
        if bytes.is_empty() {
            return None;
        }
        self.number = number.saturating_add(1);
        let dangling = physical == bytes.len() || is_continued(&bytes[physical..]);
        if dangling && !bytes[..physical].contains(&b'#') {
            // The file ends, so the `\` joins nothing to the line. It is dropped, since whatever is
            // written behind it would be joined.
            while let [
                rest @ ..,
                b' ' | b'\t' | 0x0b | 0x0c | b'\r' | b'\n' | b'\\',
            ] = bytes
            {
                bytes = rest;
            }
        }
        Some(Line { bytes, number })
    }

    /// Reads more of a line that is not complete, within the cap.
    fn fill_for(&mut self, number: u32) -> Result<(), ReadError> {
        let length = self.end - self.start;
        if length > LINE_MAX {
            let window = Line {
                bytes: &self.buffer[self.start..self.start + 80],
                number,
            };
            let fault = Fault::new(
                "E-OBJ-LINE",
                0..0,
                format!("this line is longer than {} MiB", LINE_MAX >> 20),
                "starts here",
            )
            .help("is this an OBJ file?");
            return Err(fault.at(&window));
        }
        self.fill()
    }

    fn fill(&mut self) -> Result<(), ReadError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        if self.end == self.buffer.len() {
            let more = self.buffer.len() / 2;
            self.buffer.reserve_exact(more);
            self.buffer.resize(self.end + more, 0);
        }
        loop {
            match self.input.read(&mut self.buffer[self.end..]) {
                Ok(count) => {
                    self.end += count;
                    self.exhausted = count == 0;
                    return Ok(());
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(ReadError::Input(error)),
            }
        }
    }
}

#[cold]
fn too_many_lines(number: u32) -> ReadError {
    let message = format!("the file has more than {} lines", u32::MAX - 1);
    Fault::new("E-OBJ-LIMIT", 0..0, message, "").at(&Line { bytes: b"", number })
}

/// The length of the first logical line of a text whose line ends are all `\n`, with its end.
pub(super) fn logical_line_length(text: &[u8]) -> usize {
    let mut physical = 0;
    while let Some(end) = text[physical..].iter().position(|&byte| byte == b'\n') {
        let end = physical + end;
        if !is_continued(&text[physical..end]) {
            return end + 1;
        }
        physical = end + 1;
    }
    text.len()
}

/// Whether a physical line ends with `\` outside a comment, blanks aside.
#[inline]
fn is_continued(line: &[u8]) -> bool {
    let mut end = line.len();
    while end > 0 && matches!(line[end - 1], b' ' | b'\t' | 0x0b | 0x0c) {
        end -= 1;
    }
    end > 0 && line[end - 1] == b'\\' && !line.contains(&b'#')
}

/// The position of the first CR or LF.
#[inline]
fn find_line_end(bytes: &[u8]) -> Option<usize> {
    const ONES: u64 = u64::from_ne_bytes([1; 8]);
    const HIGH: u64 = u64::from_ne_bytes([0x80; 8]);
    let (words, rest) = bytes.as_chunks::<8>();
    for (i, word) in words.iter().enumerate() {
        // A byte of `x` is zero where the word has the sought one; the lowest mark that
        // the subtraction leaves is right, and those above it do not matter.
        let word = u64::from_le_bytes(*word);
        let feed = word ^ (ONES * u64::from(b'\n'));
        let carriage = word ^ (ONES * u64::from(b'\r'));
        let marks =
            ((feed.wrapping_sub(ONES) & !feed) | (carriage.wrapping_sub(ONES) & !carriage)) & HIGH;
        if marks != 0 {
            return Some(8 * i + marks.trailing_zeros() as usize / 8);
        }
    }
    let tail = rest
        .iter()
        .position(|&byte| byte == b'\n' || byte == b'\r')?;
    Some(bytes.len() - rest.len() + tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hands out a few bytes at a time, so that every boundary is met.
    struct Trickle<'b>(&'b [u8], usize);

    impl Read for Trickle<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let count = self.1.min(self.0.len()).min(buffer.len());
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn lines(bytes: &[u8]) -> Vec<(u32, String)> {
        let read_by = |step| {
            let mut lines = Lines::new(Trickle(bytes, step));
            let mut all = Vec::new();
            while let Some(line) = lines.next().expect("readable") {
                all.push((
                    line.number,
                    String::from_utf8_lossy(line.bytes).into_owned(),
                ));
            }
            all
        };
        let at_once = read_by(bytes.len().max(1));
        for step in 1..bytes.len() {
            assert_eq!(read_by(step), at_once, "{step} bytes at a time");
        }
        at_once
    }

    #[test]
    fn every_line_end_and_continuation() {
        for (bytes, expected) in [
            (&b""[..], &[][..]),
            (b"a", &[(1, "a")]),
            (b"a\n", &[(1, "a")]),
            (b"a\nb\r\nc\rd", &[(1, "a"), (2, "b"), (3, "c"), (4, "d")]),
            (b"\n\n", &[(1, ""), (2, "")]),
            (b"\r\r\n\n", &[(1, ""), (2, ""), (3, "")]),
            (b"a\\\nb\nc", &[(1, "a\\\nb"), (3, "c")]),
            (
                b"a \\ \t\r\nb\\\rc\nd",
                &[(1, "a \\ \t\r\nb\\\rc"), (4, "d")],
            ),
            (b"# a\\\nb", &[(1, "# a\\"), (2, "b")]),
            (b"a\\\nb # c \\\nd", &[(1, "a\\\nb # c \\"), (3, "d")]),
            (b"a\\", &[(1, "a")]),
            (b"a\\\n", &[(1, "a")]),
            (b"a\\\r\n", &[(1, "a")]),
            (b"a\\\n\\\n", &[(1, "a")]),
            (b"a\\\n b", &[(1, "a\\\n b")]),
        ] {
            let expected: Vec<_> = expected.iter().map(|&(n, s)| (n, s.to_owned())).collect();
            assert_eq!(
                lines(bytes),
                expected,
                "{:?}",
                String::from_utf8_lossy(bytes)
            );
        }
    }

    #[test]
    fn the_first_line_end_is_found_among_its_likes() {
        let mut state = 1_u32;
        for length in 0..40 {
            for _ in 0..200 {
                let bytes: Vec<u8> = (0..length)
                    .map(|_| {
                        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                        // Neighbours of CR and LF, with and without the high bit.
                        [
                            9, 10, 11, 12, 13, 14, 0x8a, 0x8d, b'x', b'x', b'x', b'x', b'x', 0,
                            0xff, 1,
                        ][(state >> 28) as usize]
                    })
                    .collect();
                let naive = bytes.iter().position(|&b| b == 10 || b == 13);
                assert_eq!(find_line_end(&bytes), naive, "{bytes:?}");
            }
        }
    }
}
