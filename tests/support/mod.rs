//! The helpers that the tests of all crates share.

pub(crate) mod cases;
pub(crate) mod delaunay;
pub(crate) mod digest;
pub(crate) mod fixtures;
pub(crate) mod inputs;
pub(crate) mod plain;
pub(crate) mod random;
