//! The arguments of `mend`.

use std::num::NonZeroUsize;

use clap::Parser;
use tearmesh::Point;

use super::files::FileArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh mend torn.obj -o whole.obj
      sews everything that was torn
  tearmesh mend torn.obj --last 1 --simplify -o before.obj
      undoes the last cut, and removes the vertices that it inserted";

/// Sew cuts and tears again, by the record of them in the file.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct MendArgs {
    /// Undo only the last N cuts.
    #[arg(long, value_name = "N", conflicts_with = "near")]
    pub(crate) last: Option<NonZeroUsize>,

    /// Sew only within --radius of this point.
    #[arg(long, value_name = "X,Y,Z", requires = "radius", allow_hyphen_values = true, value_parser = super::read::point)]
    pub(crate) near: Option<Point>,

    /// Sew boundary edges that coincide, in a file without a record.
    ///
    /// Use this if another program dropped the record of cuts. Two edges are sewn if their ends are
    /// at equal places and no third edge is at the same place. Inserted vertices stay.
    #[arg(long, conflicts_with = "last")]
    pub(crate) coincident: bool,

    /// The distance from --near up to which cuts are sewn.
    #[arg(
        long,
        value_name = "R",
        requires = "near",
        allow_negative_numbers = true,
        value_parser = super::read::distance
    )]
    pub(crate) radius: Option<f64>,

    /// Sew nothing if two vertices to be joined are farther apart than this.
    ///
    /// Without it, vertices that moved apart are joined at their mean, weighted by mass.
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = super::read::distance)]
    pub(crate) max_distance: Option<f64>,

    /// Remove inserted vertices that no longer separate anything.
    ///
    /// Also moves the vertices back, to the bit, that a cut with --snap-move moved. Without this
    /// option both stay as they are, and a later `mend --simplify` can still do this. Vertices that
    /// were edited since the cut are kept.
    #[arg(long)]
    pub(crate) simplify: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}
