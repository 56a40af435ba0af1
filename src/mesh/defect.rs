//! What can be wrong with triangles, and the list of it that a [`BuildError`] holds.
//!
//! A few bytes of input can make many defects with long lists of faces: in copies of one polygon
//! of n corners each face is listed some three times. So a [`BuildError`] lists a thousand defects of
//! a kind, and a hundred faces of a defect, and counts the rest: nobody reads more. What needs all of
//! them gets them one by one from [`Mesh::diagnose`](super::Mesh::diagnose).

use std::fmt;
use std::mem::{Discriminant, discriminant};

use crate::id::{FaceId, VertexId};

/// The reason why triangles were refused: a list of their defects, ordered by the variants of
/// [`Defect`] and then by ids. It is capped at [`BuildError::LISTED_MAX`] defects of each kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BuildError {
    /// Ascending.
    defects: Vec<Defect>,
    /// How many of each kind there are.
    counts: Vec<(Discriminant<Defect>, usize)>,
}

impl BuildError {
    /// The largest number of defects of one kind that are listed.
    pub const LISTED_MAX: usize = 1000;

    /// Returns the defects that are listed. There is always at least one.
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
    pub fn defects(&self) -> &[Defect] {
        &self.defects
    }

    /// Returns the number of all defects, whether listed or not.
    #[must_use]
    pub fn count(&self) -> usize {
        self.counts.iter().map(|&(_, count)| count).sum()
    }

    /// Returns whether there are more defects than are listed.
    #[must_use]
    pub fn is_capped(&self) -> bool {
        self.count() > self.defects.len()
    }

    /// Collects defects, of each kind in its order.
    pub(super) fn collect(visit: impl FnOnce(&mut dyn FnMut(Defect))) -> Option<BuildError> {
        let mut error = BuildError {
            defects: Vec::new(),
            counts: Vec::new(),
        };
        visit(&mut |defect| {
            let kind = discriminant(&defect);
            let known = error.counts.iter().position(|&(other, _)| other == kind);
            let at = known.unwrap_or_else(|| {
                error.counts.push((kind, 0));
                error.counts.len() - 1
            });
            error.counts[at].1 += 1;
            if error.counts[at].1 <= BuildError::LISTED_MAX {
                error.defects.push(defect);
            }
        });
        error.defects.sort_unstable();
        (!error.defects.is_empty()).then_some(error)
    }
}

/// One defect of the given triangles, with the ids concerned.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Defect {
    /// More vertices were given than a mesh can have.
    TooManyVertices {
        /// The number of vertices given.
        given: usize,
        /// The limit, [`Mesh::MAX_VERTICES`](super::Mesh::MAX_VERTICES).
        limit: usize,
    },
    /// More faces were given than a mesh can have.
    TooManyFaces {
        /// The number of faces given.
        given: usize,
        /// The limit, [`Mesh::MAX_FACES`](super::Mesh::MAX_FACES).
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
        /// The faces with these three vertices, in ascending order.
        faces: Faces,
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
        /// The faces on the edge, in ascending order.
        faces: Faces,
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
        fans: Fans,
    },
}

/// The faces of a [`Defect`], in ascending order. There is always at least one.
pub type Faces = Listed<FaceId>;

/// The fans that a [`Defect::BowTie`] lists. There are always at least two. The fan that contains
/// the smallest face comes first.
pub type Fans = Listed<Faces>;

/// What a [`Defect`] lists, which is never nothing.
///
/// A list of a [`BuildError`] that has more than [`Faces::LISTED_MAX`] holds the first ones and the last.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Listed<T> {
    listed: Vec<T>,
    count: usize,
}

impl<T> Listed<T> {
    fn of(all: impl Iterator<Item = T>, count: usize, most: usize) -> Listed<T> {
        let listed = all.enumerate();
        let listed = listed.filter(|&(i, _)| is_listed(i, count, most));
        Listed {
            listed: listed.map(|(_, one)| one).collect(),
            count,
        }
    }

    /// Returns the number of all, whether listed or not.
    #[expect(clippy::len_without_is_empty, reason = "it is never empty")]
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }
}

impl Faces {
    /// The largest number of faces, and of fans, that a defect of a [`BuildError`] lists.
    pub const LISTED_MAX: usize = 100;

    /// The faces of half-edges, at most `most` of them.
    pub(super) fn of_half_edges(half_edges: &[u32], most: usize) -> Faces {
        let faces = half_edges.iter().map(|h| FaceId::from_u32(h / 3));
        Listed::of(faces, half_edges.len(), most)
    }

    /// Returns an iterator over the faces that are listed.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = FaceId> + DoubleEndedIterator + Clone {
        self.listed.iter().copied()
    }

    /// Returns the smallest face.
    #[must_use]
    pub fn first(&self) -> FaceId {
        self.listed[0]
    }
}

impl Fans {
    /// The fans of corners, at most `most` of them and of the faces of each.
    pub(super) fn of_corners<'c>(
        fans: impl Iterator<Item = &'c [u32]> + Clone,
        most: usize,
    ) -> Fans {
        let count = fans.clone().count();
        Listed::of(fans.map(|fan| Faces::of_half_edges(fan, most)), count, most)
    }

    /// Returns an iterator over the fans that are listed, each given as its faces.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Faces> + DoubleEndedIterator + Clone {
        self.listed.iter()
    }
}

/// Whether number `i` of `count` items is in a list of at most `most`, which has the first and the last.
fn is_listed(i: usize, count: usize, most: usize) -> bool {
    count <= most || i + 1 < most || i + 1 == count
}

/// How many defects, and how many faces of one, a message shows.
const SHOWN: usize = 20;

impl fmt::Display for BuildError {
    /// A line for each of the first twenty defects.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.count();
        let plural = if count == 1 { "" } else { "s" };
        write!(f, "not an oriented 2-manifold: {count} defect{plural}")?;
        for defect in self.defects.iter().take(SHOWN) {
            write!(f, "\n  {defect}")?;
        }
        if count > SHOWN {
            write!(f, "\n  and {} more", count - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for BuildError {}

impl<T: fmt::Debug> fmt::Debug for Listed<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.listed.fmt(f)
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
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
                let faces = list(faces.len(), faces.iter());
                write!(f, "the vertices {a}, {b}, {c} have several faces: {faces}")
            }
            Defect::Pillow {
                vertices: [a, b, c],
                faces,
            } => {
                let faces = list(2, faces.iter().copied());
                write!(f, "two faces lie back to back on {a}, {b}, {c}: {faces}")
            }
            Defect::CrowdedEdge {
                ends: [a, b],
                faces,
            } => {
                let (count, faces) = (faces.len(), list(faces.len(), faces.iter()));
                write!(f, "the edge {a}-{b} has {count} faces: {faces}")
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
                let shown = fans.iter().take(SHOWN);
                let mut shown: Vec<String> = shown.map(|fan| list(fan.len(), fan.iter())).collect();
                if fans.len() > SHOWN {
                    shown.push("…".to_owned());
                }
                write!(f, " {}", shown.join(" | "))
            }
        }
    }
}

fn list(count: usize, faces: impl Iterator<Item = FaceId>) -> String {
    let mut text: Vec<String> = faces.take(SHOWN).map(|face| face.to_string()).collect();
    if count > SHOWN {
        text.push(format!("and {} more", count - SHOWN));
    }
    text.join(", ")
}
