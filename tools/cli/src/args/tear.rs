//! What `tear` takes.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};

use super::files::FileArgs;
use crate::scene::SolverName;

const EXAMPLES: &str = "\
Examples:
  tearmesh tear flag.obj --scene rip -o torn.obj
      hangs a patch by its upper edge, grabs its middle, and drags it down until it rips
  tearmesh tear flag.obj --scene flag --frames frames --frames-topology final
      a flag in the wind, cut in two while it waves: 30 OBJ files a second

";

/// Simulate a cloth, and tear it.
///
/// The mesh is the cloth at rest, in metres; y is up unless --up says otherwise. Upright, its
/// height is up and its width the longer of the other two axes; one that lies flat is seen from
/// above. Corners and edges of scenes are those of its bounding box.
#[derive(Debug, Parser)]
#[command(after_long_help = format!("{EXAMPLES}{}", crate::scene::schema()))]
pub(crate) struct TearArgs {
    /// hang, flag, rip, trouser, fall, or a scene file in TOML.
    ///
    /// `hang`: two corners are clamped. `flag`: wind, and after 1.5 s a cut. `rip`: hung by its
    /// upper edge, one vertex is grabbed and dragged down. `trouser`: a slit strip, its legs pulled
    /// apart. `fall`: nothing is held. A scene file can start from one of these; its keys are listed below.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: String,

    /// The method: verlet (default), xpbd, pbd, provot or implicit.
    #[arg(long, value_enum, value_name = "METHOD", hide_possible_values = true)]
    pub(crate) solver: Option<SolverName>,

    /// Tear edges at this many times their rest length (1.5).
    ///
    /// The paper's rule. The finer the mesh, the easier it tears: compare forces only with
    /// --toughness.
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true, conflicts_with_all = ["toughness", "threshold_newton"])]
    pub(crate) threshold: Option<f64>,

    /// Tear by energy, in joules per metre of tear.
    ///
    /// Nearly the same mean force on every mesh.
    #[arg(
        long,
        value_name = "J_PER_M",
        allow_negative_numbers = true,
        conflicts_with = "threshold_newton"
    )]
    pub(crate) toughness: Option<f64>,

    /// Tear edges that pull harder than this, in newtons.
    #[arg(long, value_name = "F", allow_negative_numbers = true)]
    pub(crate) threshold_newton: Option<f64>,

    /// A file of lines `vertex strength`.
    ///
    /// A vertex tears at this multiple of the threshold. Vertices count from 1, as in OBJ; those
    /// not named have strength 1. `#` begins a comment. In a torn file a `v` that is written for
    /// another fan of a vertex (its comments `#~ fan` name it first) is that vertex.
    #[arg(long, value_name = "FILE")]
    pub(crate) strength: Option<PathBuf>,

    /// How long, in seconds (default: as the scene says).
    ///
    /// hang and fall 2, flag and rip 3, trouser 4.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seconds: Option<f64>,

    /// The step in seconds (default: one that suits).
    ///
    /// Verlet: the one at which a tenth of the vertices have to be carried by their neighbours;
    /// provot: 0.7 of the stability limit; xpbd: h/c, the time in which a pull travels an edge; pbd:
    /// 3.2 of that; implicit: 1/240; at most 1/120. A step given here is refused where it is not
    /// stable: for verlet beyond twice its own.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) dt: Option<f64>,

    /// Which way is up: x, y, z, -x, -y or -z (default y).
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = crate::scene::axis)]
    pub(crate) up: Option<tearmesh_cloth::scene::Axis>,

    /// Cut between two rays, at the time --cut-at.
    ///
    /// In the place of what the scene cuts; may be given repeatedly.
    #[arg(long, value_name = "A B", requires = "cut_at")]
    pub(crate) rays: Vec<String>,

    /// When to cut, in seconds.
    #[arg(
        long,
        value_name = "S",
        requires = "rays",
        allow_negative_numbers = true
    )]
    pub(crate) cut_at: Option<f64>,

    /// Play the scene again with 8 seeds, and with 8 at half the step: does the step decide?
    ///
    /// What tears is chaotic: each run begins with its vertices off by up to a nanometre and its faces in
    /// another order. First tear, torn length, pieces, forces and work are compared by their medians:
    /// the same, different, or one cannot tell. Takes some 24 times as long, on all processors.
    #[arg(long)]
    pub(crate) check_step: bool,

    /// Write the force at each hold as a table, by frames of 1/60 s.
    #[arg(long, value_name = "F.csv")]
    pub(crate) forces: Option<PathBuf>,

    /// Write frames into this folder, 30 a second.
    ///
    /// `frame_00000.obj` and so on; vertices keep their order, and new ones are appended: what is
    /// said of a vertex while the scene is played names it by its number there.
    #[arg(long, value_name = "DIR")]
    pub(crate) frames: Option<PathBuf>,

    /// Whether frames have their own faces, or the last one's.
    ///
    /// final: a vertex that is not yet born stands where its ancestor is, or where it will be
    /// inserted on its edge, so one index buffer serves all frames.
    #[arg(
        long,
        value_enum,
        value_name = "own|final",
        hide_possible_values = true,
        default_value_t,
        requires = "frames"
    )]
    pub(crate) frames_topology: Topology,

    /// Write a point cache (PC2), 30 samples a second, for the mesh of -o.
    ///
    /// Blender: import OUT, add the modifier Mesh Cache, and choose this file; the scene at 30 frames a
    /// second. It has the last one's faces, as with --frames-topology final: a vertex that is not yet born
    /// stands where it will come from. Coordinates are as in OUT, so axes stay as they are imported.
    #[arg(long, value_name = "F.pc2")]
    pub(crate) cache: Option<PathBuf>,

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
