//! The arguments of the verbs that show a mesh and change nothing.

use clap::Args;

use crate::say::Color;

#[derive(Debug, Args)]
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
