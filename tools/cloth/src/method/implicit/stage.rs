//! The numbers of an implicit step.

#[derive(Clone, Copy, Debug)]
pub(super) struct Stage {
    pub(super) dt_s: f64,
    pub(super) h: f64,
    /// 1 + h c.
    pub(super) dragged: f64,
    /// The error that the tolerance allows, as an rms acceleration.
    pub(super) error_max: f64,
}
