//! What `view` takes.

use std::path::PathBuf;

use clap::Parser;
use tearmesh::Point;

use super::look::LookArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh view torn.obj
      writes torn.html: open it in a browser, turn the mesh, click two points, and copy the line that cuts
  tearmesh view frames -o rip.html
      plays all OBJ files in the folder `frames`, 30 a second";

/// Show meshes on a page for a browser: one HTML file that needs no network.
///
/// Each piece has a colour, torn edges are red, and the boundary is dark. Two points that are clicked show where
/// a cut between them would go, and the `tearmesh cut` line to type for it.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct ViewArgs {
    /// The OBJ files to show, or folders of them; `-` is standard input.
    ///
    /// Several are played in the order in which they are named, and those of a folder by their names: 30 a
    /// second, or fewer than a dozen one a second. They may have faces of their own each.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,

    /// Where to write the page; `-` is standard output.
    ///
    /// Without it the page is written here, and named like the first input, but with `.html`. That replaces
    /// pages alone.
    #[arg(short, long, value_name = "F.html")]
    pub(crate) output: Option<PathBuf>,

    /// What is upright on the page.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = super::read::point,
        default_value = "0,1,0")]
    pub(crate) up: Point,

    #[command(flatten)]
    pub(crate) look: LookArgs,
}
