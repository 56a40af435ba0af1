//! What is noted of energy while someone keeps its balance: what the method of a substep made of it, and
//! what the substep left.
//!
//! A step begins with the energy that the last one left, unless the state was changed in between: so no
//! energy is summed up twice. Who notes what, and by which identities, is told in
//! [`loss`](crate::loss).

use crate::moment::State;

/// The notes of one system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meter {
    is_asked: bool,
    made_j: Option<f64>,
    left: Option<(State, Energy)>,
}

/// The energy of a state, as far as the account of the method's next step asks for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energy {
    pub(crate) elastic_j: f64,
    /// Of Verlet the swing against its shadow as well, for steps of so many seconds.
    pub(crate) swing: Option<(f64, f64)>,
}

impl Meter {
    /// A substep begins, and nothing was made in it so far.
    pub(crate) fn begin(&mut self, is_asked: bool) {
        self.is_asked = is_asked;
        self.made_j = None;
    }

    /// Whether someone asks what the method itself makes of energy in this substep.
    pub(crate) fn is_asked(&self) -> bool {
        self.is_asked
    }

    /// Notes what the method made in a part of the substep, in joules, with what it took from air.
    pub(crate) fn note(&mut self, made_j: f64) {
        *self.made_j.get_or_insert(0.0) += made_j;
    }

    /// What the method made so far in this substep, in joules; `None` unless it says.
    pub(crate) fn made_j(&self) -> Option<f64> {
        self.made_j
    }

    /// Keeps the energy of a state.
    pub(crate) fn leave(&mut self, state: State, energy: Energy) {
        self.left = Some((state, energy));
    }

    /// The energy that was left, where the system is still in that state.
    pub(crate) fn left(&self, state: State) -> Option<Energy> {
        let (of, energy) = self.left?;
        (of == state).then_some(energy)
    }

    /// Something but a step has moved the particles.
    pub(crate) fn forget(&mut self) {
        self.left = None;
    }
}
