//! Where a chart comes from, so that who reads it can make it again.

use serde::{Deserialize, Serialize};

/// The origin of a chart: the program, the commit and the machine that produced it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Provenance {
    /// The command line that produced the chart.
    pub command: String,
    /// The version of the program.
    pub version: String,
    /// The commit from which the program was built.
    pub commit: String,
    /// The compiler that built the program.
    pub compiler: String,
    /// The processor on which times were measured; `None` if it is unknown or no times were measured.
    pub processor: Option<String>,
}

impl Provenance {
    /// All of it but the processor, in a line.
    pub(crate) fn line(&self) -> String {
        format!(
            "{} · version {}, commit {} · {}",
            self.command, self.version, self.commit, self.compiler
        )
    }

    /// The processor, or that nobody knows it.
    pub(crate) fn processor(&self) -> &str {
        self.processor.as_deref().unwrap_or("unknown processor")
    }
}
