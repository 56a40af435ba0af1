//! Ids of vertices, half-edges and faces.
//!
//! Each id is a newtype over `u32`, so that the three kinds cannot be mixed up
//! and half of the memory of a `usize` is saved. A half-edge needs no record of
//! its own: the half-edges of face `f` are `3f`, `3f + 1` and `3f + 2`, so
//! `face`, `next` and `prev` are arithmetic (see `mesh.rs`).

use std::fmt;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $letter:literal, $noun:literal, $limit:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(try_from = "u32", into = "u32"))]
        pub struct $name(u32);

        impl $name {
            /// The number of ids of this kind. Their indices run from 0 to `LIMIT - 1`.
            pub const LIMIT: usize = $limit as usize;

            /// Returns the id with this index, or `None` if the index is [`Self::LIMIT`] or more.
            #[inline]
            #[must_use]
            pub const fn new(index: usize) -> Option<Self> {
                if index < Self::LIMIT { Some(Self(index as u32)) } else { None }
            }

            /// Returns the index of this id, counted from 0.
            #[inline]
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// The id with this index, of which there have to be more.
            #[inline]
            #[track_caller]
            pub(crate) fn among(count: usize, index: usize) -> Self {
                let what = concat!("is not a ", $noun, " of this mesh, which has");
                assert!(index < count, "I2: {}{index} {what} {count}", $letter);
                Self(index as u32)
            }

            /// The entry of this id in a table with one for each.
            #[inline]
            #[track_caller]
            pub(crate) fn of<T>(self, table: &[T]) -> &T {
                match table.get(self.index()) {
                    Some(entry) => entry,
                    None => self.is_foreign(table.len()),
                }
            }

            #[cold]
            #[track_caller]
            pub(crate) fn is_foreign(self, count: usize) -> ! {
                let noun = $noun;
                panic!("I2: {self} is not a {noun} of this mesh, which has {count}")
            }

            /// The id whose index is known to fit: every mesh keeps its counts
            /// below the limits of its ids (I1).
            #[inline]
            pub(crate) const fn from_u32(index: u32) -> Self {
                Self(index)
            }

            #[inline]
            pub(crate) const fn to_u32(self) -> u32 {
                self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(self, f)
            }
        }

        impl TryFrom<u32> for $name {
            type Error = IdError;

            fn try_from(index: u32) -> Result<$name, IdError> {
                $name::new(index as usize).ok_or(IdError { index })
            }
        }

        impl From<$name> for u32 {
            fn from(id: $name) -> u32 {
                id.to_u32()
            }
        }
    };
}

/// The reason why a number is no id: it is beyond all ids of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct IdError {
    /// The number that was given.
    pub index: u32,
}

impl fmt::Display for IdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the index {} is beyond all ids", self.index)
    }
}

impl std::error::Error for IdError {}

id!(
    /// The id of a vertex, displayed as `v7`.
    ///
    /// A split appends a vertex and renumbers no other. A merge frees an id, which the last vertex may
    /// take.
    VertexId,
    "v",
    "vertex",
    u32::MAX
);
id!(
    /// The id of a half-edge, displayed as `h7`. It is also the id of the corner of the face at
    /// which the half-edge starts.
    HalfEdgeId,
    "h",
    "half-edge",
    u32::MAX
);
id!(
    /// The id of a face, which is always a triangle; displayed as `f7`.
    FaceId,
    "f",
    "face",
    u32::MAX / 3
);

impl HalfEdgeId {
    /// Returns the face that this half-edge belongs to.
    #[inline]
    #[must_use]
    pub const fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// Returns the corner of its face at which this half-edge starts: 0, 1 or 2.
    #[inline]
    #[must_use]
    pub const fn corner(self) -> usize {
        (self.0 % 3) as usize
    }

    /// Returns the next half-edge of the same face, which starts where this one ends.
    #[inline]
    #[must_use]
    pub const fn next(self) -> HalfEdgeId {
        HalfEdgeId(if self.0 % 3 == 2 {
            self.0 - 2
        } else {
            self.0 + 1
        })
    }

    /// The corners of its face at which this half-edge starts and ends, or if not `forward`, ends and
    /// starts.
    #[inline]
    pub(crate) const fn ends(self, forward: bool) -> [HalfEdgeId; 2] {
        if forward {
            [self, self.next()]
        } else {
            [self.next(), self]
        }
    }

    /// Returns the previous half-edge of the same face, which ends where this one starts.
    #[inline]
    #[must_use]
    pub const fn prev(self) -> HalfEdgeId {
        HalfEdgeId(if self.0.is_multiple_of(3) {
            self.0 + 2
        } else {
            self.0 - 1
        })
    }
}

impl FaceId {
    /// Returns the three half-edges of this face, each starting where the previous one ends.
    /// Half-edge `i` of face `f` has the index `3 f + i`.
    #[inline]
    #[must_use]
    pub const fn half_edges(self) -> [HalfEdgeId; 3] {
        [
            HalfEdgeId(3 * self.0),
            HalfEdgeId(3 * self.0 + 1),
            HalfEdgeId(3 * self.0 + 2),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_end_before_the_value_that_stands_for_none() {
        assert_eq!(VertexId::new(VertexId::LIMIT), None);
        assert_eq!(VertexId::new(7).map(VertexId::index), Some(7));
        assert_eq!(HalfEdgeId(7).to_string(), "h7");
    }
}
