//! The arguments of `play`.

use std::path::PathBuf;

use clap::Parser;
use tearmesh_cloth::scene::Axis;

use super::look::LookArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh play -o play.html
      a sheet of 1 m that hangs by its upper edge: open the page in a browser, grab the sheet, and rip it
  tearmesh play flag.obj --scene flag -o play.html
      a flag in the wind, to be cut while it waves
  tearmesh play dress.obj --scene dress.toml -o play.html
      a garment that is sewn round a body";

/// Make a page on which a cloth is grabbed, ripped, cut and mended.
///
/// The page is one HTML file that needs no network: the simulation runs in it. It takes other OBJ files by drag
/// and drop, and saves what became of the cloth, with the record of its tears and cuts.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct PlayArgs {
    /// The OBJ file of the cloth at rest, in metres; `-` is standard input.
    ///
    /// Without it, the page shows a sheet of 1 m. At most 20,000 vertices.
    #[arg(value_name = "IN")]
    pub(crate) input: Option<PathBuf>,

    /// rip, hang, flag, trouser, fall, or a scene file in TOML, as of `tear`.
    ///
    /// What the scene holds from the beginning is held, its wind blows, its seams are sewn, and its colliders are
    /// there. What it moves or cuts later is left to the hand. The default, `rip`, holds the highest 3 % of the
    /// cloth. A scene file needs the mesh that it is of.
    #[arg(long, value_name = "SCENE", default_value = "rip")]
    pub(crate) scene: String,

    /// The direction that is up: x, y, z, -x, -y or -z (default: that of the scene file, or y).
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = super::read::up_axis)]
    pub(crate) up: Option<Axis>,

    /// First, sew boundary edges that lie on each other.
    ///
    /// Programs that write a vertex for each texture coordinate or normal leave such seams, and the parts
    /// are loose. With --weld=D, sides that are up to D apart are sewn in their middle. Edges at which
    /// more than two sides meet stay apart. The output has the seams sewn.
    #[arg(long, value_name = "D", num_args = 0..=1, require_equals = true, default_missing_value = "0",
        value_parser = super::read::distance)]
    pub(crate) weld: Option<f64>,

    /// Where to write the page; `-` is standard output.
    ///
    /// Without it, the page is `play.html` in the current folder. Only a page of tearmesh is replaced then.
    #[arg(short, long, value_name = "F.html")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) look: LookArgs,
}
