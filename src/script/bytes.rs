//! Scripts as bytes: every byte string is one.

use super::{Fault, GROWN_MAX, OFFSETS, Operation, SPOTS_MAX, Script, Shape, Spot};
use crate::scissor::CutTips;

impl Script {
    /// Decodes bytes as a script of at most [`Script::OPERATIONS_MAX`] operations on a mesh of at
    /// most a few hundred faces. Missing bytes count as zero.
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

    /// Encodes this script as bytes from which [`Script::from_bytes`] restores it, if it came from
    /// bytes or text. Numbers that exceed the limits of a [`Shape`] are not restored.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_shape(&self.shape, &mut bytes);
        for operation in &self.operations {
            write_operation(operation, &mut bytes);
        }
        bytes
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

    /// A number from `least` to `most`.
    fn within(&mut self, least: u8, most: u8) -> u8 {
        least + self.byte() % (most - least + 1)
    }

    fn array<const N: usize>(&mut self) -> [u8; N] {
        std::array::from_fn(|_| self.byte())
    }

    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.array())
    }

    fn vector(&mut self) -> [i8; 3] {
        self.array().map(u8::cast_signed)
    }

    fn shape(&mut self) -> Shape {
        match self.byte() % 9 {
            0 => Shape::Grid {
                columns: self.within(1, 5),
                rows: self.within(1, 5),
                rising: u64::from_le_bytes(self.array()),
            },
            1 => Shape::Fan {
                faces: self.within(3, 16),
                closed: self.byte() % 2 == 1,
            },
            2 => Shape::Saddle,
            3 => Shape::Tube {
                around: self.within(3, 8),
                along: self.within(1, 4),
            },
            4 => Shape::Torus {
                around: self.within(3, 5),
                across: self.within(3, 5),
            },
            5 => Shape::Tetrahedron {
                subdivisions: self.within(0, 1),
            },
            6 => Shape::Octahedron {
                subdivisions: self.within(0, 1),
            },
            7 => {
                let count = usize::from(self.byte()) % (GROWN_MAX + 1);
                Shape::Grown((0..count).map(|_| self.byte()).collect())
            }
            _ => {
                let faces = self.within(1, 24);
                let count = usize::from(self.byte()) % (GROWN_MAX + 1);
                Shape::Glued {
                    faces,
                    sides: (0..count).map(|_| self.array()).collect(),
                }
            }
        }
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
        match code {
            0..=6 => self.split(|_| Fault::None),
            7 => self.split(|bytes| Fault::Repeated(bytes.byte())),
            8 => self.split(|bytes| Fault::Foreign(bytes.u16())),
            9..=12 => Operation::Plane {
                vertex: self.u16(),
                normal: self.vector(),
            },
            13 => {
                let flags = self.byte();
                Operation::Cut {
                    through: flags & 1 == 1,
                    tips: if flags & 2 == 2 {
                        CutTips::Midpoint
                    } else {
                        CutTips::Vertex
                    },
                    rays: [(); 2].map(|()| [self.vector(), self.vector()]),
                }
            }
            14 => Operation::Tear,
            15 => Operation::Clear,
            16 => self.insert(),
            17 => {
                let flags = self.byte();
                Operation::Merge {
                    vertex: self.u16(),
                    other: self.u16(),
                    any: flags % 8 == 7,
                    weights: self.array().map(u8::cast_signed),
                }
            }
            18 => Operation::Sew { mask: self.u16() },
            _ => {
                let flags = self.byte();
                Operation::Slide {
                    vertex: self.u16(),
                    toward: self.u16(),
                    any: flags % 8 == 7,
                    part: self.byte() % 65,
                }
            }
        }
    }

    fn insert(&mut self) -> Operation {
        let half_edge = self.u16();
        let flags = self.byte();
        let count = usize::from(flags & 7) % (SPOTS_MAX + 1);
        let spots = (0..count).map(|_| self.spot()).collect();
        Operation::Insert {
            half_edge,
            spots,
            chord: (flags >= 192).then(|| self.array()),
        }
    }

    fn spot(&mut self) -> Spot {
        let offset = self.byte() % OFFSETS;
        match self.byte() {
            part @ 0..195 => Spot::Edge {
                offset,
                part: part % 65,
            },
            _ => Spot::Face {
                offset,
                weights: self.array(),
            },
        }
    }

    fn split(&mut self, fault: impl Fn(&mut Self) -> Fault) -> Operation {
        Operation::Split {
            vertex: self.u16(),
            mask: self.u16(),
            fault: fault(self),
        }
    }
}

fn write_shape(shape: &Shape, bytes: &mut Vec<u8>) {
    match *shape {
        Shape::Grid {
            columns,
            rows,
            rising,
        } => {
            bytes.extend([0, columns - 1, rows - 1]);
            bytes.extend(rising.to_le_bytes());
        }
        Shape::Fan { faces, closed } => bytes.extend([1, faces - 3, closed.into()]),
        Shape::Saddle => bytes.push(2),
        Shape::Tube { around, along } => bytes.extend([3, around - 3, along - 1]),
        Shape::Torus { around, across } => bytes.extend([4, around - 3, across - 3]),
        Shape::Tetrahedron { subdivisions } => bytes.extend([5, subdivisions]),
        Shape::Octahedron { subdivisions } => bytes.extend([6, subdivisions]),
        Shape::Grown(ref moves) => {
            bytes.extend([7, moves.len() as u8]);
            bytes.extend(moves);
        }
        Shape::Glued { faces, ref sides } => {
            bytes.extend([8, faces - 1, sides.len() as u8]);
            bytes.extend(sides.as_flattened());
        }
    }
}

fn write_operation(operation: &Operation, bytes: &mut Vec<u8>) {
    match *operation {
        Operation::Split {
            vertex,
            mask,
            fault,
        } => {
            bytes.push(match fault {
                Fault::None => 0,
                Fault::Repeated(_) => 7,
                Fault::Foreign(_) => 8,
            });
            bytes.extend(vertex.to_le_bytes());
            bytes.extend(mask.to_le_bytes());
            match fault {
                Fault::None => {}
                Fault::Repeated(face) => bytes.push(face),
                Fault::Foreign(face) => bytes.extend(face.to_le_bytes()),
            }
        }
        Operation::Plane { vertex, normal } => {
            bytes.push(9);
            bytes.extend(vertex.to_le_bytes());
            bytes.extend(normal.map(i8::cast_unsigned));
        }
        Operation::Cut {
            through,
            tips,
            rays,
        } => {
            bytes.extend([
                13,
                u8::from(through) | u8::from(tips == CutTips::Midpoint) << 1,
            ]);
            bytes.extend(
                rays.as_flattened()
                    .as_flattened()
                    .iter()
                    .map(|x| x.cast_unsigned()),
            );
        }
        Operation::Tear => bytes.push(14),
        Operation::Clear => bytes.push(15),
        Operation::Insert {
            half_edge,
            ref spots,
            chord,
        } => {
            bytes.push(16);
            bytes.extend(half_edge.to_le_bytes());
            bytes.push(spots.len() as u8 | if chord.is_some() { 192 } else { 0 });
            for &spot in spots {
                match spot {
                    Spot::Edge { offset, part } => bytes.extend([offset, part]),
                    Spot::Face { offset, weights } => {
                        bytes.extend([offset, 255]);
                        bytes.extend(weights);
                    }
                }
            }
            bytes.extend(chord.into_iter().flatten());
        }
        Operation::Merge {
            vertex,
            other,
            any,
            weights,
        } => {
            bytes.extend([17, if any { 7 } else { 0 }]);
            bytes.extend(vertex.to_le_bytes());
            bytes.extend(other.to_le_bytes());
            bytes.extend(weights.map(i8::cast_unsigned));
        }
        Operation::Sew { mask } => {
            bytes.push(18);
            bytes.extend(mask.to_le_bytes());
        }
        Operation::Slide {
            vertex,
            toward,
            any,
            part,
        } => {
            bytes.extend([19, if any { 7 } else { 0 }]);
            bytes.extend(vertex.to_le_bytes());
            bytes.extend(toward.to_le_bytes());
            bytes.push(part);
        }
    }
}
