//! Which pairs of particles have a block: built once, changed where the constraints changed.

use std::collections::BTreeMap;

use tearmesh::DisjointSets;
use tearmesh::geometry::Point;

use crate::element::Element;
use crate::matrix::Hessian;
use crate::system::{KINDS, Model, System};

/// The slots of a [`Hessian`], and the slot to which each constraint adds.
///
/// [`Layout::follow`] compares the layout with the present constraints. That costs one comparison
/// per constraint, and O(log n) for each constraint that is new, removed or has other ends. After a
/// tear only torn constraints are touched, and the caller need not list the changes.
///
/// A slot that is no longer used keeps its number, holds a block of zeros, and is given to the next
/// new pair.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The pair (i, j), i < j, of each slot.
    pairs: Vec<[u32; 2]>,
    /// How many constraints use each slot.
    uses: Vec<u32>,
    free: Vec<u32>,
    slot_of: BTreeMap<[u32; 2], u32>,
    /// By kind of constraint.
    kinds: [Slots; KINDS],
    /// The lowest particle of the piece of each particle.
    pieces: Vec<u32>,
    sets: DisjointSets,
}

/// The slots of the pairs of one kind, by their numbers: [`NO_SLOT`] for numbers without a pair.
#[derive(Clone, Debug, Default)]
struct Slots {
    slots: Vec<u32>,
    taken: usize,
}

/// The pair of a slot that nothing uses. Particle 0 twice: harmless, as its block is zero.
const NONE: [u32; 2] = [0, 0];

const NO_SLOT: u32 = u32::MAX;

impl Layout {
    /// Returns the pair of particles of each slot. A slot without users has the pair (0, 0).
    #[must_use]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Returns, for each particle, the lowest index among the particles with which constraints
    /// connect it, itself included.
    #[must_use]
    pub fn pieces(&self) -> &[u32] {
        &self.pieces
    }

    /// Updates the layout to match a system. Returns the number of slots of constraints that were
    /// taken or freed, which is zero if nothing changed.
    ///
    /// The pieces are recomputed if something changed, in O(particles + slots).
    pub fn follow(&mut self, system: &System) -> usize {
        self.follow_model(&system.model)
    }

    pub(super) fn follow_model(&mut self, model: &Model) -> usize {
        let mut changed = 0;
        for (i, kind) in model.kinds().iter().enumerate() {
            let mut slots = std::mem::take(&mut self.kinds[i]);
            changed += self.follow_kind(&mut slots, &**kind);
            self.kinds[i] = slots;
        }
        if changed > 0 || self.pieces.len() != model.masses.len() {
            self.find_pieces(model.masses.len());
        }
        changed
    }

    /// Computes the second derivatives of a system's elastic energy, and returns how many terms had
    /// a part dropped. With `clamp` every term is positive semidefinite. Without it the derivatives
    /// are exact.
    ///
    /// # Panics
    ///
    /// If the layout does not [`follow`](Layout::follow) the system.
    pub fn hessian(&self, system: &System, clamp: bool, hessian: &mut Hessian) -> u64 {
        self.hessian_at(&system.model, system.positions(), clamp, hessian)
    }

    pub(super) fn hessian_at(
        &self,
        model: &Model,
        x: &[Point],
        clamp: bool,
        hessian: &mut Hessian,
    ) -> u64 {
        hessian.clear(x.len(), self.pairs.len());
        let kinds = model.kinds();
        let kinds = kinds.iter().zip(&self.kinds);
        kinds.fold(0, |clamped, (kind, Slots { slots, .. })| {
            clamped + kind.hessian(x, clamp, slots, hessian)
        })
    }

    fn follow_kind(&mut self, known: &mut Slots, kind: &dyn Element) -> usize {
        let (mut changed, mut there) = (0, 0);
        let Slots { slots, taken } = known;
        kind.each_pair(&mut |number, ends| {
            there += 1;
            if number >= slots.len() {
                slots.resize(number + 1, NO_SLOT);
            }
            let slot = &mut slots[number];
            if *slot == NO_SLOT {
                *slot = self.take(ends);
                (*taken, changed) = (*taken + 1, changed + 1);
            } else {
                changed += self.refit(slot, ends);
            }
        });
        if *taken > there {
            let mut is_there = vec![false; slots.len()];
            kind.each_pair(&mut |number, _| is_there[number] = true);
            for (slot, is_there) in slots.iter_mut().zip(is_there) {
                if !is_there && *slot != NO_SLOT {
                    self.leave(std::mem::replace(slot, NO_SLOT));
                    changed += 1;
                }
            }
            *taken = there;
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

    fn find_pieces(&mut self, particles: usize) {
        self.sets.reset(particles as u32);
        for &[i, j] in &self.pairs {
            self.sets.join(i, j);
        }
        self.pieces.clear();
        self.pieces
            .extend((0..particles as u32).map(|i| self.sets.leader(i)));
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
