//! The state of a balance: sums so far, and what the next substep is compared with.

use tearmesh::geometry::Vector;

/// What a system notes for its balance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meter {
    pub(super) sums: Sums,
    /// The potential of gravity when the sum of its work was taken last.
    pub(super) potential_j: f64,
    /// Kinetic energy, and the forces on those who are led, after the last substep; `None`
    /// where something has changed since.
    pub(super) kinetic_j: Option<f64>,
    pub(super) forces: Option<Vec<Vector>>,
    /// Room for them.
    pub(super) spare: Vec<Vector>,
    pub(super) wind: Sampled,
    pub(super) gusts: Vec<Vector>,
}

/// What was summed up so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub(super) began_j: f64,
    pub(super) gravity_j: f64,
    pub(super) held_j: f64,
    pub(super) wind_j: f64,
    pub(super) drag_j: f64,
    pub(super) colliders_j: f64,
    pub(super) edits_j: f64,
}

/// What was known of a balance before a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noted {
    pub(super) sums: Sums,
    pub(super) wind: Sampled,
    pub(super) has_forces: bool,
}

/// The power of wind when it was sampled last, and the seconds since.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sampled {
    pub(super) watts: Option<f64>,
    pub(super) since_s: f64,
}

impl Meter {
    /// Forgets what was known of the state.
    pub(super) fn changed(&mut self) {
        self.kinetic_j = None;
        if let Some(forces) = self.forces.take() {
            self.spare = forces;
        }
    }
}
