//! The arguments of `check`.

use std::path::PathBuf;

use clap::Parser;

use super::files::Format;
use crate::say::Color;

const EXAMPLES: &str = "\
Examples:
  tearmesh check models/*.obj
      a line for each file: ok, or the first defect, with its line
  tearmesh check -v shirt.obj
      the first twenty defects, with the text of their lines, how many more
      there are, and the size of the mesh";

/// Check that OBJ files can be read and cut.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct CheckArgs {
    /// The OBJ files; `-` is standard input.
    ///
    /// `*` and `?` in a name stand for any text and any character, if the shell has not expanded them.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,

    /// Check all `.obj` files in folders, too.
    #[arg(short, long)]
    pub(crate) recursive: bool,

    /// Print a line of text for each file, or a line of JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: Format,

    /// When to use colours.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print only the files that fail.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Show all diagnostics of each file, with the text of the lines.
    ///
    /// Also shows bounds, edge lengths and the largest pieces, which JSON always has.
    #[arg(short, long)]
    pub(crate) verbose: bool,
}
