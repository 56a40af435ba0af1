//! Which system a state is of, and which substep led to it.
//!
//! By these a method that remembers the last step knows whether it led to the state that it is given.
//! None is part of what a system is, nor of any output: a clone is another system, in the same
//! state.

use std::sync::{Arc, Weak};

/// What a system has and no other.
#[derive(Debug, Default)]
pub(crate) struct Identity(Arc<()>);

/// A clone of a system goes its own way, so it has an identity of its own.
impl Clone for Identity {
    fn clone(&self) -> Identity {
        Identity::default()
    }
}

impl Identity {
    /// A note of it, by which the system can be known again.
    pub(crate) fn note(&self) -> Note {
        Note(Arc::downgrade(&self.0))
    }
}

/// A note of which system something is of: by default of none.
#[derive(Clone, Debug, Default)]
pub(crate) struct Note(Weak<()>);

impl Note {
    /// Whether it is of the system of this identity.
    pub(crate) fn is_of(&self, identity: &Identity) -> bool {
        // What a note is of keeps its address as long as there is a note.
        std::ptr::eq(self.0.as_ptr(), Arc::as_ptr(&identity.0))
    }

    /// Whether the system is still there.
    pub(crate) fn is_alive(&self) -> bool {
        self.0.strong_count() > 0
    }
}

/// The substep that led to a state, by its number among all that its system has tried: none is used
/// twice, also where one is taken back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Moment {
    /// No substep did; or particles have come or gone since.
    #[default]
    Unknown,
    /// This one.
    After(u64),
}
