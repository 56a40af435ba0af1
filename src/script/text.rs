//! Scripts as text: the shape on the first line, then one operation a line.
//!
//! ```text
//! grid COLUMNS ROWS RISING | fan FACES | open-fan FACES | saddle | tube AROUND ALONG
//! torus AROUND ACROSS | tetrahedron SUBDIVISIONS | octahedron SUBDIVISIONS
//! grown MOVE … | glued FACES SIDE SIDE …
//!
//! split VERTEX MASK [repeated NUMBER | foreign FACE]
//! plane VERTEX X Y Z
//! cut [through] [midpoint] ORIGIN DIRECTION ORIGIN DIRECTION      (three numbers each)
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
//! ```
//!
//! Whole numbers may be decimal, `0x…` or `0b…`. What follows a `#` is a comment.

use std::fmt;
use std::mem::discriminant;
use std::ops::RangeInclusive;
use std::str::{FromStr, SplitWhitespace};

use super::grammar::{Choice, Parts};
use super::{Operation, Script, Shape};

impl fmt::Display for Script {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.shape)?;
        for operation in &self.operations {
            writeln!(f, "{operation}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blanks = Shape::blanks();
        let name = match self {
            Shape::Fan { closed: false, .. } => "open-fan",
            _ => name_of(self, blanks.iter().map(|(name, blank)| (*name, blank))),
        };
        let mut words = Writer(name.into());
        self.clone().parts(&mut words);
        f.write_str(&words.0)
    }
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blanks = Operation::blanks();
        let name = name_of(self, blanks.iter().map(|(name, _, blank)| (*name, blank)));
        let mut words = Writer(name.into());
        self.clone().parts(&mut words);
        f.write_str(&words.0)
    }
}

fn name_of<'b, T: 'b>(
    it: &T,
    mut blanks: impl Iterator<Item = (&'static str, &'b T)>,
) -> &'static str {
    let blank = blanks.find(|(_, blank)| discriminant(*blank) == discriminant(it));
    blank.expect("every kind has a blank").0
}

/// A line that is written.
struct Writer(String);

impl Writer {
    fn word(&mut self, word: &str) {
        self.0 += " ";
        self.0 += word;
    }
}

impl Parts for Writer {
    fn number(&mut self, number: i128, _: RangeInclusive<i128>, _: usize) -> i128 {
        self.word(&number.to_string());
        number
    }

    fn bits(&mut self, bits: i128, _: usize) -> i128 {
        self.word(&format!("{bits:#b}"));
        bits
    }

    fn choice(&mut self, chosen: &mut usize, choice: &Choice) {
        let word = choice.words.get(*chosen).filter(|word| !word.is_empty());
        word.into_iter().for_each(|word| self.word(word));
    }

    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        _: usize,
        _: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    ) {
        list.iter_mut().for_each(|it| item(self, it));
        if let Some((word, true)) = more.map(|(word, is_more)| (word, *is_more)) {
            self.word(word);
        }
    }
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
        let Self {
            line,
            word,
            expected,
        } = self;
        if word.is_empty() {
            write!(f, "line {line} ends where {expected} was expected")
        } else {
            write!(f, "line {line}: {expected} was expected, not `{word}`")
        }
    }
}

impl std::error::Error for ScriptError {}

impl FromStr for Script {
    type Err = ScriptError;

    fn from_str(text: &str) -> Result<Script, ScriptError> {
        let mut shape = None;
        let mut operations = Vec::new();
        let mut end = 0;
        for (i, line) in text.lines().enumerate() {
            end = i + 1;
            let words = line.split('#').next().unwrap_or("").split_whitespace();
            let mut line = Line { words, error: None };
            let Some(first) = line.words.next() else {
                continue;
            };
            if shape.is_none() {
                let mut blanks = Shape::blanks().into_iter();
                match blanks.find(|&(name, _)| name == first) {
                    Some((_, blank)) => shape.insert(blank).parts(&mut line),
                    None => line.refuse(first, "a shape"),
                }
            } else if operations.len() < Script::OPERATIONS_MAX {
                let mut blanks = Operation::blanks().into_iter();
                match blanks.find(|&(name, ..)| name == first) {
                    Some((.., mut operation)) => {
                        operation.parts(&mut line);
                        operations.push(operation);
                    }
                    None => line.refuse(first, "an operation"),
                }
            } else {
                line.refuse(first, "the end, after the largest number of operations,");
            }
            if let Some(word) = line.words.next() {
                line.refuse(word, "the end of the line");
            }
            if let Some((word, expected)) = line.error {
                return Err(ScriptError {
                    line: end,
                    word,
                    expected,
                });
            }
        }
        let error = ScriptError {
            line: end + 1,
            word: String::new(),
            expected: "a shape".into(),
        };
        let shape = shape.ok_or(error)?;
        Ok(Script { shape, operations })
    }
}

/// A line that is read: the words that are left, and the first word that was wrong, with what was expected.
struct Line<'t> {
    words: SplitWhitespace<'t>,
    error: Option<(String, String)>,
}

impl Line<'_> {
    fn refuse(&mut self, word: &str, expected: &str) {
        let error = (word.to_owned(), expected.to_owned());
        self.error.get_or_insert(error);
    }

    /// Takes the next words if they are these.
    fn takes(&mut self, words: &str) -> bool {
        let mut ahead = self.words.clone();
        let found = words.split(' ').all(|word| ahead.next() == Some(word));
        if found {
            self.words = ahead;
        }
        found
    }
}

impl Parts for Line<'_> {
    fn number(&mut self, _: i128, limits: RangeInclusive<i128>, _: usize) -> i128 {
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

    fn bits(&mut self, bits: i128, bytes: usize) -> i128 {
        self.number(bits, 0..=(1 << (8 * bytes)) - 1, bytes)
    }

    fn choice(&mut self, chosen: &mut usize, choice: &Choice) {
        // The longest first.
        let words = choice.words.iter().enumerate().rev();
        let mut words = words.filter(|(_, word)| !word.is_empty());
        match words.find(|(_, word)| self.takes(word)) {
            Some((index, _)) => *chosen = index,
            None if choice.words.first().is_none_or(|word| word.is_empty()) => {}
            None => {
                let word = self.words.next().unwrap_or("").to_owned();
                self.refuse(&word, &choice.words.join(" or "));
            }
        }
    }

    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        most: usize,
        blank: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    ) {
        let word = more.as_ref().map(|&(word, _)| word);
        let next = |line: &Self| line.words.clone().next();
        while list.len() < most && next(self).is_some() && next(self) != word {
            let mut it = blank.clone();
            item(self, &mut it);
            list.push(it);
        }
        if let Some((word, is_more)) = more {
            *is_more = self.takes(word);
        }
    }
}
