//! The constraints of each particle: one list a particle, threaded through the constraints.
//!
//! Adding to a list allocates nothing where room was made, so an edit costs the valence of the
//! particles that it touches. These are noted, so that what is summed up by particle costs no more.

/// No constraint, in a list.
const NONE: u32 = u32::MAX;

/// The constraints 0, 1, 2, … of the particles 0, 1, 2, …, each constraint with `ENDS` ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Incidence<const ENDS: usize> {
    /// By particle: the first of its list, as `ENDS` times the constraint plus the end.
    first: Vec<u32>,
    /// By constraint and end: the next of the list.
    next: Vec<[u32; ENDS]>,
    /// The particles whose constraints changed since they were taken over.
    pub(crate) changed: Dirty,
}

impl<const ENDS: usize> Incidence<ENDS> {
    /// Makes room for so many particles and constraints in all.
    pub(crate) fn reserve(&mut self, particles: usize, constraints: usize) {
        room_for(&mut self.first, particles);
        room_for(&mut self.next, constraints);
        self.changed.reserve(particles);
    }

    /// The constraints of a particle, and which of their ends it is.
    pub(crate) fn of(&self, particle: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut at = self.first[particle];
        std::iter::from_fn(move || {
            let here = (at != NONE).then_some(at as usize)?;
            at = self.next[here / ENDS][here % ENDS];
            Some((here / ENDS, here % ENDS))
        })
    }

    /// Makes room for a constraint, whose ends are in no list yet.
    pub(crate) fn push(&mut self) {
        self.next.push([NONE; ENDS]);
    }

    /// Puts an end of a constraint on the list of a particle.
    pub(crate) fn attach(&mut self, constraint: usize, end: usize, particle: usize) {
        self.changed.mark(particle);
        let first = &mut self.first[particle];
        self.next[constraint][end] = *first;
        *first = (ENDS * constraint + end) as u32;
    }

    /// Takes an end of a constraint off the list of its particle.
    pub(crate) fn detach(&mut self, constraint: usize, end: usize, particle: usize) {
        self.changed.mark(particle);
        let gone = (ENDS * constraint + end) as u32;
        let after = self.next[constraint][end];
        if self.first[particle] == gone {
            self.first[particle] = after;
            return;
        }
        let mut at = self.first[particle] as usize;
        while self.next[at / ENDS][at % ENDS] != gone {
            at = self.next[at / ENDS][at % ENDS] as usize;
        }
        self.next[at / ENDS][at % ENDS] = after;
    }

    pub(crate) fn push_particle(&mut self) {
        self.first.push(NONE);
    }

    /// The particle with the highest index.
    pub(crate) fn last_particle(&self) -> usize {
        self.first.len() - 1
    }

    /// Forgets a particle without constraints; the last one takes its index.
    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        debug_assert_eq!(self.first[particle], NONE, "a removed particle is free");
        self.first.swap_remove(particle);
        self.changed.mark(particle);
    }
}

/// Particles of which something changed, in the order in which they came: a list, so that what is taken in again costs
/// their number, beside a mark for each particle, so that it has none twice and never needs more room.
#[derive(Clone, Debug, Default)]
pub(crate) struct Dirty {
    list: Vec<u32>,
    /// By particle; those beyond are not in the list.
    is_listed: Vec<bool>,
}

impl Dirty {
    /// Makes room for so many particles in all.
    pub(crate) fn reserve(&mut self, particles: usize) {
        room_for(&mut self.list, particles);
        room_for(&mut self.is_listed, particles);
    }

    pub(crate) fn list(&self) -> &[u32] {
        &self.list
    }

    pub(crate) fn contains(&self, particle: usize) -> bool {
        self.is_listed.get(particle) == Some(&true)
    }

    pub(crate) fn mark(&mut self, particle: usize) {
        let count = self.is_listed.len().max(particle + 1);
        self.is_listed.resize(count, false);
        if !std::mem::replace(&mut self.is_listed[particle], true) {
            self.list.push(particle as u32);
        }
    }

    /// Takes over the particles of another set, which is empty then.
    pub(crate) fn take_over(&mut self, other: &mut Dirty) {
        for &particle in &other.list {
            self.mark(particle as usize);
        }
        other.clear();
    }

    /// Leaves out the particles from this number on: since they came, there are no more than these.
    pub(crate) fn truncate(&mut self, particles: usize) {
        self.list
            .retain(|particle| (*particle as usize) < particles);
        self.is_listed.truncate(particles);
    }

    pub(crate) fn clear(&mut self) {
        for particle in self.list.drain(..) {
            self.is_listed[particle as usize] = false;
        }
    }
}

/// Makes room in a list for so many in all.
pub(crate) fn room_for<T>(list: &mut Vec<T>, count: usize) {
    list.reserve(count.saturating_sub(list.len()));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dirty(particles: &[usize]) -> Dirty {
        let mut dirty = Dirty::default();
        particles.iter().for_each(|particle| dirty.mark(*particle));
        dirty
    }

    #[test]
    fn a_particle_is_listed_once_until_it_is_taken_over() {
        let (mut one, mut other) = (dirty(&[3, 1, 3]), dirty(&[1, 7]));
        assert_eq!(one.list(), [3, 1]);
        one.take_over(&mut other);
        assert_eq!((one.list(), other.list()), (&[3, 1, 7][..], &[][..]));
        other.mark(7);
        assert_eq!(other.list(), [7]);
        one.truncate(3);
        assert_eq!(one.list(), [1]);
        one.mark(7);
        assert_eq!(one.list(), [1, 7]);
    }
}
