//! The log of what was changed, and those who replay it.
//!
//! An operation on a mesh appends a record to [`Edits`]. Whoever keeps data beside the
//! mesh (positions, masses, texture coordinates, particles, a GPU buffer) is a
//! [`Follower`] and replays the records when it suits; nobody registers a callback, and a
//! floor below never calls a floor above. A new cloth model is one new follower, which is what
//! makes the technique "easily adapted to nearly any cloth model" (Souza et al. 2014 §I).
//!
//! A record is self-contained: a follower never looks at the mesh, which is already
//! further on. Records are numbered from 0 for ever; a follower remembers the next number it
//! wants, so nothing is applied twice, and a gap is a panic that names it.
//!
//! The log is flat: three vectors, which [`Edits::reserve`] can fill up beforehand, so
//! that splits do not allocate.

use crate::id::{HalfEdgeId, VertexId};

/// The log of edits.
///
/// ```
/// use tearmesh::{shapes, split, Edits, Plane, Positions, Vector, VertexId};
///
/// let (mut mesh, mut positions) = shapes::grid(2, 2);
/// let mut edits = Edits::new();
/// let centre = VertexId::new(4).unwrap();
/// let plane = Plane::new(positions.at(centre), Vector::x())?;
/// split::by_plane(&mut mesh, centre, &plane, &positions, &mut edits);
/// edits.replay(&mut positions);
/// assert_eq!(positions.len(), mesh.vertex_count());
/// # Ok::<(), tearmesh::PlaneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Edits {
    /// The number of the oldest record that is still here.
    first: u64,
    records: Vec<Record>,
    corners: Vec<HalfEdgeId>,
    torn: Vec<TornLink>,
}

/// Where a record's lists end; they start where those of the record before end.
#[derive(Clone, Copy, Debug)]
struct Record {
    old: VertexId,
    new: VertexId,
    corners_end: usize,
    torn_end: usize,
}

impl Edits {
    /// An empty log, whose first record will have number 0.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes room for this many splits with, in all, so many moved corners and newly
    /// torn links. A corner moves with each split that moves it, and a link tears once.
    pub fn reserve(&mut self, splits: usize, corners: usize, torn: usize) {
        self.records.reserve(splits);
        self.corners.reserve(corners);
        self.torn.reserve(torn);
    }

    /// The number of records in the log.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether the log has no record.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The number that the next record will have. A follower made now starts here.
    #[must_use]
    pub fn next_number(&self) -> u64 {
        self.first + self.records.len() as u64
    }

    /// The records, oldest first.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Edit<'_>> + DoubleEndedIterator {
        (0..self.records.len()).map(|i| Edit::Split(self.record(i)))
    }

    /// The records from this number on, oldest first.
    ///
    /// # Panics
    ///
    /// If a record from there on was cleared.
    #[must_use]
    pub fn since(
        &self,
        number: u64,
    ) -> impl ExactSizeIterator<Item = Edit<'_>> + DoubleEndedIterator {
        assert!(
            number >= self.first,
            "edits {number} to {} were cleared before they were replayed",
            self.first
        );
        let skipped = (number - self.first).min(self.records.len() as u64) as usize;
        (skipped..self.records.len()).map(|i| Edit::Split(self.record(i)))
    }

    /// Brings a follower, or a tuple of them, up to date: each sees every record it has
    /// not yet seen, in order.
    ///
    /// # Panics
    ///
    /// If records that a follower has not seen were cleared, or if it does not
    /// count the record it was given.
    pub fn replay<F: Follower + ?Sized>(&self, follower: &mut F) {
        for edit in self.since(follower.next_edit()) {
            follower.follow(&edit);
            assert!(
                follower.next_edit() > edit.number(),
                "a follower counts the edits it follows"
            );
        }
    }

    /// Forgets the records, and keeps the memory and the numbering. Replay first.
    pub fn clear(&mut self) {
        self.first = self.next_number();
        self.records.clear();
        self.corners.clear();
        self.torn.clear();
    }

    fn record(&self, i: usize) -> Split<'_> {
        let Record {
            old,
            new,
            corners_end,
            torn_end,
        } = self.records[i];
        let (corners_start, torn_start) = match i.checked_sub(1).map(|before| self.records[before])
        {
            Some(before) => (before.corners_end, before.torn_end),
            None => (0, 0),
        };
        Split {
            number: self.first + i as u64,
            old,
            new,
            corners: &self.corners[corners_start..corners_end],
            torn: &self.torn[torn_start..torn_end],
        }
    }

    /// Notes a corner of the split that [`Edits::finish_split`] will complete.
    #[inline]
    pub(crate) fn note_corner(&mut self, h: HalfEdgeId) {
        self.corners.push(h);
    }

    /// Where the corners noted since the last record are.
    pub(crate) fn noted(&self) -> std::ops::Range<usize> {
        self.records.last().map_or(0, |last| last.corners_end)..self.corners.len()
    }

    pub(crate) fn has_noted(&self) -> bool {
        !self.noted().is_empty()
    }

    /// Forgets the corners noted since the last record.
    pub(crate) fn discard_noted(&mut self) {
        self.corners.truncate(self.noted().start);
    }

    #[inline]
    pub(crate) fn corner(&self, i: usize) -> HalfEdgeId {
        self.corners[i]
    }

    /// Notes a torn link of the split that [`Edits::finish_split`] will complete.
    #[inline]
    pub(crate) fn note_torn(&mut self, link: TornLink) {
        self.torn.push(link);
    }

    /// Makes a record of what was noted since the last one.
    pub(crate) fn finish_split(&mut self, old: VertexId, new: VertexId) -> Split<'_> {
        self.records.push(Record {
            old,
            new,
            corners_end: self.corners.len(),
            torn_end: self.torn.len(),
        });
        self.record(self.records.len() - 1)
    }
}

/// One change of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Edit<'e> {
    /// A vertex was split.
    Split(Split<'e>),
}

impl Edit<'_> {
    /// The number of the record.
    #[must_use]
    pub fn number(&self) -> u64 {
        match self {
            Edit::Split(split) => split.number,
        }
    }
}

/// A vertex was split: some of its corners now belong to a new vertex at the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Split<'e> {
    /// The number of the record.
    pub number: u64,
    /// The vertex that was split. It keeps at least one face.
    pub old: VertexId,
    /// The new vertex, the last one of the mesh.
    pub new: VertexId,
    /// The corners that moved to the new vertex: at least one, in the order of a walk
    /// round the old vertex.
    pub corners: &'e [HalfEdgeId],
    /// The links that this split tore.
    pub torn: &'e [TornLink],
}

/// A pair that became a ghost pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TornLink {
    /// The half-edge of a face that stayed.
    pub stayed: HalfEdgeId,
    /// Its opposite, of a face that moved.
    pub moved: HalfEdgeId,
}

/// Whoever keeps data beside a mesh and brings it up to date from the log.
///
/// ```
/// use tearmesh::{Edit, Follower};
///
/// /// Velocities of a simulation of one's own: a new vertex has that of the old one.
/// struct Velocities { of: Vec<[f64; 3]>, next: u64 }
///
/// impl Follower for Velocities {
///     fn next_edit(&self) -> u64 {
///         self.next
///     }
///     fn follow(&mut self, edit: &Edit<'_>) {
///         if let Edit::Split(split) = edit {
///             self.of.push(self.of[split.old.index()]);
///         }
///         self.next = edit.number() + 1;
///     }
/// }
/// ```
pub trait Follower {
    /// The number of the first record that this follower has not seen.
    fn next_edit(&self) -> u64;

    /// Takes in the record with the number [`Follower::next_edit`], and counts it.
    fn follow(&mut self, edit: &Edit<'_>);
}

impl<F: Follower + ?Sized> Follower for &mut F {
    fn next_edit(&self) -> u64 {
        (**self).next_edit()
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        (**self).follow(edit);
    }
}

macro_rules! tuple_of_followers {
    ($($name:ident $index:tt),+) => {
        /// Each follower of a tuple sees what it has not yet seen.
        impl<$($name: Follower),+> Follower for ($($name,)+) {
            fn next_edit(&self) -> u64 {
                [$(self.$index.next_edit()),+].into_iter().fold(u64::MAX, u64::min)
            }

            fn follow(&mut self, edit: &Edit<'_>) {
                $(if self.$index.next_edit() == edit.number() {
                    self.$index.follow(edit);
                })+
            }
        }
    };
}

tuple_of_followers!(A 0, B 1);
tuple_of_followers!(A 0, B 1, C 2);
tuple_of_followers!(A 0, B 1, C 2, D 3);
