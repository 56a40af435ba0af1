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
use std::str::{FromStr, SplitWhitespace};

use super::{Fault, GROWN_MAX, OFFSETS, Operation, SPOTS_MAX, Script, Shape, Spot};
use crate::scissor::CutTips;

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
        match self {
            Shape::Grid {
                columns,
                rows,
                rising,
            } => write!(f, "grid {columns} {rows} {rising:#b}"),
            Shape::Fan {
                faces,
                closed: true,
            } => write!(f, "fan {faces}"),
            Shape::Fan {
                faces,
                closed: false,
            } => write!(f, "open-fan {faces}"),
            Shape::Saddle => write!(f, "saddle"),
            Shape::Tube { around, along } => write!(f, "tube {around} {along}"),
            Shape::Torus { around, across } => write!(f, "torus {around} {across}"),
            Shape::Tetrahedron { subdivisions } => write!(f, "tetrahedron {subdivisions}"),
            Shape::Octahedron { subdivisions } => write!(f, "octahedron {subdivisions}"),
            Shape::Grown(moves) => {
                write!(f, "grown")?;
                moves.iter().try_for_each(|code| write!(f, " {code}"))
            }
            Shape::Glued { faces, sides } => {
                write!(f, "glued {faces}")?;
                sides.iter().try_for_each(|[a, b]| write!(f, " {a} {b}"))
            }
        }
    }
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
            Operation::Plane {
                vertex,
                normal: [x, y, z],
            } => write!(f, "plane {vertex} {x} {y} {z}"),
            Operation::Cut {
                through,
                tips,
                rays,
            } => {
                let through = if *through { " through" } else { "" };
                let midpoint = if *tips == CutTips::Midpoint {
                    " midpoint"
                } else {
                    ""
                };
                write!(f, "cut{through}{midpoint}")?;
                let mut numbers = rays.as_flattened().as_flattened().iter();
                numbers.try_for_each(|x| write!(f, " {x}"))
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
                        Spot::Face {
                            offset,
                            weights: [a, b, c],
                        } => write!(f, " face {offset} {a} {b} {c}")?,
                    }
                }
                match chord {
                    None => Ok(()),
                    Some([one, other]) => write!(f, " chord {one} {other}"),
                }
            }
            Operation::Merge {
                vertex,
                other,
                any,
                weights: [one, two],
            } => {
                let any = if *any { " any" } else { "" };
                write!(f, "merge{any} {vertex} {other} {one} {two}")
            }
            Operation::Slide {
                vertex,
                toward,
                any,
                part,
            } => {
                let any = if *any { " any" } else { "" };
                write!(f, "slide{any} {vertex} {toward} {part}")
            }
            Operation::Sew { mask } => write!(f, "sew {mask:#b}"),
            Operation::Tear => write!(f, "tear"),
            Operation::Clear => write!(f, "clear"),
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
            let mut line = Line {
                number: end,
                words,
                last: "",
            };
            let Some(first) = line.word() else { continue };
            if shape.is_none() {
                shape = Some(line.shape(first)?);
            } else if operations.len() < Script::OPERATIONS_MAX {
                operations.push(line.operation(first)?);
            } else {
                return Err(line.error("the end, after the largest number of operations,"));
            }
            if line.word().is_some() {
                return Err(line.error("the end of the line"));
            }
        }
        match shape {
            Some(shape) => Ok(Script { shape, operations }),
            None => Err(ScriptError {
                line: end + 1,
                word: String::new(),
                expected: "a shape".into(),
            }),
        }
    }
}

/// The words of a line, and the last one that was read.
struct Line<'t> {
    number: usize,
    words: SplitWhitespace<'t>,
    last: &'t str,
}

impl<'t> Line<'t> {
    fn word(&mut self) -> Option<&'t str> {
        let word = self.words.next();
        self.last = word.unwrap_or("");
        word
    }

    /// Takes the next word if it is this one.
    fn takes(&mut self, word: &str) -> bool {
        let mut ahead = self.words.clone();
        let found = ahead.next() == Some(word);
        if found {
            self.words = ahead;
        }
        found
    }

    fn has_more(&self) -> bool {
        self.words.clone().next().is_some()
    }

    fn error(&self, expected: impl Into<String>) -> ScriptError {
        ScriptError {
            line: self.number,
            word: self.last.into(),
            expected: expected.into(),
        }
    }

    /// A whole number from `least` to `most`.
    fn within<T: TryFrom<i128>>(&mut self, least: i128, most: i128) -> Result<T, ScriptError> {
        let word = self.word().unwrap_or("");
        let number = match (word.strip_prefix("0x"), word.strip_prefix("0b")) {
            (Some(digits), _) => i128::from_str_radix(digits, 16),
            (_, Some(digits)) => i128::from_str_radix(digits, 2),
            _ => word.parse(),
        };
        let number = number.ok().filter(|number| (least..=most).contains(number));
        number
            .and_then(|number| T::try_from(number).ok())
            .ok_or_else(|| self.error(format!("a number from {least} to {most}")))
    }

    fn byte(&mut self) -> Result<u8, ScriptError> {
        self.within(0, u8::MAX.into())
    }

    fn u16(&mut self) -> Result<u16, ScriptError> {
        self.within(0, u16::MAX.into())
    }

    fn vector<const N: usize>(&mut self) -> Result<[i8; N], ScriptError> {
        let mut vector = [0; N];
        for x in &mut vector {
            *x = self.within(i8::MIN.into(), i8::MAX.into())?;
        }
        Ok(vector)
    }

    /// The rest of the line, in groups of `N` bytes.
    fn groups<const N: usize>(&mut self) -> Result<Vec<[u8; N]>, ScriptError> {
        let mut groups = Vec::new();
        while self.has_more() && groups.len() < GROWN_MAX {
            let mut group = [0; N];
            for byte in &mut group {
                *byte = self.byte()?;
            }
            groups.push(group);
        }
        Ok(groups)
    }

    fn shape(&mut self, name: &str) -> Result<Shape, ScriptError> {
        Ok(match name {
            "grid" => Shape::Grid {
                columns: self.within(1, 5)?,
                rows: self.within(1, 5)?,
                rising: self.within(0, u64::MAX.into())?,
            },
            "fan" | "open-fan" => Shape::Fan {
                faces: self.within(3, 16)?,
                closed: name == "fan",
            },
            "saddle" => Shape::Saddle,
            "tube" => Shape::Tube {
                around: self.within(3, 8)?,
                along: self.within(1, 4)?,
            },
            "torus" => Shape::Torus {
                around: self.within(3, 5)?,
                across: self.within(3, 5)?,
            },
            "tetrahedron" => Shape::Tetrahedron {
                subdivisions: self.within(0, 1)?,
            },
            "octahedron" => Shape::Octahedron {
                subdivisions: self.within(0, 1)?,
            },
            "grown" => Shape::Grown(self.groups::<1>()?.into_flattened()),
            "glued" => Shape::Glued {
                faces: self.within(1, 24)?,
                sides: self.groups()?,
            },
            _ => return Err(self.error("a shape")),
        })
    }

    fn operation(&mut self, name: &str) -> Result<Operation, ScriptError> {
        Ok(match name {
            "split" => Operation::Split {
                vertex: self.u16()?,
                mask: self.u16()?,
                fault: if self.takes("repeated") {
                    Fault::Repeated(self.byte()?)
                } else if self.takes("foreign") {
                    Fault::Foreign(self.u16()?)
                } else {
                    Fault::None
                },
            },
            "plane" => Operation::Plane {
                vertex: self.u16()?,
                normal: self.vector()?,
            },
            "cut" => Operation::Cut {
                through: self.takes("through"),
                tips: if self.takes("midpoint") {
                    CutTips::Midpoint
                } else {
                    CutTips::Vertex
                },
                rays: [
                    [self.vector()?, self.vector()?],
                    [self.vector()?, self.vector()?],
                ],
            },
            "insert" => self.insert()?,
            "merge" => Operation::Merge {
                any: self.takes("any"),
                vertex: self.u16()?,
                other: self.u16()?,
                weights: self.vector()?,
            },
            "slide" => Operation::Slide {
                any: self.takes("any"),
                vertex: self.u16()?,
                toward: self.u16()?,
                part: self.within(0, 64)?,
            },
            "sew" => Operation::Sew { mask: self.u16()? },
            "tear" => Operation::Tear,
            "clear" => Operation::Clear,
            _ => return Err(self.error("an operation")),
        })
    }

    fn insert(&mut self) -> Result<Operation, ScriptError> {
        let half_edge = self.u16()?;
        let mut spots = Vec::new();
        while spots.len() < SPOTS_MAX {
            if self.takes("edge") {
                spots.push(Spot::Edge {
                    offset: self.within(0, i128::from(OFFSETS) - 1)?,
                    part: self.within(0, 64)?,
                });
            } else if self.takes("face") {
                spots.push(Spot::Face {
                    offset: self.within(0, i128::from(OFFSETS) - 1)?,
                    weights: [self.byte()?, self.byte()?, self.byte()?],
                });
            } else {
                break;
            }
        }
        let chord = if self.takes("chord") {
            Some([self.byte()?, self.byte()?])
        } else {
            None
        };
        Ok(Operation::Insert {
            half_edge,
            spots,
            chord,
        })
    }
}
