//! A document together with all edits of its mesh.
//!
//! A [`TornDocument`] replays the log of a mesh and keeps everything in step that the file has
//! and the mesh has not: which texture coordinate and normal each corner has, in
//! which group and material each face lies, the colours and weights of vertices; and which
//! cut parted what, so that it can be undone in another session.

mod ancestry;
mod corners;
mod turns;

pub(crate) use self::ancestry::Distances;
pub(crate) use self::corners::{Slots, length, normal_between, numbers_between};

use std::borrow::Cow;
use std::collections::BTreeSet;

use tearmesh::{
    Blend, Cursor, Edit, FaceId, Follower, Insert, InsertedPoint, Mix, Point, Positions, Slide,
    VertexId, VertexOp, mend::Stitch,
};

use self::ancestry::Ancestry;
use self::corners::Corners;
use crate::document::Document;
use crate::families::Families;
use crate::record::{Apart, Inserted, Record, Slid, SplitOff, is_same_point};

/// A document together with all edits of its mesh. It is a [`Follower`] of the mesh's log, and
/// writes the edited file.
///
/// A split moves corners. Each corner keeps its texture coordinate and normal, and neither is ever
/// duplicated. The children of a divided face take its place in the file, and so belong to its
/// object, group, material and smoothing group. The texture coordinate and normal of a new corner
/// are interpolated between those of the divided face *in that face*, so texture seams remain seams.
/// If both sides of an edge have the same two indices, both get the same new index, torn or not. If
/// the two indices are equal, the new one equals them.
///
/// * Texture coordinates are interpolated linearly; a missing number of one counts as 0. The numbers
///   of a `v` after z are interpolated linearly if all sources have equally many of them.
/// * A normal is interpolated linearly, and then scaled to the interpolated length of its sources,
///   so unit normals give a unit normal. Opposite normals give the normal of the first source.
/// * A corner has a texture coordinate or normal only if all its sources have one.
/// * The new vertex of a split has the extra numbers of the old vertex. A merged vertex has the extra
///   numbers of the vertex that is kept.
/// * If a vertex slides along an edge, the texture coordinates and normals of its corners at that edge
///   are interpolated, as are those of its other corners with the same values. The old values are
///   recorded as long as only the log moves the vertex.
///
/// ```
/// use tearmesh::{Edits, Positions, insert::Plan};
/// use tearmesh_obj::{Document, TornDocument};
///
/// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\ng seam\nf 1/1 2/2 3/3\n";
/// let document = Document::read(&file[..])?;
/// let mut mesh = document.mesh()?;
/// let mut positions = Positions::new(document.positions().iter().copied())?;
/// let mut torn = TornDocument::new(&document);
///
/// let mut plan = Plan::new();
/// plan.on_edge(mesh.half_edge(0), 0.5);
/// let mut edits = Edits::new();
/// plan.apply(&mut mesh, &mut edits)?;
/// edits.replay(&mut (&mut positions, &mut torn));
///
/// let mut out = Vec::new();
/// torn.write(&mesh, &positions, &mut out)?;
/// assert_eq!(
///     String::from_utf8(out)?,
///     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0\ng seam\n\
///      f 4/4 2/2 3/3\nf 3/3 1/1 4/4\n\
///      #tearmesh record 1 v 4 f 2 vt 3 4 vn 0 0 faces 6c8e819334246200\n\
///      #~ edge 4 1 1 2 0.5\n#~ parent 1 2 1 2 3\n#tearmesh end 2 e27dc3c3a447c600\n"
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TornDocument<'d> {
    document: &'d Document,
    seen: Cursor,
    /// The number of the cut whose edits are being followed.
    cut: u32,
    /// Whether anything was split or inserted since that number was given.
    cut_is_used: bool,
    ancestry: Ancestry,
    /// What the `v` of each vertex has behind z. Empty if the document has none of that at all.
    extras: Vec<Vec<f64>>,
    /// What was inserted, by class, ascending: vertices are classes.
    pub(crate) inserted: Vec<Inserted>,
    /// What became of faces, and of their corners.
    pub(crate) corners: Corners<'d>,
    /// Divided faces, by faces of the mesh and classes.
    pub(crate) families: Families,
    /// Vertices that slid, by the nodes of the ancestry.
    slides: Vec<Slid>,
    /// Where vertices are if nothing but the log moves them.
    places: Cow<'d, [Point]>,
    /// Where the `v` of vertices say that these are; `None` if none stands apart.
    shown: Option<Vec<Point>>,
}

impl<'d> TornDocument<'d> {
    /// Creates a torn document that has followed no edit yet. Linear in the document.
    #[must_use]
    pub fn new(document: &'d Document) -> TornDocument<'d> {
        let count = document.positions.len();
        let extras = (0..count).filter(|_| document.extras.len() > 0);
        let extras = extras.map(|v| document.extras.row(v).to_vec());
        let record = document.record.as_deref();
        let apart = record.filter(|record| !record.apart.is_empty());
        let shown = apart.map(|record| {
            let mut points = document.positions.clone();
            for apart in &record.apart {
                points[apart.vertex as usize] = apart.shown;
            }
            points
        });
        TornDocument {
            document,
            seen: Cursor::START,
            cut: record.map_or(0, Record::last_cut) + 1,
            cut_is_used: false,
            ancestry: Ancestry::new(count, record.map_or(&[], |record| &record.splits)),
            extras: extras.collect(),
            inserted: record.map_or(Vec::new(), |record| record.inserted.clone()),
            corners: Corners::new(document),
            families: record.map_or_else(Families::default, |record| record.families.clone()),
            slides: record.map_or(Vec::new(), |record| record.slides.clone()),
            places: Cow::Borrowed(&document.positions),
            shown,
        }
    }

    /// Sets the position in the mesh's log at which the mesh was that of the document. Edits before it
    /// are not followed. The default is [`Cursor::START`].
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> TornDocument<'d> {
        TornDocument { seen, ..self }
    }

    /// Returns the document as it was read, without the edits.
    #[must_use]
    pub fn document(&self) -> &'d Document {
        self.document
    }

    /// Starts the next cut, so that later edits can be undone separately from earlier ones. Does
    /// nothing if the current cut has no split, insertion or slide yet.
    ///
    /// The first cut has the number 1, or one more than the highest in the record of the file.
    ///
    /// # Panics
    ///
    /// If the number of the next cut would exceed [`u32::MAX`].
    pub fn next_cut(&mut self) {
        if std::mem::take(&mut self.cut_is_used) {
            self.cut = self.cut.checked_add(1).expect("less than 2^32 cuts");
        }
    }

    /// Returns the numbers of the cuts that still hold vertices apart, in ascending order.
    #[must_use]
    pub fn cuts(&self) -> Vec<u32> {
        let split_off = self.ancestry.split_off(|v| v).into_iter();
        let cuts: BTreeSet<u32> = split_off.map(|split| split.cut).collect();
        cuts.into_iter().collect()
    }

    /// Returns the stitches that undo the last `cuts` of [`TornDocument::cuts`], or all of these cuts if
    /// there are fewer.
    ///
    /// [`mend::sew`](tearmesh::mend::sew) sews them. To sew all tears, or those near a place, no record
    /// is needed: see [`mend::stitches`](tearmesh::mend::stitches).
    ///
    /// ```
    /// use tearmesh::{Edits, Positions, mend, split};
    /// use tearmesh_obj::{Document, TornDocument};
    ///
    /// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 3 2 4\n";
    /// let document = Document::read(&file[..])?;
    /// let mut mesh = document.mesh()?;
    /// let mut positions = Positions::new(document.positions().iter().copied())?;
    /// let mut torn = TornDocument::new(&document);
    /// let mut edits = Edits::new();
    /// for v in [1, 2] {
    ///     let (v, face) = (mesh.vertex(v), mesh.face(1));
    ///     split::vertex(&mut mesh, v, &[face], &mut edits)?;
    ///     edits.replay(&mut (&mut positions, &mut torn));
    ///     torn.next_cut();
    /// }
    /// let stitches = torn.stitches_of_last(1);
    /// assert_eq!((stitches[0].kept().index(), stitches[0].gone().index()), (2, 5));
    /// mend::sew(&mut mesh, &positions, &stitches, |_| 1.0, 0.0, &mut edits)?;
    /// edits.replay(&mut (&mut positions, &mut torn));
    /// assert_eq!((mesh.vertex_count(), torn.cuts()), (5, vec![1]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn stitches_of_last(&self, cuts: usize) -> Vec<Stitch> {
        let all = self.cuts();
        let last = &all[all.len().saturating_sub(cuts)..];
        let split_off = self.ancestry.split_off(|v| v).into_iter();
        let of_last = split_off.filter(|split| last.contains(&split.cut));
        of_last
            .filter_map(|split| {
                let [from, vertex] = [split.from, split.vertex].map(|v| VertexId::new(v as usize));
                Stitch::new(from?, vertex?)
            })
            .collect()
    }

    /// Sets the points at which vertices are written, by vertex index. Writing the two sides of a cut
    /// apart makes the cut visible, and prevents other programs from joining them again. The record
    /// has both points, and reading the file restores the true positions.
    ///
    /// Later edits in the log change these points as they change the true positions. A merged vertex
    /// is written at its true position again.
    ///
    /// # Panics
    ///
    /// If the number of points is not [`TornDocument::vertex_count`].
    ///
    /// ```
    /// use tearmesh::{Edits, Point, Positions, split};
    /// use tearmesh_obj::{Document, TornDocument};
    ///
    /// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 3 2 4\n";
    /// let document = Document::read(&file[..])?;
    /// let mut mesh = document.mesh()?;
    /// let mut positions = Positions::new(document.positions().iter().copied())?;
    /// let mut torn = TornDocument::new(&document);
    /// let mut edits = Edits::new();
    /// for v in [1, 2] {
    ///     let (v, face) = (mesh.vertex(v), mesh.face(1));
    ///     split::vertex(&mut mesh, v, &[face], &mut edits)?;
    /// }
    /// edits.replay(&mut (&mut positions, &mut torn));
    ///
    /// let mut points = positions.as_slice().to_vec();
    /// points[4] = Point::new(1.0, 0.125, 0.0);
    /// torn.set_apart(points);
    /// let mut out = Vec::new();
    /// torn.write(&mesh, &positions, &mut out)?;
    /// let text = String::from_utf8(out)?;
    /// assert!(text.contains("\nv 1 0.125 0\n") && text.contains("\n#~ apart 5 1 0 0 1 0.125 0\n"));
    /// assert_eq!(Document::read(text.as_bytes())?.positions(), positions.as_slice());
    ///
    /// torn.set_in_place(|v| v.index() == 4);
    /// let mut out = Vec::new();
    /// torn.write(&mesh, &positions, &mut out)?;
    /// assert!(!String::from_utf8(out)?.contains("#~ apart"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_apart(&mut self, points: Vec<Point>) {
        assert_eq!(
            points.len(),
            self.vertex_count(),
            "there is a point for each vertex"
        );
        self.shown = Some(points);
    }

    /// Writes vertices where they are, although they were to be written apart.
    pub fn set_in_place(&mut self, is_in_place: impl Fn(VertexId) -> bool) {
        let shown = self.shown.iter_mut().flatten();
        let shown = shown.zip(self.places.iter()).enumerate();
        for (v, (shown, place)) in shown {
            if VertexId::new(v).is_some_and(&is_in_place) {
                *shown = *place;
            }
        }
    }

    /// Returns the points at which [`TornDocument::write`] writes the vertices, by vertex index. They
    /// are the positions, except where the two sides of a cut are written apart: see
    /// [`TornDocument::set_apart`].
    #[must_use]
    pub fn written_points<'p>(&self, positions: &'p Positions) -> Cow<'p, [Point]> {
        let mut points = Cow::Borrowed(positions.as_slice());
        for apart in self.apart(positions) {
            points.to_mut()[apart.vertex as usize] = apart.shown;
        }
        points
    }

    /// The vertices that are written apart, ascending: none if anything but the log moved a vertex.
    pub(crate) fn apart(&self, positions: &Positions) -> Vec<Apart> {
        let Some(shown) = &self.shown else {
            return Vec::new();
        };
        let mut all = self.places.iter().zip(positions.as_slice());
        if !all.all(|(&place, &is)| is_same_point(place, is)) {
            return Vec::new();
        }
        let all = positions.as_slice().iter().zip(shown).zip(0..);
        let all = all.map(|((&is, &shown), vertex)| Apart { vertex, is, shown });
        all.filter(|apart| !is_same_point(apart.is, apart.shown))
            .collect()
    }

    /// Returns the number of vertices of the mesh after the edits followed so far.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.ancestry.len()
    }

    /// Returns the number of faces of the mesh after the edits followed so far.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.corners.slots.len()
    }

    /// Returns the faces of the mesh in the order in which they are written. The children of a divided
    /// face, ordered by id, take its place. Face `i` of a mesh that is read from the written file is
    /// the face at index `i` of this list.
    #[must_use]
    pub fn faces_in_order(&self) -> Vec<FaceId> {
        let slots = self.corners.slots();
        let faces = slots.faces.iter();
        faces.filter_map(|&f| FaceId::new(f as usize)).collect()
    }

    fn insert(&mut self, insert: &Insert<'_>) {
        if insert.points.is_empty() {
            return;
        }
        let mut before: Option<&InsertedPoint> = None;
        let mut distances = None;
        for point in insert.points {
            match before.and_then(|twin| self.nodes_of_twins(twin, point)) {
                Some(sides) => {
                    // The two sides of a torn edge are apart since the older cut at its ends.
                    let distances = distances.get_or_insert_with(|| self.ancestry.distances());
                    let since = sides.map(|[one, other]| distances.apart_since(one, other));
                    let cut = since[0].min(since[1]);
                    self.ancestry.split(self.ancestry.len() - 1, cut);
                    before = None;
                }
                None => {
                    let class = |v: VertexId| self.ancestry.class(v.index());
                    let (between, weights) = match point.at {
                        Mix::Between { ends, t } => {
                            let [a, b] = ends.map(class);
                            ([a, b, b], [1.0 - t, t, 0.0])
                        }
                        Mix::Weighted { of, weights } => (of.map(class), weights),
                        Mix::Copy(v) => unreachable!("{v} was inserted nowhere"),
                        _ => unreachable!("there is no other mix"),
                    };
                    self.inserted.push(Inserted {
                        vertex: self.ancestry.class_count() as u32,
                        cut: self.cut,
                        between,
                        weights,
                    });
                    self.ancestry.insert();
                    before = Some(point);
                }
            }
        }
        let class = |v: VertexId| self.ancestry.class(v.index());
        self.corners.insert(insert, class, &mut self.families);
        self.cut_is_used = true;
    }

    /// All numbers of the `v` of a vertex, if nothing but the log moves it.
    fn numbers(&self, v: VertexId) -> Vec<f64> {
        let place: [f64; 3] = self.places[v.index()].into();
        [&place, self.extra_numbers(v.index())].concat()
    }

    /// Follows a vertex that slid, and had these numbers before.
    fn slide(&mut self, slide: &Slide<'_>, before: &[f64]) {
        let numbers = [before, &self.numbers(slide.vertex)].concat();
        self.slides.push(Slid {
            vertex: self.ancestry.node(slide.vertex.index()),
            cut: self.cut,
            numbers,
            exchanges: self.corners.slide(slide),
        });
        self.cut_is_used = true;
    }

    /// Follows an edit with the extra numbers. Of two vertices that are merged, the one that is kept keeps
    /// its numbers, whatever the other one has.
    fn follow_extras(&mut self, edit: &Edit<'_>) {
        if self.extras.is_empty() {
            return;
        }
        for op in edit.vertex_ops() {
            // Where sources do not have as many numbers as each other, there are none between them: a new
            // vertex has none, and one that is set keeps its own.
            let own = match op {
                VertexOp::Set { .. } if matches!(edit, Edit::Merge(_)) => continue,
                VertexOp::Set { at, .. } => self.extras[at.index()].clone(),
                VertexOp::Push { .. } | VertexOp::SwapRemove { .. } => Vec::new(),
                _ => unreachable!("there is no other change"),
            };
            op.apply(&mut self.extras, |mix| {
                mixed(mix).unwrap_or_else(|| own.clone())
            });
        }
    }

    /// Follows an edit with where vertices stand, once where they are has.
    fn follow_apart(&mut self, edit: &Edit<'_>) {
        let Some(shown) = &mut self.shown else {
            return;
        };
        for op in edit.vertex_ops() {
            op.apply(shown, Blend::blend);
        }
        if let Edit::Merge(merge) = edit {
            shown[merge.kept.index()] = self.places[merge.kept.index()];
        }
    }

    /// The nodes of the vertices on both sides of a torn edge, at each of its ends, if these two points are
    /// on both sides of one: the same place of an edge between the same roots.
    fn nodes_of_twins(&self, one: &InsertedPoint, other: &InsertedPoint) -> Option<[[u32; 2]; 2]> {
        let (Mix::Between { ends, t }, Mix::Between { ends: others, t: u }) = (one.at, other.at)
        else {
            return None;
        };
        let sides = [0, 1].map(|end| [ends[end], others[end]].map(VertexId::index));
        let same = |[a, b]: [usize; 2]| self.ancestry.class(a) == self.ancestry.class(b);
        let are_twins = t == u && sides.into_iter().all(same);
        are_twins.then(|| sides.map(|side| side.map(|v| self.ancestry.node(v))))
    }

    /// What the `v` of a vertex has behind z.
    pub(crate) fn extra_numbers(&self, vertex: usize) -> &[f64] {
        self.extras.get(vertex).map_or(&[], Vec::as_slice)
    }
}

impl Follower for TornDocument<'_> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        let before = match edit {
            Edit::Slide(slide) => self.numbers(slide.vertex),
            Edit::Split(_) | Edit::Insert(_) | Edit::Merge(_) => Vec::new(),
            _ => unreachable!("there is no other edit"),
        };
        for op in edit.vertex_ops() {
            op.apply(self.places.to_mut(), Blend::blend);
        }
        self.follow_extras(edit);
        self.follow_apart(edit);
        match edit {
            Edit::Split(split) => {
                assert_eq!(
                    split.new.index(),
                    self.ancestry.len(),
                    "the document is in step with the mesh"
                );
                self.ancestry.split(split.old.index(), self.cut);
                self.cut_is_used = true;
            }
            Edit::Insert(insert) => self.insert(insert),
            Edit::Merge(merge) => self.ancestry.merge(merge.kept.index(), merge.gone.index()),
            Edit::Slide(slide) => self.slide(slide, &before),
            _ => unreachable!("there is no other edit"),
        }
    }
}

/// What is known of the faces and vertices, in terms of the mesh.
impl TornDocument<'_> {
    /// Vertices that slid, by their ids as they are now.
    pub(crate) fn slides(&self) -> Vec<Slid> {
        let mut slides = self.slides.clone();
        if !slides.is_empty() {
            let vertices = self.ancestry.vertices_of_nodes();
            for slid in &mut slides {
                slid.vertex = vertices[slid.vertex as usize];
            }
        }
        slides
    }

    /// What was split off, by these numbers of the vertices.
    pub(crate) fn split_off(&self, number: impl Fn(u32) -> u32) -> Vec<SplitOff> {
        self.ancestry.split_off(number)
    }

    /// The vertex of each class that comes first in an order; `u32::MAX` where there is none.
    pub(crate) fn roots_of_classes(&self, number: impl Fn(u32) -> u32) -> Vec<u32> {
        let mut roots = vec![u32::MAX; self.ancestry.class_count()];
        for v in 0..self.ancestry.len() as u32 {
            let root = &mut roots[self.ancestry.class(v as usize) as usize];
            if *root == u32::MAX || number(v) < number(*root) {
                *root = v;
            }
        }
        roots
    }

    /// The vertex of the document that a vertex is, or that it was split from, if it was.
    pub(crate) fn origin(&self, v: usize) -> Option<usize> {
        let [home, class] = [self.ancestry.node(v), self.ancestry.class(v)];
        let known = |&statement: &u32| (statement as usize) < self.document.positions.len();
        let origin = Some(home).filter(known).or(Some(class).filter(known));
        origin.map(|statement| statement as usize)
    }
}

/// What rows give, number by number; `None` if they are not of one length.
fn mixed(rows: Mix<&Vec<f64>>) -> Option<Vec<f64>> {
    let length = rows.nearest().len();
    let are_alike = rows.map(Vec::len) == rows.map(|_| length);
    let number = |i: usize| f64::blend(rows.map(|row| &row[i]));
    are_alike.then(|| (0..length).map(number).collect())
}
