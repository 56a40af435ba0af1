//! The rows of the table: steps on nets, and scenes.

use serde::{Deserialize, Serialize};

use crate::experiment::Status;

/// A step of a method on a net, or a scene by one method. An interrupted part of the experiment has one row,
/// with nothing but its name in `place`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The name of the net or of the scene.
    #[serde(rename = "where")]
    pub(crate) place: String,
    /// The stiffness of the springs of the net, in N/m; `None` for a scene.
    pub(crate) stiffness_n_per_m: Option<f64>,
    /// The name of the method: for nets the family, for scenes the name on the command line.
    pub(crate) method: String,
    /// The step as a multiple of the limit in theory, or of 2/ω if there is no limit.
    pub(crate) step_ratio: Option<f64>,
    /// The step in seconds.
    pub(crate) dt_s: Option<f64>,
    /// The expected outcome; `None` if theory makes no statement. For a step it is that without the guard.
    pub(crate) expected: Option<Status>,
    /// The measured outcome. For a step it is that without the guard.
    pub(crate) measured: Option<Status>,
    /// The measured outcome of a step with the guard, which is the default.
    pub(crate) watched: Option<Status>,
    /// The largest strain, the relative error of positions, or the largest energy divided by that at the
    /// start, depending on the scene. Smaller is better. `None` if the run failed, or if the scene only has
    /// to end.
    pub(crate) measure: Option<f64>,
    /// Whether the outcome is the expected one, and a step is refused if it must be and only if it may be.
    pub(crate) agrees: Option<bool>,
    /// Whether the method failed without a message.
    pub(crate) is_silent: Option<bool>,
    /// The codes of the messages, with ` | ` between them.
    pub(crate) codes: String,
    /// Whether this part of the experiment was done or interrupted.
    pub(crate) status: Status,
}
