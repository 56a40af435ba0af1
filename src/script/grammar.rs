//! The grammar of scripts: the parts of a shape and of an operation, in their order, and from which
//! number to which each goes. Bytes and text are read by it.

use std::ops::RangeInclusive;

use super::cut::{CutPath, CutSettings, FAR_MAX};
use super::shape::{GROWN_MAX, Shape};
use super::{Fault, Operation, SPOTS_MAX, Spot};
use crate::scissor::{CutLayers, CutMethod, CutTips};

/// What the parts of a script are read from. Bytes are a script whatever they are; words that are
/// none are noted, and stand for the least number.
pub(super) trait Source {
    /// A number in these limits, which takes this many bytes.
    fn number(&mut self, limits: RangeInclusive<i128>, bytes: usize) -> i128;

    /// A set of bits in this many bytes.
    fn bits(&mut self, bytes: usize) -> u64;

    /// The index of an alternative. One of no words is taken where none of the others stands, and
    /// `named` where the name of the line has decided.
    fn choice(&mut self, words: &[&str], odds: &Odds, named: usize) -> usize;

    /// A list of at most `most` items, and whether this word, if any, comes after it.
    fn list<T>(&mut self, most: usize, end: &str, item: fn(&mut Self) -> T) -> (Vec<T>, bool);

    /// A byte that says nothing more.
    fn filler(&mut self) {}

    /// A shape within another one.
    fn inner_shape(&mut self) -> Shape;

    fn u8(&mut self, limits: RangeInclusive<u8>) -> u8 {
        let (least, most) = limits.into_inner();
        self.number(least.into()..=most.into(), 1) as u8
    }

    fn u16(&mut self) -> u16 {
        self.number(0..=u16::MAX.into(), 2) as u16
    }

    fn i8(&mut self) -> i8 {
        self.number(i8::MIN.into()..=i8::MAX.into(), 1) as i8
    }

    fn point(&mut self) -> [i8; 3] {
        [(); 3].map(|()| self.i8())
    }

    /// Two points, or an origin and a direction.
    fn points(&mut self) -> [[i8; 3]; 2] {
        [(); 2].map(|()| self.point())
    }
}

/// How bytes choose between alternatives.
pub(super) enum Odds {
    /// The name of the line has decided.
    Named,
    /// By a byte, modulo the number of alternatives.
    Even,
    /// By a byte, which chooses the second alternative with its three lowest bits set.
    Seldom,
    /// By the byte after the next one: the second alternative from 195 on.
    Ahead,
}

const ANY: RangeInclusive<u8> = 0..=u8::MAX;

/// The offsets of spots: the half-edges of four faces.
const OFFSETS: RangeInclusive<u8> = 0..=11;

/// Sixty-fourths.
const PARTS: RangeInclusive<u8> = 0..=64;

/// Sixty-fourths of an edge, below the largest snap of a scissor.
const SNAPS: RangeInclusive<u8> = 0..=31;

impl Shape {
    /// Reads the shape of this name; `None` if there is none.
    pub(super) fn read(name: &str, from: &mut impl Source) -> Option<Shape> {
        Some(match name {
            "grid" => Shape::Grid {
                columns: from.u8(1..=5),
                rows: from.u8(1..=5),
                rising: from.bits(8),
            },
            "fan" | "open-fan" => Shape::Fan {
                faces: from.u8(3..=16),
                closed: from.choice(&["", ""], &Odds::Even, usize::from(name == "fan")) == 1,
            },
            "saddle" => Shape::Saddle,
            "tube" => Shape::Tube {
                around: from.u8(3..=8),
                along: from.u8(1..=4),
            },
            "torus" => Shape::Torus {
                around: from.u8(3..=5),
                across: from.u8(3..=5),
            },
            "tetrahedron" => Shape::Tetrahedron {
                subdivisions: from.u8(0..=1),
            },
            "octahedron" => Shape::Octahedron {
                subdivisions: from.u8(0..=1),
            },
            "grown" => Shape::Grown(from.list(GROWN_MAX, "", |from| from.u8(ANY)).0),
            "glued" => Shape::Glued {
                faces: from.u8(1..=24),
                sides: from
                    .list(GROWN_MAX, "", |from| [(); 2].map(|()| from.u8(ANY)))
                    .0,
            },
            "unsewn" => Shape::Unsewn {
                faces: from.bits(8),
                shape: Box::new(from.inner_shape()),
            },
            _ => return None,
        })
    }
}

impl Operation {
    /// Reads the operation of this name; `None` if there is none. Bytes name a fault with the split, and call
    /// a cut that is not one by the method `partition` between two rays `cut by`.
    pub(super) fn read(name: &str, from: &mut impl Source) -> Option<Operation> {
        const WORDS: [&str; 2] = ["", "any"];
        Some(match name {
            "split" | "split repeated" | "split foreign" => Operation::Split {
                vertex: from.u16(),
                mask: from.bits(2) as u16,
                fault: Fault::read(name, from),
            },
            "plane" => Operation::Plane {
                vertex: from.u16(),
                normal: from.point(),
            },
            "cut" | "cut by" => {
                let settings = CutSettings::read(name, from);
                let far = match from.choice(&["", "far"], &rare(name), 0) {
                    0 => 0,
                    _ => from.u8(0..=FAR_MAX),
                };
                Operation::Cut {
                    path: CutPath::read(name, from),
                    far,
                    settings,
                }
            }
            "insert" => {
                let half_edge = from.u16();
                let (spots, has_chord) = from.list(SPOTS_MAX, "chord", Spot::read);
                Operation::Insert {
                    half_edge,
                    spots,
                    chord: has_chord.then(|| [(); 2].map(|()| from.u8(ANY))),
                }
            }
            "merge" => Operation::Merge {
                any: from.choice(&WORDS, &Odds::Seldom, 0) == 1,
                vertex: from.u16(),
                other: from.u16(),
                weights: [(); 2].map(|()| from.i8()),
            },
            "slide" => Operation::Slide {
                any: from.choice(&WORDS, &Odds::Seldom, 0) == 1,
                vertex: from.u16(),
                toward: from.u16(),
                part: from.u8(PARTS),
            },
            "sew" => Operation::Sew {
                mask: from.bits(2) as u16,
            },
            "tear" => Operation::Tear,
            "clear" => Operation::Clear,
            _ => return None,
        })
    }
}

impl Fault {
    fn read(name: &str, from: &mut impl Source) -> Fault {
        const WORDS: [&str; 3] = ["", "repeated", "foreign"];
        let named = WORDS.iter().rposition(|word| name.ends_with(word));
        match from.choice(&WORDS, &Odds::Named, named.unwrap_or(0)) {
            1 => Fault::Repeated(from.u8(ANY)),
            2 => Fault::Foreign(from.u16()),
            _ => Fault::None,
        }
    }
}

/// The odds of what only cuts with a long name have: even ones, and less than even ones.
fn even(name: &str) -> Odds {
    if name == "cut" {
        Odds::Named
    } else {
        Odds::Even
    }
}

fn rare(name: &str) -> Odds {
    if name == "cut" {
        Odds::Named
    } else {
        Odds::Seldom
    }
}

impl CutSettings {
    fn read(name: &str, from: &mut impl Source) -> CutSettings {
        let methods = ["", "exact", "uniform", "alternating"];
        let method = from.choice(&methods, &even(name), 0);
        let words = ["", "through", "midpoint", "through midpoint"];
        let ends = from.choice(&words, &Odds::Even, 0);
        let layers = from.choice(&["", "first"], &even(name), 0);
        let snap = match from.choice(&["", "snap"], &even(name), 0) {
            0 => None,
            _ => Some(from.u8(SNAPS)),
        };
        CutSettings {
            method: [
                CutMethod::Partition,
                CutMethod::Exact,
                CutMethod::Uniform,
                CutMethod::Alternating,
            ][method],
            through: ends % 2 == 1,
            tips: [CutTips::Vertex, CutTips::Midpoint][ends / 2],
            layers: [CutLayers::All, CutLayers::First][layers],
            snap,
            snap_move: from.choice(&["", "move"], &even(name), 0) == 1,
            seams: from.choice(&["", "seams"], &even(name), 0) == 1,
        }
    }
}

impl CutPath {
    fn read(name: &str, from: &mut impl Source) -> CutPath {
        let words = [
            "",
            "skew",
            "parallel",
            "eye",
            "converging",
            "plane",
            "continued",
            "closed",
        ];
        match from.choice(&words, &even(name), 0) {
            0 => CutPath::Rays([(); 2].map(|()| from.points())),
            1 => CutPath::Skew([(); 2].map(|()| from.points())),
            2 => CutPath::Parallel {
                direction: from.point(),
                targets: from.points(),
            },
            3 => CutPath::Eye {
                eye: from.point(),
                targets: from.points(),
            },
            4 => CutPath::Converging {
                origins: from.points(),
                target: from.point(),
            },
            5 => CutPath::Plane {
                point: from.point(),
                normal: from.point(),
            },
            6 => CutPath::Continued(from.points()),
            _ => CutPath::Closed,
        }
    }
}

impl Spot {
    fn read<S: Source>(from: &mut S) -> Spot {
        if from.choice(&["edge", "face"], &Odds::Ahead, 0) == 0 {
            return Spot::Edge {
                offset: from.u8(OFFSETS),
                part: from.u8(PARTS),
            };
        }
        let offset = from.u8(OFFSETS);
        from.filler();
        let weights = [(); 3].map(|()| from.u8(ANY));
        Spot::Face { offset, weights }
    }
}
