//! The log of edits, and the followers that replay it.
//!
//! An operation on a mesh appends a record to [`Edits`]. Anything that keeps data beside the mesh
//! (positions, masses, texture coordinates, particles, a GPU buffer) is a [`Follower`], and replays
//! the records when it suits. There are no callbacks, and a lower layer never calls a higher one. A
//! new cloth model is one new follower, which is what makes the technique "easily adapted to nearly
//! any cloth model" (Souza et al. 2014 §I).
//!
//! A record is self-contained: a follower never looks at the mesh, which may have changed again
//! since. A follower holds a [`Cursor`], its place in the log, which replaying advances. So no
//! record is applied twice. A follower that is too late, or has followed another log, is caught by
//! a panic that says so.
//!
//! A record can be read in two forms. [`Edit`] says what happened, for followers that need
//! structure: constraints, the record in a file, masses. For plain values there is a normal form
//! ([`VertexOp`], [`Edit::apply_to_corners`]): [`Edits::replay_vertices`] and its siblings bring
//! a list of any type up to date.
//!
//! The log is flat: the lists of all records lie one after another in a few vectors.
//! [`Edits::reserve`] makes room in them beforehand, so that splits do not allocate.

mod cursor;
mod form;
mod mix;
mod record;

pub use cursor::Cursor;
pub use form::VertexOp;
pub(crate) use form::divide_corners;
pub use mix::Mix;
pub use record::{
    ChildFace, Edit, Insert, InsertedPoint, Merge, Renumbered, Slide, Split, TornLink,
};

use std::ops::Range;

use crate::id::HalfEdgeId;
use crate::mesh::MeshSize;

/// The log of the edits of a mesh.
///
/// ```
/// use tearmesh::{shapes, split, Edits, Plane, Positions, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(2, 2);
/// let mut edits = Edits::new();
/// let centre = mesh.vertex(4);
/// let plane = Plane::new(positions.at(centre), Vector::x())?;
/// split::by_plane(&mut mesh, centre, &plane, &positions, &mut edits);
/// edits.replay(&mut positions);
/// assert_eq!(positions.len(), mesh.vertex_count());
/// # Ok::<(), tearmesh::PlaneError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Edits {
    /// After the last record.
    end: Cursor,
    records: Vec<Record>,
    lists: Lists,
}

/// The iterator over the records of a log: see [`Edits::iter`].
#[derive(Clone, Debug)]
pub struct EditsIter<'e> {
    edits: &'e Edits,
    left: Range<usize>,
}

impl<'e> Iterator for EditsIter<'e> {
    type Item = Edit<'e>;

    fn next(&mut self) -> Option<Edit<'e>> {
        self.left.next().map(|i| self.edits.record(i))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.left.size_hint()
    }
}

impl DoubleEndedIterator for EditsIter<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        self.left.next_back().map(|i| self.edits.record(i))
    }
}

impl ExactSizeIterator for EditsIter<'_> {}

impl<'e> IntoIterator for &'e Edits {
    type Item = Edit<'e>;
    type IntoIter = EditsIter<'e>;

    fn into_iter(self) -> EditsIter<'e> {
        self.iter()
    }
}

/// The lists of all records, one after another.
#[derive(Clone, Debug, Default)]
struct Lists {
    corners: Vec<HalfEdgeId>,
    links: Vec<TornLink>,
    points: Vec<InsertedPoint>,
    children: Vec<ChildFace>,
}

/// A record without its lists, and where these end; they start where those of the record before end.
#[derive(Clone, Copy, Debug)]
struct Record {
    edit: Edit<'static>,
    ends: Ends,
    /// Of the mesh before this record.
    size: MeshSize,
}

#[derive(Clone, Copy, Debug, Default)]
struct Ends {
    /// Of a merge, the corners that move; those of the vertex that is renumbered follow.
    moved: usize,
    corners: usize,
    links: usize,
    points: usize,
    children: usize,
}

impl Edits {
    /// Creates an empty log. Its first record will have the number 0.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates an empty log that continues another one, which ended at `cursor`: a mesh that was edited
    /// has one numbering of its edits.
    #[must_use]
    pub fn starting_at(cursor: Cursor) -> Self {
        Edits {
            end: cursor.known(),
            ..Self::default()
        }
    }

    /// Reserves memory for `splits` splits that together move `corners` corners and tear `torn`
    /// links. A corner counts once for each split that moves it. A link tears only once.
    pub fn reserve(&mut self, splits: usize, corners: usize, torn: usize) {
        self.records.reserve(splits);
        self.lists.corners.reserve(corners);
        self.lists.links.reserve(torn);
    }

    /// Returns the number of records in the log, without those that were cleared.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Returns whether the log has no record.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Returns the place after the last record. It is the cursor of a follower that has seen all
    /// edits.
    #[must_use]
    pub fn cursor(&self) -> Cursor {
        self.end
    }

    /// Returns the records, from the oldest to the newest.
    #[must_use]
    pub fn iter(&self) -> EditsIter<'_> {
        EditsIter {
            edits: self,
            left: 0..self.records.len(),
        }
    }

    /// Returns the records after the place `cursor`, from the oldest to the newest.
    ///
    /// # Panics
    ///
    /// If `cursor` is not a place in this log, if records after it were cleared, or if it is that of a
    /// follower that has seen no log yet, and a vertex slides.
    #[must_use]
    pub fn since(
        &self,
        cursor: Cursor,
    ) -> impl ExactSizeIterator<Item = Edit<'_>> + DoubleEndedIterator {
        let end = self.end.number();
        let first = end - self.records.len() as u64;
        let seen = cursor.number();
        assert!(
            cursor != Cursor::HALF_WAY,
            "half way: this follower panicked while it replayed, and some of its values may be those \
             from before an edit. Make them anew"
        );
        assert!(
            seen >= first,
            "late: this follower has seen {seen} edits of this log, and the first {first} were \
             cleared. Replay before `clear`. One whose values are those of the mesh as it is now \
             begins with `starting_at(edits.cursor())`"
        );
        assert!(
            seen <= end,
            "ahead: this follower has seen {seen} edits, and there are {end} in this log: it \
             followed another one. One whose values are those of this mesh begins with \
             `starting_at(edits.cursor())`"
        );
        let skipped = (seen - first) as usize;
        let next = self.records.get(skipped);
        assert!(
            cursor == next.map_or(self.end, |next| next.edit.before()),
            "foreign: this follower has seen {seen} edits, which are not the first {seen} of this \
             log: it followed another one. One whose values are those of this mesh begins with \
             `starting_at(edits.cursor())`"
        );
        let slid = |record: &Record| matches!(record.edit, Edit::Slide(_));
        assert!(
            !(cursor.is_assumed() && self.records[skipped..].iter().any(slid)),
            "new: this follower has seen no log, and this one slides a vertex, which values made before \
             it must follow and values made after it must not. Replay a new follower before the first \
             edit, or say where it begins with `starting_at`"
        );
        (skipped..self.records.len()).map(|i| self.record(i))
    }

    /// Replays the log for a follower, or for each follower of a tuple. Each one receives every
    /// record that it has not seen yet, in order, and its cursor advances to the end of the log.
    ///
    /// # Panics
    ///
    /// If a follower has seen the records of another log, if records that it has not seen were
    /// cleared, or if it is new and a vertex slides: its values may be those from before or after. The
    /// message names the cause and the method to call.
    pub fn replay<F: Followers + ?Sized>(&self, followers: &mut F) {
        followers.see(self);
    }

    /// Replays the log on a list of vertex values, and advances `seen` to the end of the log. `mix`
    /// computes a new value from the values that it derives from.
    ///
    /// Values may be of any type, and need not implement any trait of this crate.
    ///
    /// ```
    /// use tearmesh::{shapes, insert::Plan, Cursor, Edits, Mix};
    ///
    /// // The bone that moves each vertex: there is none between two bones.
    /// let (mut mesh, _) = shapes::grid(1, 1);
    /// let (mut bones, mut seen) = (vec![3, 3, 5, 5], Cursor::START);
    /// let mut edits = Edits::new();
    /// let mut plan = Plan::new();
    /// plan.on_edge(mesh.half_edge_of(mesh.vertices().next().unwrap()).unwrap(), 0.75);
    /// plan.apply(&mut mesh, &mut edits)?;
    /// edits.replay_vertices(&mut seen, &mut bones, |mix| *mix.nearest());
    /// assert_eq!(bones.len(), mesh.vertex_count());
    /// # Ok::<(), tearmesh::InsertRefusal>(())
    /// ```
    ///
    /// # Panics
    ///
    /// For the same reasons as [`Edits::replay`], or if `values` does not have one value for each vertex.
    pub fn replay_vertices<T>(
        &self,
        seen: &mut Cursor,
        values: &mut Vec<T>,
        mut mix: impl FnMut(Mix<&T>) -> T,
    ) {
        for edit in self.unseen(seen, values.len(), |size| size.vertices) {
            edit.vertex_ops().for_each(|op| op.apply(values, &mut mix));
        }
        *seen = self.end;
    }

    /// Replays the log on a list of corner values, three per face, and advances `seen` to the end
    /// of the log. `mix` computes a new value from the values that it derives from.
    ///
    /// When a vertex slides, its corners with equal values change together, so values must be
    /// comparable.
    ///
    /// # Panics
    ///
    /// For the same reasons as [`Edits::replay`], or if `values` does not have three values for each face.
    pub fn replay_corners<T: PartialEq>(
        &self,
        seen: &mut Cursor,
        values: &mut Vec<T>,
        mut mix: impl FnMut(Mix<&T>) -> T,
    ) {
        for edit in self.unseen(seen, values.len(), |size| 3 * size.faces) {
            edit.apply_to_corners(values, &mut mix);
        }
        *seen = self.end;
    }

    /// Replays the log on a list of face values, and advances `seen` to the end of the log. Each
    /// child of a divided face gets a copy of the face's value.
    ///
    /// # Panics
    ///
    /// For the same reasons as [`Edits::replay`], or if `values` does not have one value for each face.
    pub fn replay_faces<T: Clone>(&self, seen: &mut Cursor, values: &mut Vec<T>) {
        for edit in self.unseen(seen, values.len(), |size| size.faces) {
            edit.apply_to_faces(values);
        }
        *seen = self.end;
    }

    /// The records that a list has not seen, which has as many values as `expected` says of the mesh. Until
    /// `seen` is the end of the log it is half way.
    fn unseen(
        &self,
        seen: &mut Cursor,
        length: usize,
        expected: fn(MeshSize) -> u32,
    ) -> impl Iterator<Item = Edit<'_>> {
        let edits = self.since(*seen);
        let first = self.records.len() - edits.len();
        let expected = self.records.get(first).map(|next| expected(next.size));
        assert!(
            expected.is_none_or(|expected| length == expected as usize),
            "{}: there are {length}, not {expected:?}",
            form::IN_STEP
        );
        *seen = Cursor::HALF_WAY;
        edits
    }

    /// Removes all records, and keeps the allocated memory. Later records are numbered from where
    /// these end. All followers must replay the log first.
    pub fn clear(&mut self) {
        self.records.clear();
        self.lists.corners.clear();
        self.lists.links.clear();
        self.lists.points.clear();
        self.lists.children.clear();
    }

    fn record(&self, i: usize) -> Edit<'_> {
        self.lists.read(&self.records[i], self.ends_before(i))
    }

    /// Where the lists of record `i` start.
    fn ends_before(&self, i: usize) -> Ends {
        let before = i.checked_sub(1).map(|before| self.records[before].ends);
        before.unwrap_or_default()
    }

    /// Notes a corner of the split or merge that will be finished next.
    #[inline]
    pub(crate) fn note_corner(&mut self, h: HalfEdgeId) {
        self.lists.corners.push(h);
    }

    /// Where the corners noted since the last record are.
    pub(crate) fn noted(&self) -> Range<usize> {
        self.ends_before(self.records.len()).corners..self.lists.corners.len()
    }

    /// Forgets the corners noted since the last record.
    pub(crate) fn discard_noted(&mut self) {
        self.lists.corners.truncate(self.noted().start);
    }

    #[inline]
    pub(crate) fn corner(&self, i: usize) -> HalfEdgeId {
        self.lists.corners[i]
    }

    /// Notes a link that the split or merge to be finished next tore or sewed.
    #[inline]
    pub(crate) fn note_link(&mut self, link: TornLink) {
        self.lists.links.push(link);
    }

    /// Notes the points and children of the insertion to be finished next.
    pub(crate) fn note_insertion(&mut self, points: Vec<InsertedPoint>, children: Vec<ChildFace>) {
        self.lists.points.extend(points);
        self.lists.children.extend(children);
    }

    /// Makes a record of an edit after the last one, with what was noted since. Of the corners noted, those
    /// of a vertex that is renumbered begin at `moved`. `size` is that of the mesh before.
    pub(crate) fn finish(&mut self, edit: Edit<'static>, moved: usize, size: MeshSize) -> Edit<'_> {
        debug_assert_eq!(edit.before(), self.end);
        let starts = self.ends_before(self.records.len());
        let ends = Ends {
            moved,
            corners: self.lists.corners.len(),
            links: self.lists.links.len(),
            points: self.lists.points.len(),
            children: self.lists.children.len(),
        };
        let record = Record { edit, ends, size };
        self.records.push(record);
        let edit = self.lists.read(&record, starts);
        self.end = edit.after();
        edit
    }
}

impl Lists {
    /// A record with its lists, which start there.
    fn read(&self, record: &Record, starts: Ends) -> Edit<'_> {
        let Record { edit, ends, .. } = *record;
        let corners = &self.corners[starts.corners..ends.corners];
        let links = &self.links[starts.links..ends.links];
        match edit {
            Edit::Split(split) => Edit::Split(Split {
                corners,
                torn: links,
                ..split
            }),
            Edit::Insert(insert) => Edit::Insert(Insert {
                points: &self.points[starts.points..ends.points],
                children: &self.children[starts.children..ends.children],
                ..insert
            }),
            Edit::Merge(merge) => {
                let (corners, others) = corners.split_at(ends.moved - starts.corners);
                Edit::Merge(Merge {
                    corners,
                    renumbered: merge.renumbered.map(|renumbered| Renumbered {
                        corners: others,
                        ..renumbered
                    }),
                    sewn: links,
                    ..merge
                })
            }
            Edit::Slide(slide) => Edit::Slide(Slide { corners, ..slide }),
        }
    }
}

/// A type that keeps data beside a mesh and updates it from the log.
///
/// Plain values of vertices, corners and faces need no follower of their own:
/// [`Edits::replay_vertices`] and its siblings update any list, and [`PerVertex`](crate::PerVertex)
/// is such a list with its cursor. Implement a follower for data with more structure; it may
/// contain such lists:
///
/// ```
/// use tearmesh::{Cursor, Edit, Follower, Masses, Mix};
///
/// /// A simulation of one's own, whose velocities know nothing of this crate. Those that two
/// /// vertices had give one that keeps the momentum; masses keep themselves.
/// struct Cloth { velocities: Vec<[f32; 2]>, masses: Masses, seen: Cursor }
///
/// impl Follower for Cloth {
///     fn cursor(&mut self) -> &mut Cursor {
///         &mut self.seen
///     }
///     fn follow(&mut self, edit: &Edit<'_>) {
///         let sum = |a: f32, b: f32, t: f64| a + (b - a) * t as f32;
///         for op in edit.vertex_ops() {
///             op.apply(&mut self.velocities, |mix| match mix {
///                 Mix::Copy(v) => *v,
///                 Mix::Between { ends: [a, b], t } => [0, 1].map(|i| sum(a[i], b[i], t)),
///                 Mix::Weighted { of, weights } => {
///                     [0, 1].map(|i| (0..3).map(|j| of[j][i] * weights[j] as f32).sum())
///                 }
///                 _ => unimplemented!("a mix of a later version"),
///             });
///         }
///         edit.pass_on(&mut self.masses);
///     }
/// }
/// ```
pub trait Follower {
    /// Returns this follower's place in the log. [`Edits::replay`] advances it.
    fn cursor(&mut self) -> &mut Cursor;

    /// Applies the record that comes after the cursor. Only [`Edits::replay`] and [`Edit::pass_on`]
    /// may call this method; they advance the cursor afterwards.
    fn follow(&mut self, edit: &Edit<'_>);

    /// Sets the place in the log at which this follower's values are those of the mesh.
    #[must_use]
    fn starting_at(mut self, seen: Cursor) -> Self
    where
        Self: Sized,
    {
        *self.cursor() = seen;
        self
    }
}

impl<F: Follower + ?Sized> Follower for &mut F {
    fn cursor(&mut self) -> &mut Cursor {
        (**self).cursor()
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        (**self).follow(edit);
    }
}

impl Edit<'_> {
    /// Applies this record to one follower and advances its cursor. Use it in a follower that
    /// contains other followers.
    ///
    /// # Panics
    ///
    /// If the cursor of the follower is not the place before this record.
    pub fn pass_on<F: Follower + ?Sized>(&self, follower: &mut F) {
        let (seen, number) = (*follower.cursor(), self.number());
        assert!(
            seen == self.before(),
            "a follower that has seen {} edits was shown edit {number}, or one of another log",
            seen.number()
        );
        *follower.cursor() = Cursor::HALF_WAY;
        follower.follow(self);
        *follower.cursor() = self.after();
    }
}

/// One follower, or a tuple of up to six followers, each with its own cursor.
pub trait Followers {
    /// Applies to each follower the records that it has not seen yet. See [`Edits::replay`].
    fn see(&mut self, edits: &Edits);
}

impl<F: Follower + ?Sized> Followers for F {
    fn see(&mut self, edits: &Edits) {
        let unseen = edits.since(*self.cursor());
        *self.cursor() = Cursor::HALF_WAY;
        for edit in unseen {
            self.follow(&edit);
        }
        *self.cursor() = edits.cursor();
    }
}

/// Nobody follows.
impl Followers for () {
    fn see(&mut self, _: &Edits) {}
}

macro_rules! tuple_of_followers {
    ($($name:ident $index:tt),+) => {
        impl<$($name: Followers),+> Followers for ($($name,)+) {
            fn see(&mut self, edits: &Edits) {
                $(self.$index.see(edits);)+
            }
        }
    };
}

tuple_of_followers!(A 0, B 1);
tuple_of_followers!(A 0, B 1, C 2);
tuple_of_followers!(A 0, B 1, C 2, D 3);
tuple_of_followers!(A 0, B 1, C 2, D 3, E 4);
tuple_of_followers!(A 0, B 1, C 2, D 3, E 4, F 5);
