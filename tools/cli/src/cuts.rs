//! The parts that `cut` and `tear` share: scissors from what was typed, and words on what was cut.

pub(crate) mod no_op;
pub(crate) mod scissors;
pub(crate) mod summary;
