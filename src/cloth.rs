//! Cloth: particles, what acts between them, and solvers that move them.

pub mod implicit;
