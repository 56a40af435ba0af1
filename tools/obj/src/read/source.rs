//! Bytes to blocks of whole lines.
//!
//! A line ends with LF, CR LF or a lone CR, or with the file. A `\` before the end of a line,
//! blanks between them or not, joins the next line to it, unless a `#` comes first: a comment
//! such as `# C:\cloth\` must not swallow the statement after it. Blocks lie where the input has
//! them; only a line that goes on beyond what the input has is copied.

use std::io::{BufRead, ErrorKind};

use memchr::{memchr2, memrchr2};

use super::fault::{Fault, Line};
use crate::diagnostic::ReadError;
use crate::opening::Opening;
use crate::store::extend;

/// The most bytes of a block, but for a line that is longer.
const BLOCK: usize = 64 << 10;

/// The most bytes of a logical line. Real lines of some megabytes exist (a whole curve
/// in one statement); 64 MiB is the memory that even the smallest file may use.
const LINE_MAX: usize = 64 << 20;

/// The source of lines.
#[derive(Debug)]
pub(super) struct Source<R> {
    input: R,
    /// A line that goes on beyond what the input had, from its start.
    carried: Vec<u8>,
    /// How many bytes of the last block are to be dropped: carried ones if there are any, or the next
    /// of the input.
    handed_out: usize,
    exhausted: bool,
}

impl<R: BufRead> Source<R> {
    pub(super) fn new(input: R) -> Self {
        Source {
            input,
            carried: Vec::new(),
            handed_out: 0,
            exhausted: false,
        }
    }

    /// The first bytes: at least as many as an opening has, if there are that many.
    pub(super) fn first(&mut self) -> Result<&[u8], ReadError> {
        if self.carried.is_empty() && filled(&mut self.input)?.len() >= Opening::LENGTH {
            return filled(&mut self.input);
        }
        while self.carried.len() < Opening::LENGTH && !self.exhausted {
            self.carry()?;
        }
        Ok(&self.carried)
    }

    /// Drops bytes of the first ones.
    pub(super) fn skip(&mut self, count: usize) {
        self.handed_out = count;
        self.drop_block();
    }

    /// The next logical lines, each with a line end; the first one has this number. `None` at the end of
    /// the input.
    pub(super) fn block(&mut self, number: u32) -> Result<Option<&[u8]>, ReadError> {
        self.drop_block();
        if self.carried.is_empty() && !self.exhausted {
            let bytes = filled(&mut self.input)?;
            self.exhausted = bytes.is_empty();
            let length = whole_lines(&bytes[..bytes.len().min(BLOCK)], false);
            if length > 0 {
                self.handed_out = length;
                return Ok(Some(&filled(&mut self.input)?[..length]));
            }
        }
        loop {
            let length = whole_lines(&self.carried, self.exhausted);
            if length > 0 {
                self.handed_out = length;
                return Ok(Some(&self.carried[..length]));
            }
            if self.carried.len() > LINE_MAX {
                return Err(self.too_long(number));
            }
            if self.exhausted {
                return Ok(self.last_line());
            }
            self.carry()?;
        }
    }

    fn drop_block(&mut self) {
        let count = std::mem::take(&mut self.handed_out);
        if self.carried.is_empty() {
            self.input.consume(count);
        } else {
            self.carried.drain(..count);
        }
    }

    /// Copies what comes next, up to a line end if there is one; at least half as much as is carried, so
    /// that to look for the end of a long line takes no more than its length.
    fn carry(&mut self) -> Result<(), ReadError> {
        let goal = self.carried.len() + self.carried.len() / 2;
        let goal = goal.min(LINE_MAX + 1);
        loop {
            let bytes = filled(&mut self.input)?;
            let least = goal.saturating_sub(self.carried.len());
            let most = bytes.len().min(least.max(BLOCK));
            let before = least.min(most);
            let end = memchr2(b'\n', b'\r', &bytes[before..most]);
            let count = end.map_or(most, |end| before + end + 1);
            extend(&mut self.carried, &bytes[..count]);
            self.exhausted = count == 0;
            self.input.consume(count);
            if self.exhausted || self.carried.len() >= goal {
                return Ok(());
            }
        }
    }

    /// What is left where the file ends without a line end, with one.
    fn last_line(&mut self) -> Option<&[u8]> {
        let line = &mut self.carried;
        if line.is_empty() {
            return None;
        }
        // Behind a line end, what comes before is continued.
        if line.ends_with(b"\n") || line.ends_with(b"\r") || is_continued(last_physical_line(line))
        {
            // The file ends, so the `\` joins nothing to the line. It is dropped, since whatever is
            // written behind it would be joined.
            while let [.., b' ' | b'\t' | 0x0b | 0x0c | b'\r' | b'\n' | b'\\'] = line[..] {
                line.pop();
            }
        }
        line.push(b'\n');
        self.handed_out = line.len();
        Some(line)
    }

    #[cold]
    fn too_long(&self, number: u32) -> ReadError {
        let window = Line {
            bytes: &self.carried[..80],
            number,
        };
        let message = format!("this line is longer than {} MiB", LINE_MAX >> 20);
        let fault = Fault::new("E-OBJ-LINE", 0..0, message, "starts here");
        fault.help("is this an OBJ file?").at(&window)
    }
}

/// What the input has next. The end is met once: a terminal would ask for more.
fn filled(input: &mut impl BufRead) -> Result<&[u8], ReadError> {
    loop {
        match input.fill_buf() {
            Ok([]) => return Ok(&[]),
            Ok(_) => break,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(ReadError::Input(error)),
        }
    }
    // Again, since a borrow that is returned from a loop lasts for all of it.
    input.fill_buf().map_err(ReadError::Input)
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
