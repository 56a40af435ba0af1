//! The arguments of the verbs that show a mesh and change nothing.

use clap::Args;

use crate::exit::{Exit, Stop};
use crate::say::{Color, Fault};
use crate::streams::Streams;

#[derive(Clone, Debug, Args)]
pub(crate) struct LookArgs {
    /// Repair the input, as `cut` does.
    #[arg(long)]
    pub(crate) repair: bool,

    /// Give each fan of an input vertex a vertex of its own, as `cut` does.
    #[arg(long, hide_short_help = true)]
    pub(crate) separate_fans: bool,

    /// When to use colours on the screen.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Show all errors and warnings, not only three of each kind.
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

impl LookArgs {
    /// Runs a verb that gives a summary, says what there is to say, and gives the exit status.
    pub(crate) fn run(
        &self,
        streams: &mut Streams<'_>,
        work: impl FnOnce(&mut Vec<Fault>, &mut Streams<'_>) -> Result<String, Stop>,
    ) -> Exit {
        let mut faults = Vec::new();
        let mut worked = work(&mut faults, streams);
        if self.quiet {
            worked = worked.map(|_| String::new());
        }
        streams.conclude(worked, faults, self.color, self.verbose)
    }
}
