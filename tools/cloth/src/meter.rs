//! What is noted of energy while someone keeps its balance: what the method of a substep made of it, and
//! what the substep left.
//!
//! A step begins with the energy that the last one left, unless the state was changed in between: so no
//! energy is summed up twice. Who notes what, and by which identities, is told in
//! [`loss`](crate::loss).

use tearmesh::geometry::{Point, Vector, dot};

use crate::moment::State;

/// The notes of one system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meter {
    is_asked: bool,
    made_j: Option<f64>,
    led_j: Option<f64>,
    left: Option<(State, Energy)>,
}

/// The energy of a state, as far as the account of the method's next step asks for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energy {
    pub(crate) elastic_j: f64,
    pub(crate) more: More,
}

/// What else is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum More {
    /// For Verlet: the swing against its shadow, in joules, and the step in seconds that it holds
    /// for.
    Swing { of_s: f64, joules: f64 },
    /// By methods that move by the forces at the end of a step.
    Free(Free),
}

/// The energy of free particles, in joules.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Free {
    pub(crate) kinetic_j: f64,
    /// The potential of gravity.
    pub(crate) potential_j: f64,
}

impl Free {
    pub(crate) fn total_j(self) -> f64 {
        self.kinetic_j + self.potential_j
    }
}

/// A sum over free particles, of which that energy is made.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FreeSum {
    /// Σ m |v|²
    twice_kinetic: f64,
    /// Σ m x
    moment: Vector,
}

impl FreeSum {
    /// Adds a particle of this mass and this inverse mass, which is zero where it is held.
    #[inline]
    pub(crate) fn add(&mut self, [mass, inverse_mass]: [f64; 2], x: Point, v: Vector) {
        if inverse_mass > 0.0 {
            self.twice_kinetic += mass * dot(v, v);
            self.moment += x.coords * mass;
        }
    }

    pub(crate) fn energy(self, gravity: Vector) -> Free {
        Free {
            kinetic_j: 0.5 * self.twice_kinetic,
            potential_j: -dot(gravity, self.moment),
        }
    }
}

impl Energy {
    /// The energy of motion of free particles, in joules, where it is known.
    pub(crate) fn kinetic_j(self) -> Option<f64> {
        match self.more {
            More::Free(free) => Some(free.kinetic_j),
            More::Swing { .. } => None,
        }
    }
}

impl Meter {
    /// A substep begins, and nothing was made in it so far.
    pub(crate) fn begin(&mut self, is_asked: bool) {
        self.is_asked = is_asked;
        (self.made_j, self.led_j) = (None, None);
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

    /// Notes what constraints did on the way of those who are led, in joules and substep by substep of the
    /// method's own.
    pub(crate) fn note_led(&mut self, led_j: f64) {
        self.led_j = Some(led_j);
    }

    /// What they did; `None` unless the method says.
    pub(crate) fn led_j(&self) -> Option<f64> {
        self.led_j
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
