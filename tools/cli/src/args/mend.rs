//! What `mend` takes.

use std::num::NonZeroUsize;

use clap::Parser;
use tearmesh::Point;

use super::files::FileArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh mend torn.obj -o whole.obj
      sews everything that was torn
  tearmesh mend torn.obj --last 1 --simplify -o before.obj
      undoes the last cut, and takes out the vertices that it inserted";

/// Sew what was torn, from the record that the file has of it.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct MendArgs {
    /// Undo only the last N cuts.
    #[arg(long, value_name = "N", conflicts_with = "near")]
    pub(crate) last: Option<NonZeroUsize>,

    /// Sew only what lies near this point: within --radius of it.
    #[arg(long, value_name = "X,Y,Z", requires = "radius", allow_hyphen_values = true, value_parser = super::read::point)]
    pub(crate) near: Option<Point>,

    /// Sew boundary edges that lie on each other, in a file without a record.
    ///
    /// For a file whose record of cuts another program dropped. Edges are sewn that
    /// have bit-equal ends, with no third edge at the same place; inserted vertices stay.
    #[arg(long, conflicts_with = "last")]
    pub(crate) coincident: bool,

    /// How near.
    #[arg(
        long,
        value_name = "R",
        requires = "near",
        allow_negative_numbers = true
    )]
    pub(crate) radius: Option<f64>,

    /// Sew nothing if two vertices that belong together are farther apart than this.
    ///
    /// What moved apart is otherwise joined at the mean, by mass.
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,

    /// Take out inserted vertices that no longer separate anything.
    ///
    /// And put back, to the bit, those that a cut with --snap-move moved. Without this option both
    /// stay, and another `mend --simplify` can still do it. What was edited since is kept.
    #[arg(long)]
    pub(crate) simplify: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}
