//! Where a chart comes from, so that who reads it can make it again.

use serde::Serialize;

/// Where a chart comes from.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Provenance {
    /// The command that made it.
    pub command: String,
    /// The version of the program.
    pub version: String,
    /// The commit that it was built from.
    pub commit: String,
    /// What it was compiled with.
    pub compiler: String,
    /// The processor that it ran on, where times were taken.
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
