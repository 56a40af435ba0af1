//! The arguments of `tear`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use tearmesh::Point;

use super::files::FileArgs;
use super::scene::ChangeArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh tear flag.obj --scene rip -o torn.obj
      hangs a patch by its upper edge, and drags its middle down until it rips
  tearmesh tear flag.obj --scene flag --frames frames --frames-topology final
      a flag in the wind, cut in two while it waves: 30 OBJ files per second

";

/// Simulate a cloth, and tear it.
///
/// The mesh is the cloth at rest, in metres; y is up unless --up is given. Height is measured up,
/// and width along the longer of the other two axes. Cloth that lies flat is seen from above.
/// The corners and edges of scenes are those of the bounding box.
#[derive(Debug, Parser)]
#[command(after_long_help = format!("{EXAMPLES}{}", crate::scene::schema()))]
pub(crate) struct TearArgs {
    /// hang, flag, rip, trouser, fall, or a scene file in TOML.
    ///
    /// `hang`: two corners are held. `flag`: wind, and a cut after 1.5 s. `rip`: the cloth hangs by its
    /// upper edge while one vertex is dragged down. `trouser`: a strip with a slit, its legs pulled
    /// apart. `fall`: nothing is held. A scene file can start from one of these; its keys are listed below.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: String,

    #[command(flatten)]
    pub(crate) change: ChangeArgs,

    /// Write a table of the force at each hold, per frame of 1/60 s.
    ///
    /// Also with --dry-run.
    #[arg(long, value_name = "F.csv")]
    pub(crate) forces: Option<PathBuf>,

    /// The moment of --picture, in seconds (default: after the frame of 1/30 s in which most was torn).
    #[arg(long, value_name = "S", requires = "picture", value_parser = super::read::seconds)]
    pub(crate) picture_at: Option<f64>,

    /// Write frames into this folder, 30 per second.
    ///
    /// `frame_00000.obj` and so on. Vertices keep their order, and new ones are appended. Messages about
    /// vertices use these numbers.
    #[arg(long, value_name = "DIR")]
    pub(crate) frames: Option<PathBuf>,

    /// Give each frame its own faces, or those of the last frame.
    ///
    /// final: one index buffer serves all frames. A vertex that does not exist yet is where its source is,
    /// or where it will be inserted on its edge.
    #[arg(
        long,
        value_enum,
        value_name = "own|final",
        hide_possible_values = true,
        default_value_t,
        requires = "frames"
    )]
    pub(crate) frames_topology: Topology,

    /// Write a point cache (PC2) for the mesh of -o.
    ///
    /// It has 30 samples per second. In Blender, import OUT, add the modifier Mesh Cache, and choose this file; set the scene to 30 frames
    /// per second. The faces are those of the last frame, as with --frames-topology final. Coordinates are as
    /// in OUT, so axes stay as imported.
    #[arg(long, value_name = "F.pc2")]
    pub(crate) cache: Option<PathBuf>,

    /// Subtract this point from all points of --cache.
    ///
    /// A cache has numbers of 32 bits, too coarse for a cloth far from the origin: one is refused that would move a
    /// point by more than a thousandth of the mean edge. In Blender, move the object to this point.
    #[arg(long, value_name = "X,Y,Z", requires = "cache", allow_hyphen_values = true,
        value_parser = super::read::point, hide_short_help = true)]
    pub(crate) cache_origin: Option<Point>,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// Whose faces a frame has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Topology {
    #[default]
    Own,
    Final,
}
