//! Scripts as bytes: every byte string is one.

use std::mem::discriminant;
use std::ops::RangeInclusive;

use super::grammar::{Choice, ChoiceBytes, Parts};
use super::{Fault, Operation, Script, Shape};

impl Script {
    /// Decodes bytes as a script of at most [`Script::OPERATIONS_MAX`] operations on a mesh of at
    /// most a few hundred faces. Missing bytes count as zero.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Script {
        let mut bytes = Reader(bytes);
        let code = usize::from(bytes.byte() % 9);
        let (_, mut shape) = Shape::blanks()[code].clone();
        shape.parts(&mut bytes);
        let mut operations = Vec::new();
        while !bytes.0.is_empty() && operations.len() < Script::OPERATIONS_MAX {
            operations.push(bytes.operation());
        }
        Script { shape, operations }
    }

    /// Encodes this script as bytes from which [`Script::from_bytes`] restores it, if it came from
    /// bytes or text. Numbers that exceed the limits of a [`Shape`] are not restored.
    #[expect(
        clippy::missing_panics_doc,
        reason = "only a bug of ours can trip the expectation"
    )]
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let Script {
            mut shape,
            operations,
        } = self.clone();
        let is_shape = |(_, blank): &(_, Shape)| discriminant(blank) == discriminant(&shape);
        let code = Shape::blanks().iter().position(is_shape);
        let mut bytes = Writer(vec![code.expect("every shape has a blank") as u8]);
        shape.parts(&mut bytes);
        for mut operation in operations {
            bytes.0.push(code_of(&operation));
            operation.parts(&mut bytes);
        }
        bytes.0
    }
}

#[cfg(feature = "arbitrary")]
impl<'a> arbitrary::Arbitrary<'a> for Script {
    fn arbitrary(unstructured: &mut arbitrary::Unstructured<'a>) -> arbitrary::Result<Script> {
        let bytes = unstructured.arbitrary_len::<u8>()?;
        unstructured.bytes(bytes).map(Script::from_bytes)
    }

    fn arbitrary_take_rest(unstructured: arbitrary::Unstructured<'a>) -> arbitrary::Result<Script> {
        Ok(Script::from_bytes(unstructured.take_rest()))
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
        let operation = prop::array::uniform16(any::<u8>());
        let operations = prop::collection::vec(operation, 0..=Script::OPERATIONS_MAX);
        let script = (shape, operations).prop_map(|(shape, operations)| {
            let operations = operations.iter().map(|bytes| Reader(bytes).operation());
            Script {
                shape: Script::from_bytes(&shape).shape,
                operations: operations.collect(),
            }
        });
        script.boxed()
    }
}

fn code_of(operation: &Operation) -> u8 {
    let fault = |operation: &Operation| match operation {
        Operation::Split { fault, .. } => Some(discriminant::<Fault>(fault)),
        _ => None,
    };
    let kind = |operation: &Operation| (discriminant(operation), fault(operation));
    let blanks = Operation::blanks();
    let blank = blanks.iter().find(|(.., it)| kind(it) == kind(operation));
    blank.expect("every operation has a blank").1
}

/// Bytes to be read, followed by zeros without end.
struct Reader<'b>(&'b [u8]);

impl Reader<'_> {
    fn byte(&mut self) -> u8 {
        let [first, rest @ ..] = self.0 else { return 0 };
        self.0 = rest;
        *first
    }

    fn operation(&mut self) -> Operation {
        // Codes up to 19 are themselves, and of these are the ones that are written. The others make
        // most operations sound ones; tearing to pieces ends what can happen, so it is rare.
        const OFTEN: [u8; 15] = [0, 0, 0, 0, 19, 9, 9, 9, 13, 16, 16, 16, 17, 17, 18];
        const SELDOM: [u8; 4] = [7, 8, 15, 18];
        let code = match self.byte() {
            code @ 0..=19 => code,
            code if code % 16 == 15 => SELDOM[usize::from(code / 16) % SELDOM.len()],
            code => OFTEN[usize::from(code % 16)],
        };
        let mut blanks = Operation::blanks().into_iter().rev();
        let blank = blanks.find(|&(_, least, _)| least <= code);
        let (.., mut operation) = blank.expect("the least code is 0");
        operation.parts(self);
        operation
    }
}

impl Parts for Reader<'_> {
    fn number(&mut self, _: i128, limits: RangeInclusive<i128>, bytes: usize) -> i128 {
        let (least, most) = limits.into_inner();
        match self.bits(0, bytes) {
            // Below zero numbers begin where those above end, in two's complement.
            number if least < 0 && number > most => number + 2 * least,
            number if least < 0 => number,
            number => least + number % (most - least + 1),
        }
    }

    fn bits(&mut self, _: i128, bytes: usize) -> i128 {
        (0..bytes).fold(0, |bits, i| bits | i128::from(self.byte()) << (8 * i))
    }

    fn choice(&mut self, chosen: &mut usize, choice: &Choice) {
        *chosen = match choice.bytes {
            ChoiceBytes::Code => *chosen,
            ChoiceBytes::Modulo(count) => usize::from(self.byte() % count),
            ChoiceBytes::Seldom => usize::from(self.byte() % 8 == 7),
            ChoiceBytes::Ahead => usize::from(self.0.get(1).is_some_and(|&byte| byte >= 195)),
        };
    }

    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        most: usize,
        blank: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    ) {
        let byte = self.byte();
        let count = match more {
            None => byte,
            Some((_, is_more)) => {
                *is_more = byte >= 192;
                byte & 7
            }
        };
        list.resize(usize::from(count) % (most + 1), blank);
        list.iter_mut().for_each(|it| item(self, it));
    }

    fn filler(&mut self) {
        self.byte();
    }
}

/// Bytes that were written.
struct Writer(Vec<u8>);

impl Parts for Writer {
    fn number(&mut self, number: i128, limits: RangeInclusive<i128>, bytes: usize) -> i128 {
        self.bits(number - (*limits.start()).max(0), bytes);
        number
    }

    fn bits(&mut self, bits: i128, bytes: usize) -> i128 {
        self.0.extend(&bits.to_le_bytes()[..bytes]);
        bits
    }

    fn choice(&mut self, chosen: &mut usize, choice: &Choice) {
        match choice.bytes {
            ChoiceBytes::Modulo(_) => self.0.push(*chosen as u8),
            ChoiceBytes::Seldom => self.0.push(7 * *chosen as u8),
            ChoiceBytes::Code | ChoiceBytes::Ahead => {}
        }
    }

    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        _: usize,
        _: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    ) {
        let is_more = more.is_some_and(|(_, is_more)| *is_more);
        self.0
            .push(list.len() as u8 | if is_more { 192 } else { 0 });
        list.iter_mut().for_each(|it| item(self, it));
    }

    fn filler(&mut self) {
        self.0.push(255);
    }
}
