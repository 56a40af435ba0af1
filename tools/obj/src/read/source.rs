//! Bytes to blocks of whole lines.
//!
//! A line ends with LF, CR LF or a lone CR, or with the file. A `\` before the end of a line,
//! blanks between them or not, joins the next line to it, unless a `#` comes first: a comment
//! such as `# C:\cloth\` must not swallow the statement after it. Only one block is held in
//! memory.

use std::io::{ErrorKind, Read};

use memchr::{memchr2, memrchr2};

use super::fault::{Fault, Line};
use crate::diagnostic::ReadError;

/// How much is read at once.
const CHUNK: usize = 64 << 10;

/// The most bytes of a logical line. Real lines of some megabytes exist (a whole curve
/// in one statement); 64 MiB is the memory that even the smallest file may use.
const LINE_MAX: usize = 64 << 20;

/// The source of lines.
#[derive(Debug)]
pub(super) struct Source<R> {
    input: R,
    buffer: Vec<u8>,
    /// What was read and not yet handed out.
    start: usize,
    end: usize,
    exhausted: bool,
}

impl<R: Read> Source<R> {
    pub(super) fn new(input: R) -> Self {
        Source {
            input,
            buffer: vec![0; CHUNK],
            start: 0,
            end: 0,
            exhausted: false,
        }
    }

    /// The first bytes: at least a chunk of them, if the input has that many.
    pub(super) fn first(&mut self) -> Result<&[u8], ReadError> {
        if self.end == 0 {
            self.fill()?;
        }
        Ok(&self.buffer[self.start..self.end])
    }

    /// Drops bytes of the first ones.
    pub(super) fn skip(&mut self, count: usize) {
        self.start += count;
    }

    /// The next logical lines, each with a line end; the first one has this number. `None` at the
    /// end of the input.
    pub(super) fn block(&mut self, number: u32) -> Result<Option<&[u8]>, ReadError> {
        loop {
            let length = whole_lines(&self.buffer[self.start..self.end], self.exhausted);
            if length > 0 {
                let start = self.start;
                self.start += length;
                return Ok(Some(&self.buffer[start..self.start]));
            }
            if self.end - self.start > LINE_MAX {
                return Err(self.too_long(number));
            }
            if self.exhausted {
                return Ok(self.last_line());
            }
            self.fill()?;
        }
    }

    /// What is left where the file ends without a line end, with one.
    fn last_line(&mut self) -> Option<&[u8]> {
        if self.start == self.end {
            return None;
        }
        self.buffer.truncate(self.end);
        let line = &self.buffer[self.start..];
        // Behind a line end, what comes before is continued.
        if line.ends_with(b"\n") || line.ends_with(b"\r") || is_continued(last_physical_line(line))
        {
            // The file ends, so the `\` joins nothing to the line. It is dropped, since whatever is
            // written behind it would be joined.
            while let [.., b' ' | b'\t' | 0x0b | 0x0c | b'\r' | b'\n' | b'\\'] =
                self.buffer[self.start..]
            {
                self.buffer.pop();
            }
        }
        self.buffer.push(b'\n');
        let start = self.start;
        (self.start, self.end) = (self.buffer.len(), self.buffer.len());
        Some(&self.buffer[start..])
    }

    #[cold]
    fn too_long(&self, number: u32) -> ReadError {
        let window = Line {
            bytes: &self.buffer[self.start..self.start + 80],
            number,
        };
        let message = format!("this line is longer than {} MiB", LINE_MAX >> 20);
        let fault = Fault::new("E-OBJ-LINE", 0..0, message, "starts here");
        fault.help("is this an OBJ file?").at(&window)
    }

    /// Fills the buffer, and makes it larger first if it is full.
    fn fill(&mut self) -> Result<(), ReadError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        if self.end == self.buffer.len() {
            let more = (self.end / 2).min(LINE_MAX + CHUNK - self.end);
            self.buffer.reserve_exact(more);
            self.buffer.resize(self.end + more, 0);
        }
        while self.end < self.buffer.len() && !self.exhausted {
            match self.input.read(&mut self.buffer[self.end..]) {
                Ok(count) => {
                    self.end += count;
                    self.exhausted = count == 0;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(ReadError::Input(error)),
            }
        }
        Ok(())
    }
}

/// How many bytes at the start are whole logical lines. Unless the input `is_all`, a CR at the end may
/// be half of a line end.
fn whole_lines(bytes: &[u8], is_all: bool) -> usize {
    let mut rest = bytes;
    while let Some(at) = memrchr2(b'\n', b'\r', rest) {
        let end = at + 1;
        let before = match &rest[..end] {
            [before @ .., b'\r', b'\n'] | [before @ .., _] => before,
            [] => unreachable!("a line end was found"),
        };
        let is_half = end == bytes.len() && bytes[at] == b'\r' && !is_all;
        if !is_half && !is_continued(last_physical_line(before)) {
            return end;
        }
        rest = before;
    }
    0
}

/// What comes behind the last line end.
fn last_physical_line(bytes: &[u8]) -> &[u8] {
    let end = memrchr2(b'\n', b'\r', bytes);
    &bytes[end.map_or(0, |end| end + 1)..]
}

/// The first logical line: its length without its end and with it, and how many physical lines it has.
pub(super) fn first_line(bytes: &[u8]) -> (usize, usize, u32) {
    let (mut physical, mut lines) = (0, 1);
    while let Some(end) = memchr2(b'\n', b'\r', &bytes[physical..]) {
        let end = physical + end;
        let behind = end
            + if bytes[end..].starts_with(b"\r\n") {
                2
            } else {
                1
            };
        if !is_continued(&bytes[physical..end]) {
            return (end, behind, lines);
        }
        physical = behind;
        lines += 1;
    }
    (bytes.len(), bytes.len(), lines)
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
