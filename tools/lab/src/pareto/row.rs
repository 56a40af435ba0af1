//! The rows of the table, which are also the keys of runs.

use serde::{Deserialize, Serialize};

use super::observe::Records;
use super::scene::Observable;
use crate::experiment::Status;
use crate::method::{DEFAULT, Family};
use crate::sheet::MeshKind;

/// The multiple of the floor below which errors are not distinguished.
pub(crate) const FLOORS: f64 = 10.0;

/// An observable of a run. A run that failed has one row without an observable, and so have references and the
/// runs of the gate.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The name of the scene.
    pub(crate) scene: String,
    /// The kind of mesh.
    pub(crate) mesh: MeshKind,
    /// The number of cells along each side.
    pub(crate) cells: u32,
    /// The stiffness of the edges, in N/m.
    pub(crate) stiffness_n_per_m: f64,
    /// The factor on the mass of the middle particle.
    pub(crate) mass_ratio: f64,
    /// The name of the run, such as `verlet@0.5` or `xpbd@default`.
    pub(crate) run: String,
    /// The family of methods; `None` for references and the gate.
    pub(crate) family: Option<Family>,
    /// The name of the method with its settings; `reference` for references and the gate.
    pub(crate) method: String,
    /// The step as a fraction of the base step; `None` at default settings.
    pub(crate) step_fraction: Option<f64>,
    /// The way in which the run ended.
    pub(crate) status: Status,
    /// The step, in seconds.
    pub(crate) dt_s: f64,
    /// The number of visits of edges, for all purposes.
    pub(crate) visits: Option<u64>,
    /// The distance of the two runs of the gate divided by the noise; `None` if there is no gate or it failed.
    pub(crate) noise_amplification: Option<f64>,
    /// The observable.
    pub(crate) observable: Option<Observable>,
    /// The relative distance between the two references, or the error that remains where rows end at rest,
    /// if that is larger. `None` if a reference has no value, or if noise grows too much.
    pub(crate) error_floor: Option<f64>,
    /// The distance of the run from the reference.
    pub(crate) error_total: Option<f64>,
    /// The reason of a failure.
    pub(crate) why: String,
    /// What else distinguishes the run from the others of the plan.
    #[serde(skip)]
    pub(super) planned: Planned,
    /// What the run recorded, until it is compared.
    #[serde(skip)]
    pub(super) records: Records,
}

impl Row {
    /// Returns the cost of the run, its visits of edges; `None` if it is not known, or took no step.
    #[must_use]
    pub(crate) fn cost(&self) -> Option<f64> {
        let visits = self.visits.filter(|visits| *visits > 0);
        visits.map(|visits| visits as f64)
    }

    /// Returns whether the run is the default method at its default settings.
    #[must_use]
    pub(crate) fn is_default(&self) -> bool {
        self.method == DEFAULT && self.step_fraction.is_none()
    }

    /// Returns whether `error_total` is below ten times the floor, and so known no better than that.
    #[must_use]
    pub(crate) fn is_at_floor(&self) -> bool {
        let both = self.error_total.zip(self.error_floor);
        both.is_some_and(|(error, floor)| error < FLOORS * floor)
    }

    pub(super) fn case(&self) -> (&str, MeshKind, u32, [f64; 2]) {
        let numbers = [self.stiffness_n_per_m, self.mass_ratio];
        (&self.scene, self.mesh, self.cells, numbers)
    }
}

/// What distinguishes a run from the others of the plan, beside what its row says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Planned {
    /// The index of its case.
    pub(super) case: usize,
    pub(super) role: Role,
    /// The number of steps to each checkpoint; `None` if the scene has no time of its own.
    pub(super) steps_to_checkpoint: Option<u64>,
    /// An estimate of its visits of edges.
    pub(super) visits: f64,
}

/// The purpose of a run. References are two runs, the second with half the step, or one if the scene ends at
/// rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Role {
    /// A method at a fraction of its base step, or with its default step.
    #[default]
    Method,
    /// A reference by Verlet's method.
    Verlet,
    /// A reference by Newton's method.
    Newton,
    /// A run that ends at [`REST_M_PER_S`](super::REST_M_PER_S), where references go on. Its error is a lower
    /// bound of the floor.
    Rest,
    /// The run of the gate that starts as all others do.
    Calm,
    /// The run of the gate that starts with noise.
    Noisy,
}

impl Role {
    /// Whether the run is a reference, which has no limit of visits and comes nearer to rest.
    pub(super) fn is_reference(self) -> bool {
        matches!(self, Role::Verlet | Role::Newton)
    }
}
