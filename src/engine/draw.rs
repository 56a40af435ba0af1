//! Vertex and index buffers for a GPU, with texture seams, updated only where the mesh changed.
//!
//! A GPU has one list of vertices, each with all of its attributes. A vertex of the mesh therefore
//! takes one *slot* of that list for each distinct value at its corners: usually one, and two along
//! a texture seam. A split adds slots. A merge removes some, and the last slot moves into the gap.
//! The buffers list which slots were written since the last query, so that an engine uploads only
//! those.
//!
//! ```text
//!      mesh            slots
//!      ╲ 0│1 ╱      ╲ v,0│v,1 ╱      Along a seam the corners of v have the value 0 on its left and 1 on
//!    ───╲ │ ╱───  ───╲   │   ╱───    its right: two slots. If v is split along the seam, the slot on the
//!        ╲│╱          ╲  │  ╱        right is w,1, and nothing is added; if v is split across it, there
//!         v            v,0 v,1       are v,0 v,1 w,0 and w,1.
//! ```

use crate::attribute::Blend;
use crate::edit::{Cursor, Edit, Follower, divide_corners};
use crate::geometry::{Point, max_abs};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// The vertex and index buffers of a mesh whose corners have values, such as texture coordinates.
/// They are a [`Follower`] of the mesh's log.
///
/// The index buffer holds the slot of each corner. Corners of one vertex with equal values share a
/// slot, and every slot has at least one corner. (A value that is not equal to itself, such as NaN,
/// never shares a slot.) In addition to the values, the buffers use 12 bytes per corner and at most
/// 20 bytes per slot.
///
/// ```
/// use tearmesh::engine::{DrawBuffers, draw_origin};
/// use tearmesh::{shapes, split, Edits};
///
/// let (mut mesh, mut positions) = shapes::grid(2, 2);
/// let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
/// let mut buffers = DrawBuffers::new(&mesh, uv.map(|p| [p.x as f32, p.y as f32]).collect());
/// let origin = draw_origin(positions.as_slice().iter().copied());
/// let mut on_gpu = buffers.places_f32(&positions, origin);
/// let mut index_buffer = buffers.indices().to_vec();
///
/// let (mut edits, v, face) = (Edits::new(), mesh.vertex(4), mesh.face(0));
/// split::vertex(&mut mesh, v, &[face], &mut edits)?;
/// edits.replay(&mut (&mut positions, &mut buffers));
///
/// let changes = buffers.take_changes();
/// assert_eq!((&changes.slots[..], changes.corners.len()), (&[9][..], 1)); // of 10 and 24
/// on_gpu.resize(buffers.len(), [0.0; 3]);
/// for &slot in &changes.slots {
///     on_gpu[slot as usize] = buffers.place_f32(slot, &positions, origin); // and buffers.value(slot)
/// }
/// index_buffer.resize(buffers.indices().len(), 0);
/// for &corner in &changes.corners {
///     index_buffer[corner as usize] = buffers.indices()[corner as usize];
/// }
/// assert_eq!(on_gpu, buffers.places_f32(&positions, origin));
/// assert_eq!(index_buffer, buffers.indices());
/// # Ok::<(), tearmesh::SplitRefusal>(())
/// ```
#[derive(Clone, Debug)]
pub struct DrawBuffers<T> {
    /// By corner.
    values: Vec<T>,
    /// The slot of each corner.
    indices: Vec<u32>,
    /// The corners of a slot are a ring: those before and behind each.
    rings: Vec<[u32; 2]>,
    slots: Vec<Slot>,
    /// The first slot of each vertex.
    slots_of: Vec<u32>,
    /// Slots that an edit left without a corner; none between edits.
    empty: Vec<u32>,
    changed_slots: Marks,
    changed_corners: Marks,
    seen: Cursor,
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    vertex: VertexId,
    /// Any of its corners.
    corner: u32,
    /// The next slot of its vertex.
    next: u32,
}

const NONE: u32 = u32::MAX;

/// The parts of the buffers that changed since the previous call of [`DrawBuffers::take_changes`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawChanges {
    /// The slots of the vertex buffer that changed, in ascending order. Slots that no longer exist
    /// may be listed; they lie beyond the end of the buffer.
    pub slots: Vec<u32>,
    /// The entries of the index buffer that changed, in ascending order. Entry `i` belongs to
    /// corner `i`.
    pub corners: Vec<u32>,
}

impl<T: Blend> DrawBuffers<T> {
    /// Creates the buffers from the values at the corners of a mesh, three per face, in the order
    /// of the half-edge ids. The buffers have seen no edit yet. Slots are ordered by vertex, and
    /// then by the first corner that uses them. O(n log n).
    ///
    /// # Panics
    ///
    /// If `corner_values` does not have one value for each corner.
    #[must_use]
    pub fn new(mesh: &Mesh, corner_values: Vec<T>) -> DrawBuffers<T> {
        let corners = mesh.half_edge_count();
        assert_eq!(corner_values.len(), corners, "a value for each corner");
        let mut buffers = DrawBuffers {
            values: corner_values,
            indices: vec![NONE; corners],
            rings: vec![[NONE; 2]; corners],
            slots: Vec::new(),
            slots_of: vec![NONE; mesh.vertex_count()],
            empty: Vec::new(),
            changed_slots: Marks::default(),
            changed_corners: Marks::default(),
            seen: Cursor::ASSUMED,
        };
        let mut by_vertex: Vec<HalfEdgeId> = mesh.half_edges().collect();
        by_vertex.sort_by_key(|&h| mesh.origin(h));
        for h in by_vertex {
            buffers.attach(h, mesh.origin(h));
        }
        let _all = buffers.take_changes();
        buffers
    }

    /// Reserves memory for `vertices` more vertices, so that replaying this many splits allocates
    /// nothing. Linear.
    pub fn reserve(&mut self, vertices: usize) {
        let corners = self.indices.len();
        self.slots_of.reserve(vertices);
        // Each slot has a corner, but for those that a split has left and not yet taken out: up to one for each
        // corner of a vertex.
        let mut corners_of = vec![0; self.slots_of.len()];
        for &slot in &self.indices {
            corners_of[self.slots[slot as usize].vertex.index()] += 1;
        }
        let slots = corners + corners_of.into_iter().max().unwrap_or(0);
        self.slots.reserve(slots - self.slots.len());
        self.empty.reserve(corners);
        self.changed_slots.reserve(slots);
        self.changed_corners.reserve(corners);
    }

    /// Returns the number of slots, which is the number of vertices in the GPU's vertex buffer.
    #[must_use]
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Returns whether the vertex buffer is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Returns the index buffer: the slot of each corner, three per face, in the order of the half-edge ids.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Returns the vertex of the mesh that a slot belongs to.
    ///
    /// # Panics
    ///
    /// If `slot` is not a slot of the buffers.
    #[must_use]
    pub fn vertex(&self, slot: u32) -> VertexId {
        self.slots[slot as usize].vertex
    }

    /// Returns the corner value that a slot holds.
    ///
    /// # Panics
    ///
    /// If `slot` is not a slot of the buffers.
    #[must_use]
    pub fn value(&self, slot: u32) -> &T {
        &self.values[self.slots[slot as usize].corner as usize]
    }

    /// Returns the vertex and the value of each slot, in the order of the slots.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (VertexId, &T)> {
        let slots = self.slots.iter();
        slots.map(|slot| (slot.vertex, &self.values[slot.corner as usize]))
    }

    /// Returns the position of a slot relative to `origin`, rounded to `f32`. For the origin, see [`draw_origin`].
    ///
    /// # Panics
    ///
    /// If `slot` is not a slot of the buffers, or `place` does not store the position of its vertex.
    #[must_use]
    pub fn place_f32(&self, slot: u32, place: &(impl Place + ?Sized), origin: Point) -> [f32; 3] {
        let point = place.at(self.vertex(slot)) - origin;
        [point.x as f32, point.y as f32, point.z as f32]
    }

    /// Returns the positions of all slots relative to `origin`, rounded to `f32`. Use it for a mesh whose vertices
    /// all move.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex.
    #[must_use]
    pub fn places_f32(&self, place: &(impl Place + ?Sized), origin: Point) -> Vec<[f32; 3]> {
        let slots = 0..self.slots.len() as u32;
        let places = slots.map(|slot| self.place_f32(slot, place, origin));
        places.collect()
    }

    /// Returns the changes that edits made since the previous call, and starts a new list. A slot
    /// counts as changed if an edit moved its vertex. Motion that is not in the log, such as that
    /// of a simulation, is not tracked.
    #[must_use = "each change is listed once"]
    pub fn take_changes(&mut self) -> DrawChanges {
        DrawChanges {
            slots: self.changed_slots.take(self.slots.len()),
            corners: self.changed_corners.take(self.indices.len()),
        }
    }

    /// Takes corners out of their slots: their values are about to change, or their vertices.
    fn detach(&mut self, corners: &[HalfEdgeId]) {
        for corner in corners {
            let slot = self.indices[corner.index()];
            let [before, behind] = self.rings[corner.index()];
            let corner = u32::from(*corner);
            if behind == corner {
                self.slots[slot as usize].corner = NONE;
                self.empty.push(slot);
            } else {
                self.rings[before as usize][1] = behind;
                self.rings[behind as usize][0] = before;
                self.slots[slot as usize].corner = behind;
            }
        }
    }

    /// Gives a corner that has no slot the one of its vertex with its value.
    fn attach(&mut self, h: HalfEdgeId, vertex: VertexId) {
        let corner = u32::from(h);
        let (mut found, mut empty) = (NONE, NONE);
        let mut slot = self.slots_of[vertex.index()];
        while slot != NONE && found == NONE {
            let Slot {
                corner: own, next, ..
            } = self.slots[slot as usize];
            if own == NONE {
                empty = slot;
            } else if self.values[own as usize] == self.values[h.index()] {
                found = slot;
            }
            slot = next;
        }
        if found != NONE {
            let behind = self.slots[found as usize].corner;
            let before = self.rings[behind as usize][0];
            self.rings[h.index()] = [before, behind];
            self.rings[before as usize][1] = corner;
            self.rings[behind as usize][0] = corner;
        } else {
            self.rings[h.index()] = [corner; 2];
            found = if empty == NONE {
                self.push(vertex)
            } else {
                empty
            };
            self.slots[found as usize].corner = corner;
            self.changed_slots.set(found);
        }
        if self.indices[h.index()] != found {
            self.indices[h.index()] = found;
            self.changed_corners.set(corner);
        }
    }

    fn push(&mut self, vertex: VertexId) -> u32 {
        let new = self.slots.len() as u32;
        let next = std::mem::replace(&mut self.slots_of[vertex.index()], new);
        let corner = NONE;
        self.slots.push(Slot {
            vertex,
            corner,
            next,
        });
        new
    }

    /// Takes out the slots that have no corner any more; the last ones move into the gaps.
    fn sweep(&mut self) {
        let mut empty = std::mem::take(&mut self.empty);
        // From the last on, so that the one that moves has a corner.
        empty.sort_unstable_by_key(|&slot| std::cmp::Reverse(slot));
        empty.dedup();
        for &slot in &empty {
            let Slot {
                vertex,
                corner,
                next,
            } = self.slots[slot as usize];
            if corner != NONE {
                continue; // It has one again.
            }
            self.rename(vertex, slot, next);
            let last = self.slots.len() as u32 - 1;
            if slot != last {
                let moved = self.slots[last as usize];
                self.rename(moved.vertex, last, slot);
                let mut corner = moved.corner;
                loop {
                    self.indices[corner as usize] = slot;
                    self.changed_corners.set(corner);
                    corner = self.rings[corner as usize][1];
                    if corner == moved.corner {
                        break;
                    }
                }
                self.changed_slots.set(slot);
            }
            self.slots.swap_remove(slot as usize);
        }
        empty.clear();
        self.empty = empty; // Its memory is kept.
    }

    /// In the list of a vertex, puts another slot in the place of one.
    fn rename(&mut self, vertex: VertexId, slot: u32, to: u32) {
        let mut link = &mut self.slots_of[vertex.index()];
        while *link != slot {
            let before = *link as usize;
            link = &mut self.slots[before].next;
        }
        *link = to;
    }

    /// Notes that a vertex is elsewhere.
    fn moved(&mut self, vertex: VertexId) {
        let mut slot = self.slots_of[vertex.index()];
        while slot != NONE {
            self.changed_slots.set(slot);
            slot = self.slots[slot as usize].next;
        }
    }

    fn relabel(&mut self, corners: &[HalfEdgeId], to: VertexId) {
        self.detach(corners);
        corners.iter().for_each(|&h| self.attach(h, to));
        self.sweep();
    }
}

impl<T: Blend> Follower for DrawBuffers<T> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => {
                self.slots_of.push(NONE);
                self.relabel(split.corners, split.new);
            }
            Edit::Insert(insert) => {
                let vertices = self.slots_of.len() + insert.points.len();
                self.slots_of.resize(vertices, NONE);
                for family in insert.families() {
                    self.detach(&family[0].parent.half_edges());
                    divide_corners(family, &mut self.values, T::blend);
                    self.indices.resize(self.values.len(), NONE);
                    self.rings.resize(self.values.len(), [NONE; 2]);
                    for child in family {
                        for (h, v) in child.face.half_edges().into_iter().zip(child.vertices) {
                            self.attach(h, v);
                        }
                    }
                }
                self.sweep();
            }
            Edit::Merge(merge) => {
                self.relabel(merge.corners, merge.kept);
                self.moved(merge.kept);
                // The last vertex has another name, and what a GPU has of it is as it was.
                self.slots_of.swap_remove(merge.gone.index());
                let first = self.slots_of.get(merge.gone.index());
                let mut slot = *first.unwrap_or(&NONE);
                while slot != NONE {
                    self.slots[slot as usize].vertex = merge.gone;
                    slot = self.slots[slot as usize].next;
                }
            }
            Edit::Slide(slide) => {
                self.detach(slide.corners);
                edit.apply_to_corners(&mut self.values, T::blend);
                for &h in slide.corners {
                    self.attach(h, slide.vertex);
                }
                self.sweep(); // All slots of the vertex were left and filled, and so count as changed.
            }
        }
    }
}

/// Returns an origin for positions in `f32`: they are exact to a millionth of the extent of the points if they
/// are relative to it.
///
/// A number in `f32` has 24 bits, so a sheet of one metre that is 4,000 km from the origin of its coordinates has its
/// vertices on steps of half a metre. The origin returned is a point of a grid with cells of at least four times the
/// extent. It is therefore zero for points within twice their extent of zero, and otherwise has few digits. Points
/// that do not extend anywhere are their own origin. Linear.
///
/// ```
/// use tearmesh::engine::draw_origin;
/// use tearmesh::Point;
///
/// let sheet = |x: f64, y: f64| draw_origin([Point::new(x, y, 0.0), Point::new(x + 1.0, y + 1.0, 0.0)]);
/// assert_eq!(sheet(0.0, 1.0), Point::origin());
/// assert_eq!(sheet(500_000.3, 4_649_776.2), Point::new(500_000.0, 4_649_776.0, 0.0));
/// ```
#[must_use]
pub fn draw_origin(points: impl IntoIterator<Item = Point>) -> Point {
    let boxes = points.into_iter().map(|p| [p.coords, p.coords]);
    let bounds = boxes.reduce(|[least, most], [p, _]| [least.inf(&p), most.sup(&p)]);
    let Some([least, most]) = bounds else {
        return Point::origin();
    };
    let extent = max_abs(most - least);
    if extent == 0.0 {
        return least.into();
    }
    let cell = 4.0 * power_of_two_above(extent);
    let middle = least / 2.0 + most / 2.0;
    let origin = middle.map(|x| (x / cell).round() * cell);
    if origin.iter().all(|x| x.is_finite()) {
        origin.into()
    } else {
        Point::origin() // Beside numbers this large, no other origin is nearer.
    }
}

/// The smallest power of two above a positive number; infinity if there is none.
fn power_of_two_above(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    const LAST_PLACE: u64 = 1 << 52;
    f64::from_bits((x.to_bits() & EXPONENT) + LAST_PLACE)
}

/// Numbers that were marked, each listed once.
#[derive(Clone, Debug, Default)]
struct Marks {
    is_marked: Vec<bool>,
    list: Vec<u32>,
}

impl Marks {
    /// Makes room for the numbers below `count`.
    fn reserve(&mut self, count: usize) {
        let count = count.max(self.is_marked.len());
        self.is_marked.resize(count, false);
        self.list.reserve(count - self.list.len());
    }

    fn set(&mut self, number: u32) {
        let index = number as usize;
        if index >= self.is_marked.len() {
            self.is_marked.resize(index + 1, false);
        }
        if !std::mem::replace(&mut self.is_marked[index], true) {
            self.list.push(number);
        }
    }

    /// Those below a limit, ascending; none is marked any more.
    fn take(&mut self, limit: usize) -> Vec<u32> {
        let mut list = self.list.clone();
        self.list.clear(); // Its memory is kept.
        for &number in &list {
            self.is_marked[number as usize] = false;
        }
        list.retain(|&number| (number as usize) < limit);
        list.sort_unstable();
        list
    }
}
