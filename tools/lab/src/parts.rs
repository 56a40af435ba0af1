//! Experiments in parts, which are run apart, on one machine or on several, and put together afterwards.
//!
//! A part of an experiment is the same experiment with fewer scenes, meshes or methods, so its results are a
//! study of its own. [`Divided::merged`] makes one study of those of all parts. It is the one that a single
//! run would have made, but for times. What is not there is said with the part's name ([`Missing`]).

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::provenance::Provenance;

/// A part of an experiment whose results are not there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Missing {
    /// The name of the part.
    pub part: String,
    /// The reason, such as a file that does not exist.
    pub why: String,
}

impl Missing {
    /// Returns what stands for a part that was not done when the experiment was interrupted.
    #[must_use]
    pub fn interrupted(part: String) -> Missing {
        Missing {
            part,
            why: "interrupted".to_owned(),
        }
    }
}

/// A study that can be made of the studies of its parts.
pub trait Divided: Serialize + DeserializeOwned {
    /// The name and version of the file format, as in the field `schema`.
    const SCHEMA: &'static str;

    /// Returns the origin of the results.
    fn provenance(&self) -> &Provenance;

    /// Returns the parts whose results are not there, as after an interruption.
    fn missing(&self) -> &[Missing];

    /// Makes one study of those of some parts, which must be in the order of a single run. Returns `None` if
    /// there are none.
    fn merged(parts: Vec<Self>, provenance: Provenance, missing: Vec<Missing>) -> Option<Self>;
}

/// The missing parts in a line; `None` if none is missing.
pub(crate) fn told(missing: &[Missing]) -> Option<String> {
    let parts: Vec<&str> = missing.iter().map(|one| one.part.as_str()).collect();
    (!parts.is_empty()).then(|| format!("MISSING: {}", parts.join(", ")))
}

/// The reason as a cell of CSV.
pub(crate) fn cell(why: &str) -> String {
    format!("\"{}\"", why.replace('"', "\"\""))
}
