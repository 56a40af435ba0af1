//! Writing scripts as bytes.

use std::ops::RangeInclusive;

use super::bytes::{operation_code, shape_code};
use super::cut::{CutPath, CutSettings};
use super::grammar::{Odds, Source};
use super::text::Line;
use super::{Fault, Operation, Script, Shape};
use crate::scissor::CutMethod;

impl Script {
    /// Encodes the script, so that a fuzzer can start from it.
    ///
    /// [`Script::from_bytes`] returns the same script if it has no more than [`Script::OPERATIONS_MAX`]
    /// operations, and its numbers are within the limits that their fields name.
    ///
    /// ```
    /// use tearmesh::script::Script;
    ///
    /// let script: Script = "grid 3 3 0b101\nsplit 5 0b11\ncut exact plane 0 0 0 1 2 0".parse()?;
    /// assert_eq!(Script::from_bytes(&script.to_bytes()), script);
    /// # Ok::<(), tearmesh::script::ScriptError>(())
    /// ```
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let shape = self.shape.to_string();
        let mut writer = Writer {
            line: Line::new(&shape),
            bytes: Vec::new(),
        };
        writer.inner_shape();
        let mut bytes = writer.bytes;
        for operation in &self.operations {
            let text = operation.to_string();
            let name = name_of(operation, &text);
            let mut writer = Writer {
                line: Line::new(&text),
                bytes: operation_code(name).into_iter().collect(),
            };
            writer.line.words.next();
            Operation::read(name, &mut writer);
            bytes.extend(writer.bytes);
        }
        bytes
    }
}

/// The name of an operation in bytes, of which `text` has a part.
fn name_of<'t>(operation: &Operation, text: &'t str) -> &'t str {
    match operation {
        Operation::Split { fault, .. } => match fault {
            Fault::None => "split",
            Fault::Repeated(_) => "split repeated",
            Fault::Foreign(_) => "split foreign",
        },
        Operation::Cut {
            path,
            far,
            settings,
        } => {
            let plain = CutSettings {
                method: CutMethod::Partition,
                through: settings.through,
                tips: settings.tips,
                ..CutSettings::default()
            };
            let is_plain = *settings == plain && *far == 0 && matches!(path, CutPath::Rays(_));
            if is_plain { "cut" } else { "cut by" }
        }
        _ => text.split(' ').next().expect("a line has a name"),
    }
}

/// A line of text that is read, and the bytes for what was read of it.
struct Writer<'t> {
    line: Line<'t>,
    bytes: Vec<u8>,
}

impl Source for Writer<'_> {
    fn number(&mut self, limits: RangeInclusive<i128>, bytes: usize) -> i128 {
        let number = self.line.number(limits.clone(), bytes);
        let code = number - limits.start().max(&0);
        self.bytes.extend(&code.to_le_bytes()[..bytes]);
        number
    }

    fn bits(&mut self, bytes: usize) -> u64 {
        let bits = self.line.bits(bytes);
        self.bytes.extend(&bits.to_le_bytes()[..bytes]);
        bits
    }

    fn choice(&mut self, words: &[&str], odds: &Odds, named: usize) -> usize {
        let index = self.line.choice(words, odds, named);
        match odds {
            Odds::Named | Odds::Ahead => {}
            Odds::Even => self.bytes.push(index as u8),
            Odds::Seldom => self.bytes.push([0, 7][index]),
        }
        index
    }

    fn list<T>(&mut self, most: usize, end: &str, item: fn(&mut Self) -> T) -> (Vec<T>, bool) {
        let at = self.bytes.len();
        self.bytes.push(0);
        let mut items = Vec::new();
        while items.len() < most && self.line.has_item(end) {
            items.push(item(self));
        }
        let ends = self.line.takes(end);
        self.bytes[at] = items.len() as u8 | if ends { 192 } else { 0 };
        (items, ends)
    }

    fn filler(&mut self) {
        self.bytes.push(u8::MAX);
    }

    fn inner_shape(&mut self) -> Shape {
        let name = self.line.words.next().unwrap_or("");
        let coded = if name == "open-fan" { "fan" } else { name };
        self.bytes.extend(shape_code(coded));
        Shape::read(name, self).expect("every shape has a name")
    }
}
