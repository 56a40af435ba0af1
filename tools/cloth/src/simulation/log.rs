//! The log of inputs, by which a simulation is made again to the byte.
//!
//! Results depend on the definition, and on which input came before which step, and on nothing
//! else. As text, a log is a line for each input: the number of steps taken before it, a verb, and
//! numbers in hexadecimal, those with a fraction as the bits of an `f64`. Wounds that heal or are let go are all without
//! a number, those of a cut by its number, and those of a seam by its number and 1.
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

use crate::digest;

/// The inputs of a [`Simulation`](super::Simulation), and the number of steps that it took.
/// [`Display`](fmt::Display) writes the log as text, and [`FromStr`] reads it.
///
/// ```
/// use tearmesh_cloth::{InputLog, Simulation, SimulationDef};
/// use tearmesh::{VertexId, shapes};
///
/// let (mesh, positions) = shapes::grid(4, 4);
/// let def = SimulationDef { is_recorded: true, ..SimulationDef::default() };
/// let mut sim = Simulation::new(mesh.clone(), &positions, def.clone())?;
/// sim.hold(VertexId::new(24))?;
/// sim.advance(0.1, 1000)?;
///
/// let log: InputLog = sim.log().ok_or("it is recorded")?.to_string().parse()?;
/// let again = Simulation::replayed(mesh, &positions, def, &log, |_, _| {})?;
/// assert_eq!(again.cloth().positions(), sim.cloth().positions());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
const VERBS: [&str; 11] = [
    "hold", "free", "grab", "lead", "release", "cut", "heal", "let_go", "unpick", "wind", "failed",
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
        let mut lines = text.lines();
        let digest = lines.next().and_then(|line| line.strip_prefix(HEAD));
        let digest = digest.ok_or(error(1, 1, HEAD))?;
        let mut words = words_of(digest, HEAD.len() + 1);
        let mut log = InputLog::new(number(1, words.next().unwrap_or_default())?);
        at_end(1, words)?;
        for line in 2.. {
            let text = lines.next().unwrap_or_default();
            let mut words = words_of(text, 1);
            let mut next = || words.next().unwrap_or((text.len() + 1, ""));
            let (column, word) = next();
            let step = word.parse().ok().filter(|step| *step >= log.steps);
            let expected = "a number of steps that does not descend";
            log.steps = step.ok_or(error(line, column, expected))?;
            let (column, word) = next();
            if word == "end" {
                at_end(line, words)?;
                break;
            }
            let verb = VERBS.into_iter().find(|verb| *verb == word);
            let verb = verb.ok_or(error(line, column, "a verb"))?;
            let numbers = words.map(|word| number(line, word));
            log.note(verb, numbers.collect::<Result<_, _>>()?);
        }
        match lines.next() {
            None => Ok(log),
            Some(_) => Err(error(log.records.len() + 3, 1, "the end of the log")),
        }
    }
}

fn error(line: usize, column: usize, expected: &'static str) -> LogError {
    LogError {
        line,
        column,
        expected,
    }
}

/// The words of a text that begins at a column, each with its own.
fn words_of(text: &str, column: usize) -> impl Iterator<Item = (usize, &str)> {
    text.split(' ').scan(column, |next, word| {
        let column = *next;
        *next += word.len() + 1;
        Some((column, word))
    })
}

fn number(line: usize, (column, word): (usize, &str)) -> Result<u64, LogError> {
    let is_digits = word.bytes().all(|byte| byte.is_ascii_hexdigit());
    let value = u64::from_str_radix(word, 16).ok().filter(|_| is_digits);
    let expected = "a number of up to 16 hexadecimal digits";
    value.ok_or(error(line, column, expected))
}

/// Refuses a line with further words.
fn at_end<'t>(
    line: usize,
    mut words: impl Iterator<Item = (usize, &'t str)>,
) -> Result<(), LogError> {
    match words.next() {
        None => Ok(()),
        Some((column, _)) => Err(error(line, column - 1, "the end of the line")),
    }
}

/// A digest of a mesh, its positions and a definition. The definition goes in as its `Debug` text, in which every number is told
/// from every other.
pub(super) fn digest(mesh: &Mesh, positions: &Positions, def: &impl fmt::Debug) -> u64 {
    let words = mesh.indices().iter().copied().chain(mesh.roots());
    let points = positions.as_slice().iter().flat_map(|p| [p.x, p.y, p.z]);
    let bytes = words.flat_map(u32::to_le_bytes);
    let bytes = bytes.chain(points.flat_map(f64::to_le_bytes));
    let bytes = bytes.chain(format!("{def:?}").into_bytes());
    digest::after(digest::EMPTY, bytes)
}
