//! The buffers that draw a cloth, and what changed in them since they were last uploaded.

use tearmesh::engine::{DrawBuffers, draw_origin};
use tearmesh::geometry::{Vector, cross, length};
use tearmesh::{Cursor, Follower, Mesh, Point};

/// The vertex and index buffers of a cloth, and the piece of each face.
///
/// There is a slot for each vertex with a face, and one more for each further
/// [texture coordinate](super::SimulationDef::texture) that it has along a seam of the texture. There are three
/// entries of the index buffer for each face.
#[derive(Clone, Debug)]
pub struct ClothBuffers {
    /// The values are texture coordinates.
    pub(super) draw: DrawBuffers<[f32; 2]>,
    origin: Point,
    slots: Slots,
    pieces: Vec<u32>,
    /// The normals of vertices, not of length one.
    sums: Vec<Vector>,
    /// Slots and pieces when changes were last taken.
    sent: (Slots, Vec<u32>),
}

/// The attributes of slots that a GPU gets.
#[derive(Clone, Debug, Default)]
struct Slots {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    texture: Vec<[f32; 2]>,
}

/// The parts of the buffers that changed since the previous call of
/// [`ClothBuffers::take_changes`], in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BufferChanges {
    /// The slots whose position, normal or texture coordinate changed.
    pub slots: Vec<u32>,
    /// The entries of the index buffer that changed.
    pub corners: Vec<u32>,
    /// The faces that belong to another piece now.
    pub faces: Vec<u32>,
}

impl ClothBuffers {
    /// The buffers of a mesh as it was at the cursor `seen` of its log.
    pub(super) fn new(
        mesh: &Mesh,
        points: &[Point],
        texture: Vec<[f32; 2]>,
        seen: Cursor,
    ) -> ClothBuffers {
        let mut buffers = ClothBuffers {
            draw: DrawBuffers::new(mesh, texture).starting_at(seen),
            origin: draw_origin(points.iter().copied()),
            slots: Slots::default(),
            pieces: Vec::new(),
            sums: Vec::new(),
            sent: Default::default(),
        };
        buffers.update(mesh, points);
        let _all = buffers.take_changes();
        buffers
    }

    /// Takes over where the vertices are, and the pieces that the mesh has now.
    pub(super) fn update(&mut self, mesh: &Mesh, points: &[Point]) {
        self.sums.clear();
        self.sums.resize(mesh.vertex_count(), Vector::zeros());
        for face in mesh.faces() {
            let corners = mesh.face_vertices(face);
            let [a, b, c] = corners.map(|v| points[v.index()]);
            let normal = cross(b - a, c - a);
            corners.iter().for_each(|v| self.sums[v.index()] += normal);
        }
        let place = |slot| self.draw.place_f32(slot, points, self.origin);
        let normal = |slot| unit(self.sums[self.draw.vertex(slot).index()]);
        let slots = 0..self.draw.len() as u32;
        refill(&mut self.slots.positions, slots.clone().map(place));
        refill(&mut self.slots.normals, slots.map(normal));
        refill(&mut self.slots.texture, self.draw.iter().map(|(_, &uv)| uv));
        let components = mesh.components();
        let pieces = mesh.faces().map(|face| components.of(face) as u32);
        refill(&mut self.pieces, pieces);
    }

    /// Returns the origin of [`positions`](ClothBuffers::positions): zero unless the cloth began far from it, and
    /// the same throughout the simulation ([`draw_origin`]).
    #[must_use]
    pub fn origin(&self) -> Point {
        self.origin
    }

    /// Returns the positions of the slots in metres, relative to the [`origin`](ClothBuffers::origin).
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.slots.positions
    }

    /// Returns the unit normals of the slots: means over all faces of a vertex, weighted by area, so that seams of the
    /// texture do not show. A vertex whose faces have no area has the normal zero. For creases, use
    /// [`normals`](tearmesh::engine::normals).
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.slots.normals
    }

    /// Returns the texture coordinates of the slots: zero unless the definition
    /// [has some](super::SimulationDef::texture).
    #[must_use]
    pub fn texture(&self) -> &[[f32; 2]] {
        &self.slots.texture
    }

    /// Returns the slots of all faces, three per face.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        self.draw.indices()
    }

    /// Returns the piece of each face. Pieces are numbered from 0 in the order of their first
    /// faces, so a piece that comes off may change the numbers of others.
    #[must_use]
    pub fn pieces(&self) -> &[u32] {
        &self.pieces
    }

    /// Returns what changed since the previous call, or since the simulation began. The lengths of
    /// the buffers may have changed as well. Linear.
    #[must_use = "each change is listed once"]
    pub fn take_changes(&mut self) -> BufferChanges {
        let (sent, pieces) = &self.sent;
        let changes = BufferChanges {
            slots: changed(self.slots.positions.len(), |slot| {
                self.slots.at(slot) == sent.at(slot)
            }),
            corners: self.draw.take_changes().corners,
            faces: changed(self.pieces.len(), |face| {
                pieces.get(face) == self.pieces.get(face)
            }),
        };
        self.sent.0.clone_from(&self.slots);
        self.sent.1.clone_from(&self.pieces);
        changes
    }
}

impl Slots {
    /// All attributes of a slot; `None` if there is no such slot.
    fn at(&self, slot: usize) -> Option<([f32; 3], [f32; 3], [f32; 2])> {
        let position = *self.positions.get(slot)?;
        Some((position, self.normals[slot], self.texture[slot]))
    }
}

/// The vector of length one along another; zero for one that is zero.
fn unit(v: Vector) -> [f32; 3] {
    let length = length(v);
    if length > 0.0 {
        (v / length).map(|x| x as f32).into()
    } else {
        [0.0; 3]
    }
}

fn refill<T>(values: &mut Vec<T>, with: impl Iterator<Item = T>) {
    values.clear();
    values.extend(with);
}

/// The indices below `count` that are not the same as before.
fn changed(count: usize, is_same: impl Fn(usize) -> bool) -> Vec<u32> {
    let changed = (0..count).filter(|&index| !is_same(index));
    changed.map(|index| index as u32).collect()
}
