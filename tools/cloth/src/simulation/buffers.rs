//! The buffers that draw a cloth, and what changed in them since they were last uploaded.

use tearmesh::engine::DrawBuffers;
use tearmesh::{Cursor, Follower, Mesh, Point};

/// The vertex and index buffers of a cloth, and the piece of each face.
///
/// There is a slot for each vertex with a face, and three slots for each face. A vertex on a
/// texture seam needs more slots: for that, have [`DrawBuffers`] with texture coordinates follow
/// [`Simulation::edits`](super::Simulation::edits).
#[derive(Clone, Debug)]
pub struct ClothBuffers {
    pub(super) draw: DrawBuffers<[f32; 0]>,
    positions: Vec<[f32; 3]>,
    pieces: Vec<u32>,
    /// Positions and pieces when changes were last taken.
    sent: (Vec<[f32; 3]>, Vec<u32>),
}

/// The parts of the buffers that changed since the previous call of
/// [`ClothBuffers::take_changes`], in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BufferChanges {
    /// The slots whose position changed.
    pub slots: Vec<u32>,
    /// The entries of the index buffer that changed.
    pub corners: Vec<u32>,
    /// The faces that belong to another piece now.
    pub faces: Vec<u32>,
}

impl ClothBuffers {
    /// The buffers of a mesh as it was at the cursor `seen` of its log.
    pub(super) fn new(mesh: &Mesh, points: &[Point], seen: Cursor) -> ClothBuffers {
        let draw = DrawBuffers::new(mesh, vec![[]; mesh.half_edge_count()]);
        let mut buffers = ClothBuffers {
            draw: draw.starting_at(seen),
            positions: Vec::new(),
            pieces: Vec::new(),
            sent: (Vec::new(), Vec::new()),
        };
        buffers.update(mesh, points);
        let _all = buffers.take_changes();
        buffers
    }

    /// Takes over where the vertices are, and the pieces that the mesh has now.
    pub(super) fn update(&mut self, mesh: &Mesh, points: &[Point]) {
        let positions = (0..self.draw.len()).map(|slot| self.draw.place_f32(slot as u32, points));
        self.positions.clear();
        self.positions.extend(positions);
        let components = mesh.components();
        self.pieces.clear();
        let pieces = mesh.faces().map(|face| components.of(face) as u32);
        self.pieces.extend(pieces);
    }

    /// Returns the positions of the slots, in metres.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
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
    #[must_use = "what was changed is not listed again"]
    pub fn take_changes(&mut self) -> BufferChanges {
        let changes = BufferChanges {
            slots: changed(&self.sent.0, &self.positions),
            corners: self.draw.take_changes().corners,
            faces: changed(&self.sent.1, &self.pieces),
        };
        self.sent.0.clone_from(&self.positions);
        self.sent.1.clone_from(&self.pieces);
        changes
    }
}

fn changed<T: PartialEq>(before: &[T], now: &[T]) -> Vec<u32> {
    let is_changed = |&index: &usize| before.get(index) != Some(&now[index]);
    let changed = (0..now.len()).filter(is_changed);
    changed.map(|index| index as u32).collect()
}
