//! Which constraints a particle has: one list a particle, threaded through the constraints.
//!
//! Adding to a list allocates nothing where room was made, so an edit costs the valence of the
//! particles that it touches.

/// No constraint, in a list.
const NONE: u32 = u32::MAX;

/// The constraints 0, 1, 2, … of the particles 0, 1, 2, …, each constraint with `ENDS` ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Incidence<const ENDS: usize> {
    /// By particle: the first of its list, as `ENDS` times the constraint plus the end.
    first: Vec<u32>,
    /// By constraint and end: the next of the list.
    next: Vec<[u32; ENDS]>,
}

impl<const ENDS: usize> Incidence<ENDS> {
    /// Makes room for so many particles and constraints in all.
    pub(crate) fn reserve(&mut self, particles: usize, constraints: usize) {
        room_for(&mut self.first, particles);
        room_for(&mut self.next, constraints);
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
        let first = &mut self.first[particle];
        self.next[constraint][end] = *first;
        *first = (ENDS * constraint + end) as u32;
    }

    /// Takes an end of a constraint off the list of its particle.
    pub(crate) fn detach(&mut self, constraint: usize, end: usize, particle: usize) {
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
    }
}

/// Makes room in a list for so many in all.
pub(crate) fn room_for<T>(list: &mut Vec<T>, count: usize) {
    list.reserve(count.saturating_sub(list.len()));
}
