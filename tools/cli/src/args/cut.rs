//! The arguments of `cut`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use tearmesh::{CutLayers, CutMethod, CutTips, Point};
use tearmesh_view::PictureSize;

use super::files::FileArgs;
use super::read::Gap;
use crate::choice::Choice as _;

const EXAMPLES: &str = "\
Examples:
  tearmesh cut flag.obj --rays 0,2,5:0,0,-1 0,-2,5:0,0,-1 -o torn.obj
      cuts a flag along x = 0, seen along the z-axis
  tearmesh cut flag.obj --rays 0,0,9@-1,0.2,0 0,0,9@1,0.2,0 --format json
      cuts between two points as seen from 0,0,9, and prints only the report";

/// Cut a mesh along the plane between two rays, or along a plane.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct CutArgs {
    /// Two rays, as origin:direction or origin@target; may be given repeatedly.
    ///
    /// A ray is `ox,oy,oz:dx,dy,dz` (origin and direction, of any length) or `ox,oy,oz@tx,ty,tz`
    /// (origin and target). The cut follows the plane through both rays, and goes through everything
    /// between them, front and back. --through extends it beyond the rays; --layers first limits it
    /// to the surface that they hit first. Several pairs are several cuts, made in order. A pair that
    /// begins with the last ray of the pair before continues its cut, as a polyline.
    #[arg(long, value_name = "A B")]
    pub(crate) rays: Vec<String>,

    /// Read rays from a file: two per line, `#` begins a comment.
    #[arg(long, value_name = "FILE")]
    pub(crate) rays_file: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) camera: CameraArgs,

    /// Cut along a plane, as point:normal; may be given repeatedly.
    ///
    /// `px,py,pz:nx,ny,nz`; the normal may have any length. The mesh is cut wherever it crosses the plane.
    #[arg(
        long,
        value_name = "P:N",
        allow_hyphen_values = true,
        conflicts_with_all = ["rays", "rays_file", "through"]
    )]
    pub(crate) plane: Vec<String>,

    /// Cut all layers between the rays, or only the first.
    ///
    /// first: cut only the connected strip of surface that the rays hit first. The back of a garment
    /// stays whole. If a ray misses the mesh, the strip nearest to it is cut.
    #[arg(long, value_parser = CutLayers::parser(), value_name = "all|first", hide_possible_values = true,
        default_value = "all")]
    pub(crate) layers: CutLayers,

    /// Write the two sides of a cut this far apart: a length, or N% of the mean edge.
    ///
    /// The two sides coincide, so a cut is invisible, and programs that merge coincident points close
    /// it. This option moves the pieces that a cut separates, each by half the gap. Along a slit, it
    /// moves the vertices of each side by half the gap, within the surface: the tips stay in place, and
    /// a vertex moves less if a face would flip. The file records the true positions too: `mend`,
    /// later cuts and masses use those. Without this option, a gap stays as it is; --gap 0 closes it.
    #[arg(long, value_name = "D", value_parser = super::read::gap, allow_hyphen_values = true)]
    pub(crate) gap: Option<Gap>,

    /// Write the seam to this file, as OBJ lines.
    ///
    /// Each cut is an object of `v` and `l` statements: the edges that it tore, in order.
    #[arg(long, value_name = "FILE")]
    pub(crate) seam: Option<PathBuf>,

    /// Write the source of each vertex, corner and face, as JSON.
    ///
    /// For each `v` of the output and each corner of its faces: the ones of the input that it lies
    /// between, with weights. For each face: the face that it was part of. All count from 0, and corners
    /// count through all faces. Use it to carry over weights, bones and materials.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["repair", "separate_fans", "weld"])]
    pub(crate) map: Option<PathBuf>,

    /// Write each piece to a file of its own in this folder.
    ///
    /// `piece_00000.obj` is the largest. A piece has the objects, groups, materials, texture
    /// coordinates and normals of its faces; `pieces.json` lists all pieces, with these names. Pieces
    /// have no record of the cut, and no gap: to mend, keep the whole mesh as well, with -o. The pieces
    /// of an earlier run in the folder are replaced; a folder with other pieces is refused.
    #[arg(long, value_name = "DIR")]
    pub(crate) pieces: Option<PathBuf>,

    /// The cutting method.
    #[arg(long, value_parser = CutMethod::parser(), default_value = "exact")]
    pub(crate) method: CutMethod,

    /// Snap a crossing to an edge's endpoint if it is closer than this fraction of the edge.
    ///
    /// For the method exact; from 0 to 0.49. 0 makes the seam straight to the last digit, and may
    /// leave thin faces. With R, each new face keeps at least R(1-R) of the altitude of the face that
    /// it was part of; an end of the cut moves within its face to avoid a thinner one.
    #[arg(long, value_name = "R", allow_negative_numbers = true, value_parser = super::read::snap,
        default_value_t = tearmesh::Scissor::SNAP)]
    pub(crate) snap: f64,

    /// Move a vertex that a crossing snapped to onto the plane, along its edge.
    ///
    /// A vertex stays if a face would get thinner than --snap allows, at a corner of the boundary or on
    /// a curved one, and where the mesh is torn. `tearmesh mend --simplify` moves vertices back.
    #[arg(long)]
    pub(crate) snap_move: bool,

    /// Cut along the whole plane, not only between the rays.
    #[arg(long)]
    pub(crate) through: bool,

    /// End a cut at vertices between the rays, or at edges with their midpoint between the rays.
    #[arg(long, hide_short_help = true, value_parser = CutTips::parser(), default_value = "vertex")]
    pub(crate) tips: CutTips,

    /// Divide the mass of a split vertex by the area of its faces, or in half.
    #[arg(long, hide_short_help = true, value_enum, default_value_t)]
    pub(crate) mass: Mass,

    /// Repair the input: drop duplicate and superfluous faces, and separate fans.
    ///
    /// Of the faces on the same three vertices, the first stays. Of the faces on one edge, the first
    /// two with opposite directions stay. Then fans are separated, as by --separate-fans. Each repair
    /// is a warning with its line. Flipped faces are never repaired.
    #[arg(long)]
    pub(crate) repair: bool,

    /// Give each fan of an input vertex a vertex of its own.
    ///
    /// A fan is a set of faces around a vertex that are joined by shared edges. The first fan keeps
    /// the vertex; the others get new ones at the same place.
    #[arg(long, hide_short_help = true)]
    pub(crate) separate_fans: bool,

    /// First, sew boundary edges that lie on each other.
    ///
    /// Programs that write a vertex for each texture coordinate or normal leave such seams, and the parts
    /// are loose. With --weld=D, sides that are up to D apart are sewn in their middle. Edges at which
    /// more than two sides meet stay apart. The output has the seams sewn.
    #[arg(long, value_name = "D", num_args = 0..=1, require_equals = true, default_missing_value = "0",
        value_parser = super::read::distance, hide_short_help = true)]
    pub(crate) weld: Option<f64>,

    /// Succeed and write the mesh even if nothing was cut.
    #[arg(long)]
    pub(crate) allow_miss: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// Points of a picture instead of rays.
#[derive(Debug, clap::Args)]
pub(crate) struct CameraArgs {
    /// Cut between points of a picture, with --points.
    ///
    /// eye@target: the target is in the middle of the picture, which is in perspective. For example,
    /// --camera 0,0,5@0,0,0 --points 200,300 600,250. Of another size or angle than `render` draws by
    /// default, say so with --viewport and --fov.
    #[arg(
        long,
        value_name = "EYE@AT",
        allow_hyphen_values = true,
        value_parser = super::read::look,
        requires = "points",
        conflicts_with_all = ["rays", "rays_file", "plane"]
    )]
    pub(crate) camera: Option<[Point; 2]>,

    /// The direction that is up in pictures and pages: x, y, z, -x, -y, -z, or X,Y,Z.
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = super::read::up,
        default_value = "y", hide_short_help = true)]
    pub(crate) up: Point,

    /// The vertical angle of view, in degrees.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "DEG",
        allow_negative_numbers = true,
        default_value_t = tearmesh_view::ANGLE_OF_VIEW,
        requires = "camera"
    )]
    pub(crate) fov: f64,

    /// The width and height of the picture in pixels.
    #[arg(long, hide_short_help = true, value_name = "WxH", value_parser = super::read::size,
        default_value = "960x720", requires = "camera")]
    pub(crate) viewport: PictureSize,

    /// Two pixels of the picture, from the top left; may be given repeatedly.
    ///
    /// Fractions are allowed: the middle of the first pixel is 0.5,0.5. A pair that begins with the
    /// last point of the pair before continues its cut. The report has the same cut as --rays.
    #[arg(long, value_name = "X,Y X,Y", requires = "camera")]
    pub(crate) points: Vec<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mass {
    #[default]
    Area,
    Half,
}
