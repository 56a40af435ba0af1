//! Scripts as text: the shape on the first line, then one operation a line.
//!
//! ```text
//! grid COLUMNS ROWS RISING | fan FACES | open-fan FACES | saddle | tube AROUND ALONG
//! torus AROUND ACROSS | tetrahedron SUBDIVISIONS | octahedron SUBDIVISIONS
//! grown MOVE … | glued FACES SIDE SIDE … | unsewn FACES SHAPE
//!
//! split VERTEX MASK [repeated NUMBER | foreign FACE]
//! plane VERTEX X Y Z
//! cut [METHOD] [through] [midpoint] [first] [snap NUMBER] [move] [seams] [far NUMBER] PATH
//! insert HALF-EDGE [SPOT …] [chord END END]
//! merge VERTEX COPY WEIGHT WEIGHT
//! merge any VERTEX VERTEX WEIGHT WEIGHT
//! slide VERTEX NEIGHBOUR PART
//! slide any VERTEX VERTEX PART
//! sew MASK
//! tear
//! clear
//!
//! SPOT: edge OFFSET PART | face OFFSET WEIGHT WEIGHT WEIGHT
//! METHOD: exact | uniform | alternating                           (otherwise partition)
//! PATH: ORIGIN DIRECTION ORIGIN DIRECTION                         (three numbers each, in units of 1/32)
//!     | skew ORIGIN TARGET ORIGIN TARGET                          (in units of the box around the mesh)
//!     | parallel DIRECTION TARGET TARGET | eye ORIGIN TARGET TARGET
//!     | converging ORIGIN ORIGIN TARGET | plane POINT NORMAL
//!     | continued ORIGIN TARGET | closed
//! ```
//!
//! Whole numbers may be decimal, `0x…` or `0b…`. What follows a `#` is a comment.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::{FromStr, SplitWhitespace};

use super::cut::{CutPath, CutSettings};
use super::grammar::{Odds, Source};
use super::{Fault, Operation, Script, Shape, Spot};
use crate::scissor::{CutLayers, CutMethod, CutTips};

impl fmt::Display for Script {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.shape)?;
        self.operations
            .iter()
            .try_for_each(|it| writeln!(f, "{it}"))
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shape::Grid {
                columns,
                rows,
                rising,
            } => write!(f, "grid {columns} {rows} {rising:#b}"),
            Shape::Fan { faces, closed } => {
                let open = if *closed { "" } else { "open-" };
                write!(f, "{open}fan {faces}")
            }
            Shape::Saddle => f.write_str("saddle"),
            Shape::Tube { around, along } => write!(f, "tube {around} {along}"),
            Shape::Torus { around, across } => write!(f, "torus {around} {across}"),
            Shape::Tetrahedron { subdivisions } => write!(f, "tetrahedron {subdivisions}"),
            Shape::Octahedron { subdivisions } => write!(f, "octahedron {subdivisions}"),
            Shape::Grown(moves) => numbers(f, "grown", moves),
            Shape::Glued { faces, sides } => {
                numbers(f, &format!("glued {faces}"), sides.as_flattened())
            }
            Shape::Unsewn { faces, shape } => write!(f, "unsewn {faces:#b} {shape}"),
        }
    }
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let any = |any: &bool| if *any { " any" } else { "" };
        match self {
            Operation::Split {
                vertex,
                mask,
                fault,
            } => {
                write!(f, "split {vertex} {mask:#b}")?;
                match fault {
                    Fault::None => Ok(()),
                    Fault::Repeated(face) => write!(f, " repeated {face}"),
                    Fault::Foreign(face) => write!(f, " foreign {face}"),
                }
            }
            Operation::Plane { vertex, normal } => numbers(f, &format!("plane {vertex}"), normal),
            Operation::Cut {
                path,
                far,
                settings,
            } => {
                write!(f, "cut{settings}")?;
                if *far > 0 {
                    write!(f, " far {far}")?;
                }
                path.fmt(f)
            }
            Operation::Insert {
                half_edge,
                spots,
                chord,
            } => {
                write!(f, "insert {half_edge}")?;
                for spot in spots {
                    match spot {
                        Spot::Edge { offset, part } => write!(f, " edge {offset} {part}")?,
                        Spot::Face { offset, weights } => {
                            numbers(f, &format!(" face {offset}"), weights)?;
                        }
                    }
                }
                let mut chord = chord.iter();
                chord.try_for_each(|[one, other]| write!(f, " chord {one} {other}"))
            }
            Operation::Merge {
                vertex,
                other,
                any: is_any,
                weights,
            } => {
                let name = format!("merge{} {vertex} {other}", any(is_any));
                numbers(f, &name, weights)
            }
            Operation::Slide {
                vertex,
                toward,
                any: is_any,
                part,
            } => write!(f, "slide{} {vertex} {toward} {part}", any(is_any)),
            Operation::Sew { mask } => write!(f, "sew {mask:#b}"),
            Operation::Tear => f.write_str("tear"),
            Operation::Clear => f.write_str("clear"),
        }
    }
}

/// Each word has a space before it.
impl fmt::Display for CutSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.method {
            CutMethod::Partition => "",
            CutMethod::Exact => " exact",
            CutMethod::Uniform => " uniform",
            CutMethod::Alternating => " alternating",
        })?;
        let is_first = self.layers == CutLayers::First;
        for (is_set, word) in [
            (self.through, " through"),
            (self.tips == CutTips::Midpoint, " midpoint"),
            (is_first, " first"),
        ] {
            f.write_str(if is_set { word } else { "" })?;
        }
        if let Some(snap) = self.snap {
            write!(f, " snap {snap}")?;
        }
        f.write_str(if self.snap_move { " move" } else { "" })?;
        f.write_str(if self.seams { " seams" } else { "" })
    }
}

/// Each word and number has a space before it.
impl fmt::Display for CutPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            CutPath::Rays(ref rays) => numbers(f, "", rays.as_flattened().as_flattened()),
            CutPath::Skew(ref rays) => numbers(f, " skew", rays.as_flattened().as_flattened()),
            CutPath::Parallel {
                direction: first,
                targets: [second, third],
            } => numbers(f, " parallel", [first, second, third].as_flattened()),
            CutPath::Eye {
                eye: first,
                targets: [second, third],
            } => numbers(f, " eye", [first, second, third].as_flattened()),
            CutPath::Converging {
                origins: [first, second],
                target: third,
            } => numbers(f, " converging", [first, second, third].as_flattened()),
            CutPath::Plane { point, normal } => {
                numbers(f, " plane", [point, normal].as_flattened())
            }
            CutPath::Continued(ref ray) => numbers(f, " continued", ray.as_flattened()),
            CutPath::Closed => f.write_str(" closed"),
        }
    }
}

fn numbers<N: fmt::Display>(f: &mut fmt::Formatter<'_>, name: &str, numbers: &[N]) -> fmt::Result {
    f.write_str(name)?;
    numbers.iter().try_for_each(|number| write!(f, " {number}"))
}

/// A word in the text of a script that could not be parsed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptError {
    /// The number of the line, counted from 1.
    pub line: usize,
    /// The word that could not be parsed, or an empty string at the end of the line.
    pub word: String,
    /// A description of the expected word.
    pub expected: String,
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, expected) = (self.line, &self.expected);
        match self.word.as_str() {
            "" => write!(f, "line {line} ends where {expected} was expected"),
            word => write!(f, "line {line}: {expected} was expected, not `{word}`"),
        }
    }
}

impl std::error::Error for ScriptError {}

impl FromStr for Script {
    type Err = ScriptError;

    fn from_str(text: &str) -> Result<Script, ScriptError> {
        let error = |line, (word, expected)| ScriptError {
            line,
            word,
            expected,
        };
        let mut shape = None;
        let mut operations = Vec::new();
        let mut end = 0;
        for line in text.lines() {
            end += 1;
            let mut line = Line::new(line.split('#').next().unwrap_or(""));
            let Some(first) = line.words.next() else {
                continue;
            };
            if shape.is_none() {
                shape = Shape::read(first, &mut line);
                if shape.is_none() {
                    line.refuse(first, "a shape");
                }
            } else if operations.len() == Script::OPERATIONS_MAX {
                line.refuse(first, "the end, after the largest number of operations,");
            } else if let Some(operation) = Operation::read(first, &mut line) {
                operations.push(operation);
            } else {
                line.refuse(first, "an operation");
            }
            if let Some(word) = line.words.next() {
                line.refuse(word, "the end of the line");
            }
            if let Some(wrong) = line.error {
                return Err(error(end, wrong));
            }
        }
        let missing = || error(end + 1, (String::new(), "a shape".to_owned()));
        let shape = shape.ok_or_else(missing)?;
        Ok(Script { shape, operations })
    }
}

/// A line that is read: the words that are left, and the first word that was wrong, with what was expected.
pub(super) struct Line<'t> {
    pub(super) words: SplitWhitespace<'t>,
    error: Option<(String, String)>,
}

impl<'t> Line<'t> {
    pub(super) fn new(text: &'t str) -> Line<'t> {
        let words = text.split_whitespace();
        Line { words, error: None }
    }

    fn refuse(&mut self, word: &str, expected: &str) {
        let error = (word.to_owned(), expected.to_owned());
        self.error.get_or_insert(error);
    }

    /// Takes the next words if they are these.
    pub(super) fn takes(&mut self, words: &str) -> bool {
        let mut ahead = self.words.clone();
        let found = words.split(' ').all(|word| ahead.next() == Some(word));
        if found {
            self.words = ahead;
        }
        found
    }

    /// Whether an item of a list is next, and neither the word after the list nor the end.
    pub(super) fn has_item(&self, end: &str) -> bool {
        let next = self.words.clone().next();
        next.is_some_and(|next| next != end)
    }
}

impl Source for Line<'_> {
    fn number(&mut self, limits: RangeInclusive<i128>, _: usize) -> i128 {
        let word = self.words.next().unwrap_or("");
        let number = match (word.strip_prefix("0x"), word.strip_prefix("0b")) {
            (Some(digits), _) => i128::from_str_radix(digits, 16),
            (_, Some(digits)) => i128::from_str_radix(digits, 2),
            _ => word.parse(),
        };
        let (least, most) = (*limits.start(), *limits.end());
        match number {
            Ok(number) if limits.contains(&number) => number,
            _ => {
                self.refuse(word, &format!("a number from {least} to {most}"));
                least
            }
        }
    }

    fn bits(&mut self, bytes: usize) -> u64 {
        self.number(0..=(1 << (8 * bytes)) - 1, bytes) as u64
    }

    fn choice(&mut self, words: &[&str], _: &Odds, named: usize) -> usize {
        // The longest first.
        let mut choices = words.iter().enumerate().rev();
        match choices.find(|(_, word)| !word.is_empty() && self.takes(word)) {
            Some((index, _)) => index,
            None if words[0].is_empty() => named,
            None => {
                let word = self.words.next().unwrap_or("").to_owned();
                self.refuse(&word, &words.join(" or "));
                named
            }
        }
    }

    fn list<T>(&mut self, most: usize, end: &str, item: fn(&mut Self) -> T) -> (Vec<T>, bool) {
        let mut items = Vec::new();
        while items.len() < most && self.has_item(end) {
            items.push(item(self));
        }
        (items, self.takes(end))
    }

    fn inner_shape(&mut self) -> Shape {
        let word = self.words.next().unwrap_or("");
        let sewn = (word != "unsewn").then(|| Shape::read(word, self));
        sewn.flatten().unwrap_or_else(|| {
            self.refuse(word, "a shape that is sewn");
            Shape::Saddle
        })
    }
}
