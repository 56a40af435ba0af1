//! The arguments of `view`.

use std::path::PathBuf;

use clap::Parser;
use tearmesh::Point;

use super::look::LookArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh view torn.obj
      writes torn.html: open it in a browser, turn the mesh, click two points, and copy the command
  tearmesh view frames -o rip.html
      plays all OBJ files in the folder `frames`, 30 a second";

/// Show meshes on a page for a browser: one HTML file that needs no network.
///
/// Each piece has a colour, torn edges are red, and the boundary is dark. Click two points: the page shows the
/// cut between them, and the `tearmesh cut` command that makes it.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct ViewArgs {
    /// The OBJ files to show, or folders of them; `-` is standard input.
    ///
    /// Several meshes are played in the order given, and those of a folder by name: 30 per second, or one
    /// per second if there are fewer than a dozen. Each may have its own faces.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,

    /// Make a page on which the mesh is a cloth to be grabbed, ripped, cut and mended: the one of `play`.
    ///
    /// For another direction up, run `play`.
    #[arg(long, conflicts_with = "up")]
    pub(crate) play: bool,

    /// Where to write the page; `-` is standard output.
    ///
    /// Without it, the page is written to the current folder and named after the first input, with the
    /// ending `.html` (with --play, it is `play.html`). Only a page of tearmesh is replaced then.
    #[arg(short, long, value_name = "F.html")]
    pub(crate) output: Option<PathBuf>,

    /// The direction that is up on the page: x, y, z, -x, -y, -z, or X,Y,Z.
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = super::read::up,
        default_value = "y")]
    pub(crate) up: Point,

    #[command(flatten)]
    pub(crate) look: LookArgs,
}
