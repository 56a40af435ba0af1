//! The buffers that draw a cloth, and what changed in them since they were last uploaded.

use tearmesh::{DrawBuffers, Mesh, Point, VertexId};

/// The vertex and index buffers of a cloth, and the piece of each face.
///
/// The vertex buffer has a *slot* for each vertex, and two or more for a vertex on a texture seam:
/// see [`DrawBuffers`]. The index buffer has three slots per face.
#[derive(Clone, Debug)]
pub struct ClothBuffers {
    pub(super) draw: DrawBuffers<[f32; 2]>,
    positions: Vec<[f32; 3]>,
    pieces: Vec<u32>,
    /// What the caller has: positions and pieces of the last time that changes were taken.
    sent: (Vec<[f32; 3]>, Vec<u32>),
}

/// The parts of the buffers that changed since the previous call of
/// [`ClothBuffers::take_changes`], in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BufferChanges {
    /// The slots whose position or texture coordinates changed.
    pub slots: Vec<u32>,
    /// The entries of the index buffer that changed.
    pub corners: Vec<u32>,
    /// The faces that belong to another piece now.
    pub faces: Vec<u32>,
}

impl ClothBuffers {
    pub(super) fn new(draw: DrawBuffers<[f32; 2]>) -> ClothBuffers {
        ClothBuffers {
            draw,
            positions: Vec::new(),
            pieces: Vec::new(),
            sent: (Vec::new(), Vec::new()),
        }
    }

    /// Takes over where the vertices are, and with a mesh the pieces that it has now.
    pub(super) fn update(&mut self, points: &[Point], mesh: Option<&Mesh>) {
        self.positions.clear();
        let slots = self.draw.iter();
        let at = |v: VertexId| points[v.index()].coords;
        let placed = slots.map(|(v, _)| <[f64; 3]>::from(at(v)).map(|x| x as f32));
        self.positions.extend(placed);
        if let Some(mesh) = mesh {
            let components = mesh.components();
            let pieces = mesh.faces().map(|face| components.of(face) as u32);
            self.pieces.clear();
            self.pieces.extend(pieces);
        }
    }

    /// Counts what there is as sent.
    pub(super) fn forget_changes(&mut self) {
        let _all = self.draw.take_changes();
        self.sent.0.clone_from(&self.positions);
        self.sent.1.clone_from(&self.pieces);
    }

    /// Returns the positions of the slots, in metres.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Returns the texture coordinates of a slot; zero for a cloth without.
    ///
    /// # Panics
    ///
    /// If there is no such slot.
    #[must_use]
    pub fn texture(&self, slot: u32) -> [f32; 2] {
        *self.draw.value(slot)
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
        let edited = self.draw.take_changes();
        let bits = |at: &[f32; 3]| at.map(f32::to_bits);
        let moved =
            |slot: usize| self.sent.0.get(slot).map(bits) != Some(bits(&self.positions[slot]));
        let mut slots: Vec<u32> = (0..self.positions.len())
            .filter(|&slot| moved(slot))
            .map(|slot| slot as u32)
            .collect();
        slots.extend(&edited.slots);
        slots.sort_unstable();
        slots.dedup();
        let other = |face: &usize| self.sent.1.get(*face) != Some(&self.pieces[*face]);
        let faces = (0..self.pieces.len()).filter(other);
        let changes = BufferChanges {
            slots,
            corners: edited.corners,
            faces: faces.map(|face| face as u32).collect(),
        };
        self.sent.0.clone_from(&self.positions);
        self.sent.1.clone_from(&self.pieces);
        changes
    }
}
