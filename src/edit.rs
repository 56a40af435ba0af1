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
//! The log is flat: lists of all records lie one after the other in a few vectors, which
//! [`Edits::reserve`] can make room in beforehand, so that splits do not allocate.

mod record;

pub use record::{
    Child, Edit, Insert, InsertedPoint, Location, Merge, Renumbered, Slide, Source, Split, TornLink,
};

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
    links: Vec<TornLink>,
    points: Vec<InsertedPoint>,
    children: Vec<Child>,
    /// What few records have: the rest of insertions, merges and slides.
    inserts: Vec<InsertEnds>,
    merges: Vec<MergeRest>,
    slides: Vec<SlideRest>,
}

/// What was done, and where the record's lists end; they start where those of the record
/// before end.
#[derive(Clone, Copy, Debug)]
struct Record {
    kind: Kind,
    corners_end: usize,
    links_end: usize,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Split {
        old: VertexId,
        new: VertexId,
    },
    /// An index into `inserts`.
    Insert(u32),
    /// An index into `merges`.
    Merge(u32),
    /// An index into `slides`.
    Slide(u32),
}

#[derive(Clone, Copy, Debug)]
struct InsertEnds {
    points_end: usize,
    children_end: usize,
}

#[derive(Clone, Copy, Debug)]
struct MergeRest {
    kept: VertexId,
    gone: VertexId,
    share: f64,
    /// The vertex that took the id of `gone`, and where its corners start.
    renumbered: Option<(VertexId, usize)>,
}

#[derive(Clone, Copy, Debug)]
struct SlideRest {
    vertex: VertexId,
    toward: VertexId,
    t: f64,
    along: [Option<[HalfEdgeId; 2]>; 2],
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
        self.links.reserve(torn);
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
        (0..self.records.len()).map(|i| self.record(i))
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
        (skipped..self.records.len()).map(|i| self.record(i))
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
        self.links.clear();
        self.points.clear();
        self.children.clear();
        self.inserts.clear();
        self.merges.clear();
        self.slides.clear();
    }

    fn record(&self, i: usize) -> Edit<'_> {
        match self.records[i].kind {
            Kind::Split { old, new } => Edit::Split(self.split(i, old, new)),
            Kind::Insert(j) => Edit::Insert(self.insert(i, j as usize)),
            Kind::Merge(j) => Edit::Merge(self.merge(i, j as usize)),
            Kind::Slide(j) => Edit::Slide(self.slide(i, j as usize)),
        }
    }

    fn split(&self, i: usize, old: VertexId, new: VertexId) -> Split<'_> {
        let (corners, torn) = self.lists(i);
        Split {
            number: self.first + i as u64,
            old,
            new,
            corners,
            torn,
        }
    }

    fn insert(&self, i: usize, j: usize) -> Insert<'_> {
        let start = j.checked_sub(1).map(|before| self.inserts[before]);
        let (points_start, children_start) =
            start.map_or((0, 0), |ends| (ends.points_end, ends.children_end));
        let ends = self.inserts[j];
        Insert {
            number: self.first + i as u64,
            points: &self.points[points_start..ends.points_end],
            children: &self.children[children_start..ends.children_end],
        }
    }

    fn merge(&self, i: usize, j: usize) -> Merge<'_> {
        let (corners, sewn) = self.lists(i);
        let MergeRest {
            kept,
            gone,
            share,
            renumbered,
        } = self.merges[j];
        let start = self.records[i].corners_end - corners.len();
        let moved = renumbered.map_or(corners.len(), |(_, at)| at - start);
        let (corners, others) = corners.split_at(moved);
        Merge {
            number: self.first + i as u64,
            kept,
            gone,
            share,
            corners,
            renumbered: renumbered.map(|(from, _)| Renumbered {
                from,
                to: gone,
                corners: others,
            }),
            sewn,
        }
    }

    fn slide(&self, i: usize, j: usize) -> Slide<'_> {
        let SlideRest {
            vertex,
            toward,
            t,
            along,
        } = self.slides[j];
        Slide {
            number: self.first + i as u64,
            vertex,
            toward,
            t,
            along,
            corners: self.lists(i).0,
        }
    }

    /// The corners and links of a record.
    fn lists(&self, i: usize) -> (&[HalfEdgeId], &[TornLink]) {
        let before = i.checked_sub(1).map(|before| self.records[before]);
        let (corners_start, links_start) =
            before.map_or((0, 0), |before| (before.corners_end, before.links_end));
        let Record {
            corners_end,
            links_end,
            ..
        } = self.records[i];
        (
            &self.corners[corners_start..corners_end],
            &self.links[links_start..links_end],
        )
    }

    /// Notes a corner of the split or merge that will be finished next.
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

    /// Notes a link that the split or merge to be finished next tore or sewed.
    #[inline]
    pub(crate) fn note_link(&mut self, link: TornLink) {
        self.links.push(link);
    }

    /// Makes a record of what was noted since the last one.
    pub(crate) fn finish_split(&mut self, old: VertexId, new: VertexId) -> Split<'_> {
        self.finish(Kind::Split { old, new });
        self.split(self.records.len() - 1, old, new)
    }

    /// Makes a record of an insertion.
    pub(crate) fn finish_insert(
        &mut self,
        points: impl IntoIterator<Item = InsertedPoint>,
        children: impl IntoIterator<Item = Child>,
    ) -> Insert<'_> {
        self.points.extend(points);
        self.children.extend(children);
        let j = self.inserts.len();
        self.inserts.push(InsertEnds {
            points_end: self.points.len(),
            children_end: self.children.len(),
        });
        self.finish(Kind::Insert(j as u32));
        self.insert(self.records.len() - 1, j)
    }

    /// Makes a record of what was noted since the last one. `renumbered` is the vertex that
    /// took the id of `gone`; its corners were noted last, from that index on.
    pub(crate) fn finish_merge(
        &mut self,
        [kept, gone]: [VertexId; 2],
        share: f64,
        renumbered: Option<(VertexId, usize)>,
    ) -> Merge<'_> {
        let j = self.merges.len();
        self.merges.push(MergeRest {
            kept,
            gone,
            share,
            renumbered,
        });
        self.finish(Kind::Merge(j as u32));
        self.merge(self.records.len() - 1, j)
    }

    /// Makes a record of a slide, with the corners noted since the last one.
    pub(crate) fn finish_slide(
        &mut self,
        vertex: VertexId,
        toward: VertexId,
        t: f64,
        along: [Option<[HalfEdgeId; 2]>; 2],
    ) -> Slide<'_> {
        let j = self.slides.len();
        self.slides.push(SlideRest {
            vertex,
            toward,
            t,
            along,
        });
        self.finish(Kind::Slide(j as u32));
        self.slide(self.records.len() - 1, j)
    }

    fn finish(&mut self, kind: Kind) {
        self.records.push(Record {
            kind,
            corners_end: self.corners.len(),
            links_end: self.links.len(),
        });
    }
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
