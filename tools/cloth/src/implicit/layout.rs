//! Which pairs of particles have a block: built once, changed where the constraints changed.

use std::collections::BTreeMap;

use super::Model;

/// The slots of a [`Hessian`](super::Hessian), and which slot each constraint adds to.
///
/// [`Layout::follow`] compares it with the constraints as they are now. That is one comparison
/// a constraint, and O(log n) for each constraint that is new, gone or has other ends: after a
/// tear only what was torn is touched. Constraints may be pushed, changed in place,
/// swap-removed; nothing has to be told.
///
/// A slot that nothing uses any more keeps its number, holds a block of zeros, and is given to
/// the next new pair.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The pair (i, j), i < j, of each slot.
    pairs: Vec<[u32; 2]>,
    /// How many constraints use each slot.
    uses: Vec<u32>,
    free: Vec<u32>,
    slot_of: BTreeMap<[u32; 2], u32>,
    springs: Vec<u32>,
    /// For the edges (0, 1), (1, 2), (2, 0) of each triangle.
    triangles: Vec<[u32; 3]>,
    bends: Vec<u32>,
    /// The lowest particle of the piece of each particle.
    pieces: Vec<u32>,
}

/// The pair of a slot that nothing uses. Particle 0 twice: harmless, as its block is zero.
const NONE: [u32; 2] = [0, 0];

impl Layout {
    /// The pairs, by slot. A slot without users has the pair (0, 0).
    #[must_use]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// The slot of each spring.
    #[must_use]
    pub fn springs(&self) -> &[u32] {
        &self.springs
    }

    /// The slots of each triangle: of its corners (0, 1), (1, 2), (2, 0).
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The slot of each bend.
    #[must_use]
    pub fn bends(&self) -> &[u32] {
        &self.bends
    }

    /// For each particle the lowest particle that is joined to it by constraints.
    #[must_use]
    pub fn pieces(&self) -> &[u32] {
        &self.pieces
    }

    /// Brings the layout in step with the model, and returns how many slots of constraints
    /// were taken or left: zero where nothing changed.
    ///
    /// Pieces are found anew when something changed: O(particles + slots).
    pub fn follow(&mut self, model: &Model<'_>) -> usize {
        let mut changed = 0;
        let mut springs = std::mem::take(&mut self.springs);
        changed += self.sync(&mut springs, model.springs.len(), |i| model.springs[i].ends);
        self.springs = springs;
        let mut bends = std::mem::take(&mut self.bends);
        changed += self.sync(&mut bends, model.bends.len(), |i| model.bends[i].ends());
        self.bends = bends;
        let mut triangles = std::mem::take(&mut self.triangles);
        // The edges of the triangles, as one list.
        for edges in triangles.drain(model.triangles.len().min(triangles.len())..) {
            for slot in edges {
                self.leave(slot);
                changed += 1;
            }
        }
        for (edges, triangle) in triangles.iter_mut().zip(model.triangles) {
            let [a, b, c] = triangle.vertices;
            for (slot, ends) in edges.iter_mut().zip([[a, b], [b, c], [c, a]]) {
                changed += self.refit(slot, ends);
            }
        }
        for triangle in &model.triangles[triangles.len()..] {
            let [a, b, c] = triangle.vertices;
            triangles.push([[a, b], [b, c], [c, a]].map(|ends| self.take(ends)));
            changed += 3;
        }
        self.triangles = triangles;
        if changed > 0 || self.pieces.len() != model.masses.len() {
            self.find_pieces(model.masses.len());
        }
        changed
    }

    fn sync(
        &mut self,
        slots: &mut Vec<u32>,
        count: usize,
        ends: impl Fn(usize) -> [u32; 2],
    ) -> usize {
        let mut changed = 0;
        for slot in slots.drain(count.min(slots.len())..) {
            self.leave(slot);
            changed += 1;
        }
        for (i, slot) in slots.iter_mut().enumerate() {
            changed += self.refit(slot, ends(i));
        }
        for i in slots.len()..count {
            slots.push(self.take(ends(i)));
            changed += 1;
        }
        changed
    }

    fn refit(&mut self, slot: &mut u32, ends: [u32; 2]) -> usize {
        if self.pairs[*slot as usize] == sorted(ends) {
            return 0;
        }
        self.leave(*slot);
        *slot = self.take(ends);
        1
    }

    fn take(&mut self, ends: [u32; 2]) -> u32 {
        let pair = sorted(ends);
        if let Some(&slot) = self.slot_of.get(&pair) {
            self.uses[slot as usize] += 1;
            return slot;
        }
        let slot = self.free.pop().unwrap_or_else(|| {
            self.pairs.push(NONE);
            self.uses.push(0);
            u32::try_from(self.pairs.len() - 1).expect("fewer than 2^32 slots")
        });
        self.pairs[slot as usize] = pair;
        self.uses[slot as usize] = 1;
        self.slot_of.insert(pair, slot);
        slot
    }

    fn leave(&mut self, slot: u32) {
        let uses = &mut self.uses[slot as usize];
        *uses -= 1;
        if *uses == 0 {
            let pair = std::mem::replace(&mut self.pairs[slot as usize], NONE);
            self.slot_of.remove(&pair);
            self.free.push(slot);
        }
    }

    /// Union by the lower id, with halved paths.
    fn find_pieces(&mut self, particles: usize) {
        fn root(pieces: &mut [u32], mut i: u32) -> u32 {
            while pieces[i as usize] != i {
                let above = pieces[pieces[i as usize] as usize];
                pieces[i as usize] = above;
                i = above;
            }
            i
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        pieces.clear();
        pieces.extend((0..).take(particles));
        for &[i, j] in &self.pairs {
            let (a, b) = (root(&mut pieces, i), root(&mut pieces, j));
            pieces[a.max(b) as usize] = a.min(b);
        }
        for i in (0..).take(particles) {
            pieces[i as usize] = root(&mut pieces, i);
        }
        self.pieces = pieces;
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
