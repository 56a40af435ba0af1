//! The integration tests of the library, in one binary.

mod exhaustive;
mod figures;
mod lockstep;
mod oracle;
mod properties;
