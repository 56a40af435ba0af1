//! The grammar of scripts: the parts of a shape and of an operation, in their order, and from which
//! number to which each goes.
//!
//! Bytes, text and shrinking say what to do with a part, and go through all of them here. To read is
//! to start from a blank of the kind, and to set its parts.

use std::ops::RangeInclusive;

use super::{Fault, GROWN_MAX, Operation, SPOTS_MAX, Shape, Spot};
use crate::scissor::CutTips;

/// What to do with the parts of a script.
pub(super) trait Parts {
    /// A number in these limits, which takes this many bytes; returns what to put in its place.
    fn number(&mut self, number: i128, limits: RangeInclusive<i128>, bytes: usize) -> i128;

    /// A set of bits in this many bytes; returns what to put in its place.
    fn bits(&mut self, bits: i128, bytes: usize) -> i128;

    /// The index of an alternative, of which the first may go without a word.
    fn choice(&mut self, chosen: &mut usize, choice: &Choice);

    /// A list of at most `most` items, and whether there is more, which begins with a word.
    fn list<T: Clone>(
        &mut self,
        list: &mut Vec<T>,
        most: usize,
        blank: T,
        more: Option<(&'static str, &mut bool)>,
        item: impl Fn(&mut Self, &mut T),
    );

    /// A byte that says nothing more.
    fn filler(&mut self) {}

    fn within<N: Number>(&mut self, part: &mut N, limits: RangeInclusive<i128>) {
        let number = self.number((*part).into(), limits, size_of::<N>());
        *part = N::try_from(number).unwrap_or(*part);
    }

    fn any<N: Number>(&mut self, part: &mut N) {
        self.within(part, N::limits());
    }

    fn mask<N: Number>(&mut self, part: &mut N) {
        let bits = self.bits((*part).into(), size_of::<N>());
        *part = N::try_from(bits).unwrap_or(*part);
    }

    fn flag(&mut self, part: &mut bool, choice: &Choice) {
        let mut chosen = usize::from(*part);
        self.choice(&mut chosen, choice);
        *part = chosen == 1;
    }
}

/// A whole number.
pub(super) trait Number: Copy + Into<i128> + TryFrom<i128> {
    fn limits() -> RangeInclusive<i128> {
        let bits = 8 * size_of::<Self>();
        match Self::try_from(-1) {
            Ok(_) => -(1 << (bits - 1))..=(1 << (bits - 1)) - 1,
            Err(_) => 0..=(1 << bits) - 1,
        }
    }
}

impl<N: Copy + Into<i128> + TryFrom<i128>> Number for N {}

/// Alternatives, by the words that text has for them, and how bytes choose.
pub(super) struct Choice {
    pub(super) words: &'static [&'static str],
    pub(super) bytes: ChoiceBytes,
}

pub(super) enum ChoiceBytes {
    /// The code of the operation has decided already.
    Code,
    /// A byte, modulo the number of alternatives.
    Modulo(u8),
    /// A byte, which chooses the second alternative with its three lowest bits set.
    Seldom,
    /// The byte after the next one: the second alternative from 195 on.
    Ahead,
}

const CLOSED: Choice = Choice {
    words: &[],
    bytes: ChoiceBytes::Modulo(2),
};
const FAULT: Choice = Choice {
    words: &["", "repeated", "foreign"],
    bytes: ChoiceBytes::Code,
};
const ENDS: Choice = Choice {
    words: &["", "through", "midpoint", "through midpoint"],
    bytes: ChoiceBytes::Modulo(4),
};
const ANY: Choice = Choice {
    words: &["", "any"],
    bytes: ChoiceBytes::Seldom,
};
const SPOT: Choice = Choice {
    words: &["edge", "face"],
    bytes: ChoiceBytes::Ahead,
};

/// The offsets of spots: the half-edges of four faces.
const OFFSETS: RangeInclusive<i128> = 0..=11;

/// Sixty-fourths.
const PARTS: RangeInclusive<i128> = 0..=64;

impl Shape {
    /// The names of shapes, each with a blank; in the order of their codes, and then another name.
    pub(super) fn blanks() -> [(&'static str, Shape); 10] {
        let fan = |closed| Shape::Fan { faces: 3, closed };
        let [columns, rows, around, across, along, faces, subdivisions] = [1, 1, 3, 3, 1, 1, 0];
        let grid = Shape::Grid {
            columns,
            rows,
            rising: 0,
        };
        let sides = Vec::new();
        [
            ("grid", grid),
            ("fan", fan(true)),
            ("saddle", Shape::Saddle),
            ("tube", Shape::Tube { around, along }),
            ("torus", Shape::Torus { around, across }),
            ("tetrahedron", Shape::Tetrahedron { subdivisions }),
            ("octahedron", Shape::Octahedron { subdivisions }),
            ("grown", Shape::Grown(Vec::new())),
            ("glued", Shape::Glued { faces, sides }),
            ("open-fan", fan(false)),
        ]
    }

    pub(super) fn parts(&mut self, parts: &mut impl Parts) {
        match self {
            Shape::Grid {
                columns,
                rows,
                rising,
            } => {
                parts.within(columns, 1..=5);
                parts.within(rows, 1..=5);
                parts.mask(rising);
            }
            Shape::Fan { faces, closed } => {
                parts.within(faces, 3..=16);
                parts.flag(closed, &CLOSED);
            }
            Shape::Saddle => {}
            Shape::Tube { around, along } => {
                parts.within(around, 3..=8);
                parts.within(along, 1..=4);
            }
            Shape::Torus { around, across } => {
                parts.within(around, 3..=5);
                parts.within(across, 3..=5);
            }
            Shape::Tetrahedron { subdivisions } | Shape::Octahedron { subdivisions } => {
                parts.within(subdivisions, 0..=1);
            }
            Shape::Grown(moves) => parts.list(moves, GROWN_MAX, 0, None, Parts::any),
            Shape::Glued { faces, sides } => {
                parts.within(faces, 1..=24);
                parts.list(sides, GROWN_MAX, [0; 2], None, |parts, pair| {
                    pair.iter_mut().for_each(|side| parts.any(side));
                });
            }
        }
    }
}

impl Operation {
    /// The names of operations, each with the code that its bytes begin with, and a blank. The codes
    /// between are other codes for the same.
    pub(super) fn blanks() -> [(&'static str, u8, Operation); 11] {
        let [vertex, mask, other, toward, half_edge] = [0; 5];
        let (any, through, tips, part, chord) = (false, false, CutTips::Vertex, 0, None);
        let (normal, weights, rays, spots) = ([0; 3], [0; 2], [[[0; 3]; 2]; 2], Vec::new());
        let split = |fault| Operation::Split {
            vertex,
            mask,
            fault,
        };
        let cut = Operation::Cut {
            through,
            tips,
            rays,
        };
        let insert = Operation::Insert {
            half_edge,
            spots,
            chord,
        };
        let merge = Operation::Merge {
            vertex,
            other,
            any,
            weights,
        };
        let slide = Operation::Slide {
            vertex,
            toward,
            any,
            part,
        };
        [
            ("split", 0, split(Fault::None)),
            ("split", 7, split(Fault::Repeated(0))),
            ("split", 8, split(Fault::Foreign(0))),
            ("plane", 9, Operation::Plane { vertex, normal }),
            ("cut", 13, cut),
            ("tear", 14, Operation::Tear),
            ("clear", 15, Operation::Clear),
            ("insert", 16, insert),
            ("merge", 17, merge),
            ("sew", 18, Operation::Sew { mask }),
            ("slide", 19, slide),
        ]
    }

    pub(super) fn parts(&mut self, parts: &mut impl Parts) {
        match self {
            Operation::Split {
                vertex,
                mask,
                fault,
            } => {
                parts.any(vertex);
                parts.mask(mask);
                fault.parts(parts);
            }
            Operation::Plane { vertex, normal } => {
                parts.any(vertex);
                normal.iter_mut().for_each(|x| parts.any(x));
            }
            Operation::Cut {
                through,
                tips,
                rays,
            } => {
                let mut ends = usize::from(*through) + 2 * usize::from(*tips == CutTips::Midpoint);
                parts.choice(&mut ends, &ENDS);
                *through = ends % 2 == 1;
                *tips = [CutTips::Vertex, CutTips::Midpoint][ends / 2];
                let numbers = rays.as_flattened_mut().as_flattened_mut();
                numbers.iter_mut().for_each(|x| parts.any(x));
            }
            Operation::Insert {
                half_edge,
                spots,
                chord,
            } => {
                parts.any(half_edge);
                let mut is_chord = chord.is_some();
                let more = Some(("chord", &mut is_chord));
                parts.list(spots, SPOTS_MAX, Spot::BLANK, more, |parts, spot| {
                    spot.parts(parts);
                });
                *chord = is_chord.then(|| chord.unwrap_or_default());
                let ends = chord.iter_mut().flatten();
                ends.for_each(|end| parts.any(end));
            }
            Operation::Merge {
                vertex,
                other,
                any,
                weights,
            } => {
                parts.flag(any, &ANY);
                parts.any(vertex);
                parts.any(other);
                weights.iter_mut().for_each(|weight| parts.any(weight));
            }
            Operation::Slide {
                vertex,
                toward,
                any,
                part,
            } => {
                parts.flag(any, &ANY);
                parts.any(vertex);
                parts.any(toward);
                parts.within(part, PARTS);
            }
            Operation::Sew { mask } => parts.mask(mask),
            Operation::Tear | Operation::Clear => {}
        }
    }
}

impl Fault {
    fn parts(&mut self, parts: &mut impl Parts) {
        let kinds = [Fault::None, Fault::Repeated(0), Fault::Foreign(0)];
        let is_same = |kind: &Fault| std::mem::discriminant(kind) == std::mem::discriminant(self);
        let before = kinds.iter().position(is_same).unwrap_or_default();
        let mut kind = before;
        parts.choice(&mut kind, &FAULT);
        if kind != before {
            *self = kinds[kind];
        }
        match self {
            Fault::None => {}
            Fault::Repeated(face) => parts.any(face),
            Fault::Foreign(face) => parts.any(face),
        }
    }
}

impl Spot {
    const BLANK: Spot = Spot::Edge { offset: 0, part: 0 };

    fn parts(&mut self, parts: &mut impl Parts) {
        let mut is_face = matches!(self, Spot::Face { .. });
        parts.flag(&mut is_face, &SPOT);
        if is_face != matches!(self, Spot::Face { .. }) {
            let (offset, weights) = (0, [0; 3]);
            *self = match is_face {
                true => Spot::Face { offset, weights },
                false => Spot::BLANK,
            };
        }
        match self {
            Spot::Edge { offset, part } => {
                parts.within(offset, OFFSETS);
                parts.within(part, PARTS);
            }
            Spot::Face { offset, weights } => {
                parts.within(offset, OFFSETS);
                parts.filler();
                weights.iter_mut().for_each(|weight| parts.any(weight));
            }
        }
    }
}
