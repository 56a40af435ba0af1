//! What can be wrong with triangles, and the compact list of it that a [`BuildError`] holds.
//!
//! A few bytes of input can make many defects with long lists of faces: in copies of one polygon
//! of n corners each face is listed some three times. So a defect is stored as a record
//! without a list of its own. The lists stand in blocks of bytes: how many, then the first
//! number, then the steps from each to the next, in groups of seven bits, the lowest first. Lists
//! ascend, and long ones have small steps: a byte a face. [`Defect`] is a view that reads them.
//! (Blocks, since one array would be there twice whenever it grows.)
//!
//! A `Vec` a list was rejected: 24 bytes and an allocation for the two or three faces that most
//! have, and four bytes a face where the lists are long.

use std::fmt;

use super::Mesh;
use crate::id::{FaceId, VertexId};

/// The reason why triangles were refused: a list of every defect, ordered by the variants of
/// [`Defect`] and then by ids.
#[derive(Clone)]
pub struct BuildError {
    /// Ascending.
    records: Vec<Record>,
    lists: Vec<Vec<u8>>,
    /// The number of vertices, for the words.
    vertices: usize,
}

impl BuildError {
    /// Returns all defects. There is always at least one. Reading a defect takes time proportional
    /// to the lists in it.
    ///
    /// ```
    /// use tearmesh::{Defect, Mesh};
    ///
    /// let error = Mesh::build(5, &[[0, 1, 2], [2, 1, 3], [1, 2, 4]]).unwrap_err();
    /// for defect in error.defects() {
    ///     if let Defect::CrowdedEdge { ends: [a, b], faces } = defect {
    ///         let faces: Vec<_> = faces.iter().map(|face| face.index()).collect();
    ///         assert_eq!((a.index(), b.index(), faces), (1, 2, vec![0, 1, 2]));
    ///     }
    /// }
    /// ```
    #[must_use]
    pub fn defects(
        &self,
    ) -> impl ExactSizeIterator<Item = Defect<'_>> + DoubleEndedIterator + Clone {
        self.records.iter().map(|&record| self.view(record))
    }

    fn view(&self, record: Record) -> Defect<'_> {
        let bytes = |At(at): At| {
            let block = &self.lists[(at >> At::OFFSET_BITS) as usize];
            &block[(at & ((1 << At::OFFSET_BITS) - 1)) as usize..]
        };
        match record {
            Record::TooManyVertices => Defect::TooManyVertices {
                given: self.vertices,
                limit: Mesh::MAX_VERTICES,
            },
            Record::TooManyFaces { given } => Defect::TooManyFaces {
                given: given as usize,
                limit: Mesh::MAX_FACES,
            },
            Record::IndexOutOfRange {
                face,
                corner,
                index,
            } => Defect::IndexOutOfRange {
                face,
                corner: usize::from(corner),
                index,
                vertices: self.vertices,
            },
            Record::RepeatedVertex { face, vertex } => Defect::RepeatedVertex { face, vertex },
            Record::DuplicateFaces { vertices, at } => Defect::DuplicateFaces {
                vertices,
                faces: Faces::at(bytes(at)),
            },
            Record::Pillow { vertices, faces } => Defect::Pillow { vertices, faces },
            Record::CrowdedEdge { ends, at } => Defect::CrowdedEdge {
                ends,
                faces: Faces::at(bytes(at)),
            },
            Record::FlippedFace { from, to, faces } => Defect::FlippedFace { from, to, faces },
            Record::BowTie { vertex, at } => Defect::BowTie {
                vertex,
                fans: Fans::at(bytes(at)),
            },
        }
    }
}

/// One defect of the given triangles, with all ids concerned. It is a view into a [`BuildError`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Defect<'e> {
    /// More vertices were given than a mesh can have.
    TooManyVertices {
        /// The number of vertices given.
        given: usize,
        /// The limit, [`Mesh::MAX_VERTICES`].
        limit: usize,
    },
    /// More faces were given than a mesh can have.
    TooManyFaces {
        /// The number of faces given.
        given: usize,
        /// The limit, [`Mesh::MAX_FACES`].
        limit: usize,
    },
    /// A face refers to a vertex that does not exist.
    IndexOutOfRange {
        /// The face that refers to the vertex.
        face: FaceId,
        /// The corner of the face that refers to it: 0, 1 or 2.
        corner: usize,
        /// The vertex index at that corner.
        index: u32,
        /// The number of vertices given. Valid indices are smaller.
        vertices: usize,
    },
    /// A face lists the same vertex twice.
    RepeatedVertex {
        /// The face that lists a vertex twice.
        face: FaceId,
        /// The vertex that is listed twice.
        vertex: VertexId,
    },
    /// Several faces have the same three vertices, and at least two of them have the same orientation.
    DuplicateFaces {
        /// The three vertices of the faces, in ascending order.
        vertices: [VertexId; 3],
        /// All faces with these three vertices, in ascending order.
        faces: Faces<'e>,
    },
    /// Two faces have the same three vertices and opposite orientations.
    Pillow {
        /// The three vertices of the two faces, in ascending order.
        vertices: [VertexId; 3],
        /// The two faces, in ascending order.
        faces: [FaceId; 2],
    },
    /// Three or more faces share an edge.
    CrowdedEdge {
        /// The two vertices of the edge, in ascending order.
        ends: [VertexId; 2],
        /// All faces on the edge, in ascending order.
        faces: Faces<'e>,
    },
    /// Two faces traverse an edge in the same direction, so one of them is flipped.
    FlippedFace {
        /// The vertex at which both half-edges start.
        from: VertexId,
        /// The vertex at which both half-edges end.
        to: VertexId,
        /// The two faces, in ascending order.
        faces: [FaceId; 2],
    },
    /// A vertex has several fans of faces that share no edge (Souza et al. 2014, Fig. 2).
    BowTie {
        /// The vertex that has several fans.
        vertex: VertexId,
        /// The faces of each fan. The fan that contains the smallest face comes first.
        fans: Fans<'e>,
    },
}

/// The faces that a [`Defect`] lists, in ascending order. There is always at least one.
#[derive(Clone, Copy)]
pub struct Faces<'e> {
    count: usize,
    bytes: &'e [u8],
}

impl<'e> Faces<'e> {
    fn at(mut bytes: &'e [u8]) -> Self {
        let count = take(&mut bytes) as usize;
        Faces { count, bytes }
    }

    /// Returns the number of faces.
    #[expect(
        clippy::len_without_is_empty,
        reason = "a list of faces is never empty"
    )]
    #[must_use]
    pub fn len(self) -> usize {
        self.count
    }

    /// Returns an iterator over the faces, in ascending order.
    #[must_use]
    pub fn iter(self) -> impl ExactSizeIterator<Item = FaceId> + Clone + use<'e> {
        let Faces { count, mut bytes } = self;
        let mut face = 0;
        (0..count).map(move |_| {
            face += take(&mut bytes);
            FaceId::from_u32(face)
        })
    }

    /// Returns the smallest face.
    #[expect(
        clippy::missing_panics_doc,
        reason = "only a bug of ours can trip the expectation"
    )]
    #[must_use]
    pub fn first(self) -> FaceId {
        self.iter().next().expect("a list of faces is never empty")
    }
}

/// The fans that a [`Defect::BowTie`] lists. There are always at least two.
#[derive(Clone, Copy)]
pub struct Fans<'e> {
    count: usize,
    bytes: &'e [u8],
}

impl<'e> Fans<'e> {
    fn at(mut bytes: &'e [u8]) -> Self {
        let count = take(&mut bytes) as usize;
        Fans { count, bytes }
    }

    /// Returns the number of fans.
    #[expect(
        clippy::len_without_is_empty,
        reason = "a bow-tie has two fans or more"
    )]
    #[must_use]
    pub fn len(self) -> usize {
        self.count
    }

    /// Returns an iterator over the fans, each given as its faces. The fan that contains the
    /// smallest face comes first.
    #[must_use]
    pub fn iter(self) -> impl ExactSizeIterator<Item = Faces<'e>> + Clone {
        let Fans { count, mut bytes } = self;
        (0..count).map(move |_| {
            let faces = Faces::at(bytes);
            // The list, and the number in front of it.
            for _ in 0..=faces.count {
                take(&mut bytes);
            }
            faces
        })
    }
}

/// What is stored of a defect; `at` is where its list begins. The order is that of defects:
/// no two have the same ids, so that `at` never decides.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Record {
    TooManyVertices,
    TooManyFaces {
        given: u64,
    },
    IndexOutOfRange {
        face: FaceId,
        corner: u8,
        index: u32,
    },
    RepeatedVertex {
        face: FaceId,
        vertex: VertexId,
    },
    DuplicateFaces {
        vertices: [VertexId; 3],
        at: At,
    },
    Pillow {
        vertices: [VertexId; 3],
        faces: [FaceId; 2],
    },
    CrowdedEdge {
        ends: [VertexId; 2],
        at: At,
    },
    FlippedFace {
        from: VertexId,
        to: VertexId,
        faces: [FaceId; 2],
    },
    BowTie {
        vertex: VertexId,
        at: At,
    },
}

/// Where a list begins: the block, and in the lower bits the byte of the block.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct At(u64);

impl At {
    /// A block has at most five bytes for each of 2^31 half-edges, and two numbers for each vertex.
    const OFFSET_BITS: u32 = 40;
}

/// Collects defects, in any order.
pub(super) struct Found(BuildError);

impl Found {
    pub(super) fn new(vertices: usize) -> Found {
        Found(BuildError {
            records: Vec::new(),
            lists: vec![Vec::new()],
            vertices,
        })
    }

    /// All that was added; `None` if nothing was.
    pub(super) fn finish(self) -> Option<BuildError> {
        let mut error = self.0;
        error.records.sort_unstable();
        (!error.records.is_empty()).then_some(error)
    }

    /// Puts the lists to come into a block of their own, unless the last one is empty.
    pub(super) fn begin_block(&mut self) {
        let lists = &mut self.0.lists;
        let last = lists.last_mut().expect("there is always a block");
        if !last.is_empty() {
            last.shrink_to_fit();
            lists.push(Vec::new());
        }
    }

    fn block(&mut self) -> (&mut Vec<u8>, At) {
        let number = self.0.lists.len() - 1;
        let block = &mut self.0.lists[number];
        let at = (number as u64) << At::OFFSET_BITS | block.len() as u64;
        (block, At(at))
    }

    pub(super) fn count(&self) -> usize {
        self.0.records.len()
    }

    pub(super) fn too_many_vertices(&mut self) {
        self.0.records.push(Record::TooManyVertices);
    }

    pub(super) fn too_many_faces(&mut self, given: usize) {
        let given = given as u64;
        self.0.records.push(Record::TooManyFaces { given });
    }

    pub(super) fn index_out_of_range(&mut self, face: FaceId, corner: u8, index: u32) {
        self.0.records.push(Record::IndexOutOfRange {
            face,
            corner,
            index,
        });
    }

    pub(super) fn repeated_vertex(&mut self, face: FaceId, vertex: VertexId) {
        self.0.records.push(Record::RepeatedVertex { face, vertex });
    }

    pub(super) fn duplicate_faces(
        &mut self,
        vertices: [VertexId; 3],
        faces: impl ExactSizeIterator<Item = u32>,
    ) {
        let at = self.list(faces);
        let record = Record::DuplicateFaces { vertices, at };
        self.0.records.push(record);
    }

    pub(super) fn pillow(&mut self, vertices: [VertexId; 3], faces: [FaceId; 2]) {
        self.0.records.push(Record::Pillow { vertices, faces });
    }

    pub(super) fn crowded_edge(
        &mut self,
        ends: [VertexId; 2],
        faces: impl ExactSizeIterator<Item = u32>,
    ) {
        let at = self.list(faces);
        self.0.records.push(Record::CrowdedEdge { ends, at });
    }

    pub(super) fn flipped_face(&mut self, from: VertexId, to: VertexId, faces: [FaceId; 2]) {
        let record = Record::FlippedFace { from, to, faces };
        self.0.records.push(record);
    }

    pub(super) fn bow_tie<F: ExactSizeIterator<Item = u32>>(
        &mut self,
        vertex: VertexId,
        fan_count: u32,
        fans: impl Iterator<Item = F>,
    ) {
        let (block, at) = self.block();
        put(block, fan_count);
        for fan in fans {
            self.list(fan);
        }
        self.0.records.push(Record::BowTie { vertex, at });
    }

    /// Appends a list of ascending numbers; where it begins.
    fn list(&mut self, faces: impl ExactSizeIterator<Item = u32>) -> At {
        let (block, at) = self.block();
        put(block, faces.len() as u32);
        let mut last = 0;
        for face in faces {
            put(block, face - last);
            last = face;
        }
        at
    }
}

/// Appends a number, seven bits a byte; the highest bit says that more follow.
fn put(bytes: &mut Vec<u8>, mut number: u32) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Takes a number off the front.
fn take(bytes: &mut &[u8]) -> u32 {
    let mut number = 0;
    for (i, &byte) in bytes.iter().enumerate() {
        number |= u32::from(byte & 0x7f) << (7 * i);
        if byte < 0x80 {
            *bytes = &bytes[i + 1..];
            return number;
        }
    }
    unreachable!("a list of defects ends with its last number")
}

/// How many defects, and how many faces of one, a message shows.
const SHOWN: usize = 20;

impl fmt::Display for BuildError {
    /// A line for each of the first twenty defects.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.records.len();
        let plural = if count == 1 { "" } else { "s" };
        write!(f, "not an oriented 2-manifold: {count} defect{plural}")?;
        for defect in self.defects().take(SHOWN) {
            write!(f, "\n  {defect}")?;
        }
        if count > SHOWN {
            write!(f, "\n  and {} more", count - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for BuildError {}

impl fmt::Debug for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.defects()).finish()
    }
}

// The bytes of equal lists need not stand in the same places.
impl PartialEq for BuildError {
    fn eq(&self, other: &Self) -> bool {
        self.defects().eq(other.defects())
    }
}

impl Eq for BuildError {}

impl fmt::Debug for Faces<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl PartialEq for Faces<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl Eq for Faces<'_> {}

impl fmt::Debug for Fans<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl PartialEq for Fans<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl Eq for Fans<'_> {}

impl fmt::Display for Defect<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Defect::TooManyVertices { given, limit } => {
                write!(f, "{given} vertices, the limit is {limit}")
            }
            Defect::TooManyFaces { given, limit } => {
                write!(f, "{given} faces, the limit is {limit}")
            }
            Defect::IndexOutOfRange {
                face,
                corner,
                index,
                vertices,
            } => write!(
                f,
                "{face} names vertex {index} at corner {corner}, but there are {vertices} vertices"
            ),
            Defect::RepeatedVertex { face, vertex } => {
                write!(f, "{face} names {vertex} more than once")
            }
            Defect::DuplicateFaces {
                vertices: [a, b, c],
                faces,
            } => {
                write!(
                    f,
                    "the vertices {a}, {b}, {c} have several faces: {}",
                    list(faces.iter())
                )
            }
            Defect::Pillow {
                vertices: [a, b, c],
                faces,
            } => {
                write!(
                    f,
                    "two faces lie back to back on {a}, {b}, {c}: {}",
                    list(faces.into_iter())
                )
            }
            Defect::CrowdedEdge {
                ends: [a, b],
                faces,
            } => {
                write!(
                    f,
                    "the edge {a}-{b} has {} faces: {}",
                    faces.len(),
                    list(faces.iter())
                )
            }
            Defect::FlippedFace {
                from,
                to,
                faces: [a, b],
            } => {
                write!(
                    f,
                    "{a} and {b} both run from {from} to {to}: one of them is flipped"
                )
            }
            Defect::BowTie { vertex, fans } => {
                write!(f, "{vertex} joins {} fans that share no edge:", fans.len())?;
                for (i, fan) in fans.iter().take(SHOWN).enumerate() {
                    write!(
                        f,
                        "{}{}",
                        if i == 0 { " " } else { " | " },
                        list(fan.iter())
                    )?;
                }
                if fans.len() > SHOWN {
                    write!(f, " | …")
                } else {
                    Ok(())
                }
            }
        }
    }
}

fn list(faces: impl ExactSizeIterator<Item = FaceId>) -> String {
    let more = faces.len().saturating_sub(SHOWN);
    let mut text: Vec<String> = faces.take(SHOWN).map(|face| face.to_string()).collect();
    if more > 0 {
        text.push(format!("and {more} more"));
    }
    text.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_length_are_read_as_they_were_written() {
        let numbers = [0, 1, 127, 128, 16_383, 16_384, 1 << 21, 1 << 28, u32::MAX];
        let mut bytes = Vec::new();
        for number in numbers {
            put(&mut bytes, number);
        }
        let mut rest = &bytes[..];
        assert_eq!(numbers.map(|_| take(&mut rest)), numbers);
        assert_eq!(rest, []);
    }

    #[test]
    fn a_record_is_small() {
        assert!(size_of::<Record>() <= 24);
    }
}
