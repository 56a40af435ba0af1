//! Scripts as bytes: every byte string is one.

use std::ops::RangeInclusive;

use super::grammar::{Odds, Source};
use super::{Operation, Script, Shape};

/// The names of shapes, in the order of their codes.
const SHAPES: &str = "grid fan saddle tube torus tetrahedron octahedron grown glued";

/// The names of operations, by code. Further codes make most operations sound ones; tearing to pieces
/// ends what can happen, so it is rare.
const OPERATIONS: &str = "split/split/split/split/split/split/split/split repeated/split foreign/plane/\
    plane/plane/plane/cut/tear/clear/insert/merge/sew/slide";
const FURTHER: &str = "split/split/split/split/slide/plane/plane/cut by/cut by/insert/insert/insert/\
    merge/merge/sew";
const SELDOM: &str = "split repeated/split foreign/clear/sew";

/// The codes below this are those of shapes, again and again; those from here on say that one is taken apart.
const UNSEWN: u8 = 225;

/// The code of a shape, with which its bytes begin.
pub(super) fn shape_code(name: &str) -> Option<u8> {
    match SHAPES.split(' ').position(|shape| shape == name) {
        Some(code) => Some(code as u8),
        None => (name == "unsewn").then_some(UNSEWN),
    }
}

/// The code of an operation, with which its bytes begin.
pub(super) fn operation_code(name: &str) -> Option<u8> {
    let position = |names: &str| names.split('/').position(|known| known == name);
    match position(OPERATIONS) {
        Some(code) => Some(code as u8),
        None => position(FURTHER).map(|code| 32 + code as u8),
    }
}

impl Script {
    /// Decodes bytes as a script of at most [`Script::OPERATIONS_MAX`] operations on a mesh of at
    /// most a few hundred faces. Missing bytes count as zero. [`Script::to_bytes`] encodes a script.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Script {
        let mut bytes = Bytes(bytes);
        let shape = bytes.shape();
        let mut operations = Vec::new();
        while !bytes.0.is_empty() && operations.len() < Script::OPERATIONS_MAX {
            operations.push(bytes.operation());
        }
        Script { shape, operations }
    }
}

/// Returns scripts of up to [`Script::OPERATIONS_MAX`] operations. Shape and operations have bytes of
/// their own, so that a failing case shrinks by dropping operations; [`Script::shrink`] shrinks it further.
#[cfg(feature = "proptest")]
impl proptest::arbitrary::Arbitrary for Script {
    type Parameters = ();
    type Strategy = proptest::strategy::BoxedStrategy<Script>;

    fn arbitrary_with((): ()) -> Self::Strategy {
        use proptest::prelude::{Strategy as _, any, prop};
        let shape = prop::collection::vec(any::<u8>(), 0..=100);
        let shape = shape.prop_map(|bytes| Bytes(&bytes).shape());
        let operation = prop::array::uniform24(any::<u8>());
        let operation = operation.prop_map(|bytes| Bytes(&bytes).operation());
        let operations = prop::collection::vec(operation, 0..=Script::OPERATIONS_MAX);
        let script = |(shape, operations)| Script { shape, operations };
        (shape, operations).prop_map(script).boxed()
    }
}

/// Bytes to be read, followed by zeros without end.
struct Bytes<'b>(&'b [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let [first, rest @ ..] = self.0 else { return 0 };
        self.0 = rest;
        *first
    }

    fn shape(&mut self) -> Shape {
        if self.0.first().is_none_or(|&code| code < UNSEWN) {
            return self.inner_shape();
        }
        self.byte();
        Shape::read("unsewn", self).expect("a shape has this name")
    }

    fn operation(&mut self) -> Operation {
        let (names, at) = match usize::from(self.byte()) {
            code @ 0..20 => (OPERATIONS, code),
            code if code % 16 == 15 => (SELDOM, code / 16 % 4),
            code => (FURTHER, code % 16),
        };
        let name = names.split('/').nth(at);
        let operation = name.and_then(|name| Operation::read(name, self));
        operation.expect("every operation has a name")
    }
}

impl Source for Bytes<'_> {
    fn number(&mut self, limits: RangeInclusive<i128>, bytes: usize) -> i128 {
        let (least, most) = limits.into_inner();
        match i128::from(self.bits(bytes)) {
            // Below zero numbers begin where those above end, in two's complement.
            number if least < 0 && number > most => number + 2 * least,
            number if least < 0 => number,
            number => least + number % (most - least + 1),
        }
    }

    fn bits(&mut self, bytes: usize) -> u64 {
        (0..bytes).fold(0, |bits, i| bits | u64::from(self.byte()) << (8 * i))
    }

    fn choice(&mut self, words: &[&str], odds: &Odds, named: usize) -> usize {
        match odds {
            Odds::Named => named,
            Odds::Even => usize::from(self.byte()) % words.len(),
            Odds::Seldom => usize::from(self.byte() % 8 == 7),
            Odds::Ahead => usize::from(self.0.get(1).is_some_and(|&byte| byte >= 195)),
        }
    }

    fn list<T>(&mut self, most: usize, end: &str, item: fn(&mut Self) -> T) -> (Vec<T>, bool) {
        let byte = self.byte();
        let count = if end.is_empty() { byte } else { byte & 7 };
        let items = (0..usize::from(count) % (most + 1)).map(|_| item(self));
        (items.collect(), !end.is_empty() && byte >= 192)
    }

    fn filler(&mut self) {
        self.byte();
    }

    fn inner_shape(&mut self) -> Shape {
        let name = SHAPES.split(' ').nth(usize::from(self.byte() % 9));
        let shape = name.and_then(|name| Shape::read(name, self));
        shape.expect("every shape has a name")
    }
}
