//! The log of inputs, by which a simulation is made again to the byte.
//!
//! Results depend on the definition, and on which input came before which step, and on nothing
//! else. As text, a log is a line for each input: the number of steps taken before it, a verb, and
//! numbers in hexadecimal, those with a fraction as the bits of an `f64`.
//!
//! ```text
//! tearmesh inputs 1
//! digest 8c4bd54da2f1c0e3
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
    /// The digest of the mesh and the definition.
    pub(super) digest: u64,
    pub(super) records: Vec<Record>,
    pub(super) steps: u64,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Record {
    /// The number of steps taken before.
    pub(super) step: u64,
    pub(super) verb: Verb,
    pub(super) words: Vec<u64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verb {
    Hold,
    Free,
    Grab,
    Lead,
    Release,
    Cut,
    Heal,
    /// Not an input, but a step that failed: it leaves its mark on what a method remembers.
    Failed,
}

const HEAD: &str = "tearmesh inputs 1";

/// The verbs as text.
const VERBS: [(&str, Verb); 8] = [
    ("hold", Verb::Hold),
    ("free", Verb::Free),
    ("grab", Verb::Grab),
    ("lead", Verb::Lead),
    ("release", Verb::Release),
    ("cut", Verb::Cut),
    ("heal", Verb::Heal),
    ("failed", Verb::Failed),
];

impl InputLog {
    pub(super) fn new(digest: u64) -> InputLog {
        InputLog {
            digest,
            records: Vec::new(),
            steps: 0,
        }
    }

    pub(super) fn note(&mut self, verb: Verb, words: impl IntoIterator<Item = u64>) {
        self.records.push(Record {
            step: self.steps,
            verb,
            words: words.into_iter().collect(),
        });
    }

    /// Returns the number of inputs, with the steps that failed.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Returns whether there was no input.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Returns the number of steps that the simulation took.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }
}

impl fmt::Display for InputLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{HEAD}\ndigest {:016x}", self.digest)?;
        for Record { step, verb, words } in &self.records {
            let named = VERBS.iter().find(|(_, of)| of == verb);
            write!(f, "{step} {}", named.map_or("", |(name, _)| name))?;
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
    /// What should stand there.
    pub expected: &'static str,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let LogError {
            line,
            column,
            expected,
        } = self;
        write!(f, "line {line}, column {column}: expected {expected}")
    }
}

impl std::error::Error for LogError {}

impl FromStr for InputLog {
    type Err = LogError;

    fn from_str(text: &str) -> Result<InputLog, LogError> {
        let mut lines = text.lines();
        if lines.next() != Some(HEAD) {
            return Err(Line::new(1, None).error("`tearmesh inputs 1`"));
        }
        let mut line = Line::new(2, lines.next());
        line.word("`digest`", |word| (word == "digest").then_some(()))?;
        let mut log = InputLog::new(line.word(HEX, hex)?);
        line.ended()?;
        for number in 3.. {
            let mut line = Line::new(number, lines.next());
            let last = log.steps;
            let step = |word: &str| word.parse().ok().filter(|&step| step >= last);
            log.steps = line.word("a number of steps that does not descend", step)?;
            let verb = line.word("a verb", |word| match word {
                "end" => Some(None),
                _ => Some(Some(VERBS.iter().find(|(name, _)| *name == word)?.1)),
            })?;
            let Some(verb) = verb else {
                line.ended()?;
                break;
            };
            let mut words = Vec::new();
            while !line.is_over() {
                words.push(line.word(HEX, hex)?);
            }
            log.note(verb, words);
        }
        match lines.next() {
            None => Ok(log),
            Some(_) => Err(LogError {
                line: log.len() + 4,
                column: 1,
                expected: "the end of the log",
            }),
        }
    }
}

const HEX: &str = "a number of up to 16 hexadecimal digits";

fn hex(word: &str) -> Option<u64> {
    let is_digits = word.bytes().all(|byte| byte.is_ascii_hexdigit());
    u64::from_str_radix(word, 16).ok().filter(|_| is_digits)
}

/// A line that is read word by word.
struct Line<'t> {
    number: usize,
    text: &'t str,
    /// The bytes that were read.
    read: usize,
}

impl<'t> Line<'t> {
    /// A line of a text that may have ended: then it is empty.
    fn new(number: usize, text: Option<&'t str>) -> Line<'t> {
        Line {
            number,
            text: text.unwrap_or_default(),
            read: 0,
        }
    }

    fn is_over(&self) -> bool {
        self.read >= self.text.len()
    }

    /// Reads a word; words are parted by one space.
    fn word<T>(
        &mut self,
        expected: &'static str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<T, LogError> {
        let rest = self.text.get(self.read..).unwrap_or_default();
        let word = rest.split(' ').next().unwrap_or_default();
        let found = read(word).ok_or(self.error(expected))?;
        self.read += word.len() + 1;
        Ok(found)
    }

    fn ended(&self) -> Result<(), LogError> {
        let error = self.error("the end of the line");
        self.is_over().then_some(()).ok_or(error)
    }

    fn error(&self, expected: &'static str) -> LogError {
        LogError {
            line: self.number,
            column: self.read + 1,
            expected,
        }
    }
}

/// A digest of a mesh, its positions and a definition (the 64 bits of FNV-1a). It tells apart what
/// differs by accident. The definition goes in as its `Debug` text, in which every number is told
/// from every other.
pub(super) fn digest(mesh: &Mesh, positions: &Positions, def: &impl fmt::Debug) -> u64 {
    let words = mesh.indices().iter().copied().chain(mesh.roots());
    let words = words.flat_map(u32::to_le_bytes);
    let points = positions.as_slice().iter();
    let places = points
        .flat_map(|p| [p.x, p.y, p.z])
        .flat_map(|x| x.to_bits().to_le_bytes());
    let text = format!("{def:?}").into_bytes();
    let bytes = words.chain(places).chain(text);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
