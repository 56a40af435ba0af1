//! What `check` takes.

use std::path::PathBuf;

use clap::Parser;

use super::files::Format;
use crate::say::Color;

const EXAMPLES: &str = "\
Examples:
  tearmesh check models/*.obj
      a line for each file: ok, or the first thing that is wrong, with its line
  tearmesh check -v shirt.obj
      everything that is wrong, with the text of the lines, and how large the mesh is";

/// Check OBJ files: whether they can be read and are meshes that can be cut.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct CheckArgs {
    /// The OBJ files; `-` is standard input.
    ///
    /// `*` and `?` in a name stand for any text and any character, where the shell has not put
    /// the names of files for them.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,

    /// Look into folders, and check all files `.obj` there.
    #[arg(short, long)]
    pub(crate) recursive: bool,

    /// Print a line of words for each file, or a line of JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: Format,

    /// Show the meshes on a page for a browser, as HTML, those that can be cut.
    #[arg(long, value_name = "F.html")]
    pub(crate) view: Option<PathBuf>,

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
