//! The log of inputs, by which a simulation is made again to the byte.
//!
//! Results depend on the definition, and on which input came before which step, and on nothing
//! else. As text, a log is a line for each input: the number of steps taken before it, a verb, and
//! numbers in hexadecimal, those with a fraction as the bits of an `f64`.
//!
//! ```text
//! tearmesh inputs 1 digest 8c4bd54da2f1c0e3
//! 0 hold 110 111 112
//! 330 grab 5f 3fbeb851eb851eb8
//! 330 lead 0 3fe0000000000000 3fb999999999999a 0
//! 2000 end
//! ```

use std::fmt;
use std::str::FromStr;

use tearmesh::{Mesh, Positions};

/// The inputs of a [`Simulation`](super::Simulation), and the number of steps that it took.
/// [`Display`](fmt::Display) writes the log as text, and [`FromStr`] reads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputLog {
    /// Of the mesh and the definition.
    pub(super) digest: u64,
    pub(super) records: Vec<Record>,
    pub(super) steps: u64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Record {
    /// The number of steps taken before.
    pub(super) step: u64,
    /// One of [`VERBS`].
    pub(super) verb: &'static str,
    pub(super) words: Vec<u64>,
}

/// All inputs, and steps that failed, which leave their mark on what a method remembers.
const VERBS: [&str; 9] = [
    "hold", "free", "grab", "lead", "release", "cut", "heal", "wind", "failed",
];

const HEAD: &str = "tearmesh inputs 1 digest ";

impl InputLog {
    pub(super) fn new(digest: u64) -> InputLog {
        InputLog {
            digest,
            records: Vec::new(),
            steps: 0,
        }
    }

    pub(super) fn note(&mut self, verb: &'static str, words: Vec<u64>) {
        let step = self.steps;
        self.records.push(Record { step, verb, words });
    }
}

impl fmt::Display for InputLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{HEAD}{:016x}", self.digest)?;
        for Record { step, verb, words } in &self.records {
            write!(f, "{step} {verb}")?;
            words.iter().try_for_each(|word| write!(f, " {word:x}"))?;
            writeln!(f)?;
        }
        writeln!(f, "{} end", self.steps)
    }
}

/// The place where a text is not a log of inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogError {
    /// The line, from 1.
    pub line: usize,
    /// The column in bytes, from 1.
    pub column: usize,
    /// A description of what should stand there.
    pub expected: &'static str,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column, expected) = (self.line, self.column, self.expected);
        write!(f, "line {line}, column {column}: expected {expected}")
    }
}

impl std::error::Error for LogError {}

impl FromStr for InputLog {
    type Err = LogError;

    fn from_str(text: &str) -> Result<InputLog, LogError> {
        let (mut lines, mut number) = (text.lines(), 0);
        let mut next = || {
            number += 1;
            let text = lines.next().unwrap_or_default();
            Line {
                number,
                text,
                read: 0,
            }
        };
        let mut line = next();
        if !line.text.starts_with(HEAD) {
            return Err(line.error(HEAD));
        }
        line.read = HEAD.len();
        let mut log = InputLog::new(line.number()?);
        line.end()?;
        loop {
            let mut line = next();
            let ascends = |step: &u64| *step >= log.steps;
            let step = |word: &str| word.parse().ok().filter(ascends);
            log.steps = line.word("a number of steps that does not descend", step)?;
            let is = |word: &str| VERBS.into_iter().chain(["end"]).find(|verb| *verb == word);
            let verb = line.word("a verb", is)?;
            if verb == "end" {
                line.end()?;
                break;
            }
            let mut words = Vec::new();
            while line.end().is_err() {
                words.push(line.number()?);
            }
            log.note(verb, words);
        }
        match text.lines().nth(log.records.len() + 2) {
            None => Ok(log),
            Some(_) => Err(next().error("the end of the log")),
        }
    }
}

/// A line that is read from left to right.
struct Line<'t> {
    number: usize,
    text: &'t str,
    /// Where the next word begins: after a space, or one beyond the end.
    read: usize,
}

impl Line<'_> {
    /// Reads a word, and the space after it.
    fn word<T>(
        &mut self,
        expected: &'static str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<T, LogError> {
        let rest = self.text.get(self.read..).unwrap_or_default();
        let word = rest.split(' ').next().unwrap_or_default();
        let value = read(word).ok_or(self.error(expected))?;
        self.read += word.len() + 1;
        Ok(value)
    }

    fn number(&mut self) -> Result<u64, LogError> {
        let is_digits = |word: &&str| word.bytes().all(|byte| byte.is_ascii_hexdigit());
        let hex = |word: &str| u64::from_str_radix(Some(word).filter(is_digits)?, 16).ok();
        self.word("a number of up to 16 hexadecimal digits", hex)
    }

    /// Refuses a line with further words.
    fn end(&self) -> Result<(), LogError> {
        let is_over = self.read > self.text.len();
        let error = LogError {
            column: self.read,
            ..self.error("the end of the line")
        };
        is_over.then_some(()).ok_or(error)
    }

    fn error(&self, expected: &'static str) -> LogError {
        LogError {
            line: self.number,
            column: self.read.min(self.text.len()) + 1,
            expected,
        }
    }
}

/// A digest of a mesh, its positions and a definition (the 64 bits of FNV-1a). It tells apart what
/// differs by accident. The definition goes in as its `Debug` text, in which every number is told
/// from every other.
pub(super) fn digest(mesh: &Mesh, positions: &Positions, def: &impl fmt::Debug) -> u64 {
    let words = mesh.indices().iter().copied().chain(mesh.roots());
    let points = positions.as_slice().iter().flat_map(|p| [p.x, p.y, p.z]);
    let bytes = words.flat_map(u32::to_le_bytes);
    let bytes = bytes.chain(points.flat_map(f64::to_le_bytes));
    let bytes = bytes.chain(format!("{def:?}").into_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
