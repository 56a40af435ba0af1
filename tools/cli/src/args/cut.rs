//! What `cut` takes.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use tearmesh::Point;

use super::files::FileArgs;
use super::read::Gap;

const EXAMPLES: &str = "\
Examples:
  tearmesh cut flag.obj --rays 0,2,5:0,0,-1 0,-2,5:0,0,-1 -o torn.obj
      cuts a flag along x = 0, looking down the z-axis
  tearmesh cut flag.obj --rays 0,0,9@-1,0.2,0 0,0,9@1,0.2,0 --format json
      cuts between two points seen from the eye 0,0,9, and prints the report only";

/// Cut a mesh along the plane between two rays, or along a plane.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct CutArgs {
    /// Two rays, as origin:direction or origin@target; may be given repeatedly.
    ///
    /// A ray is `ox,oy,oz:dx,dy,dz` (origin and direction, of any length) or
    /// `ox,oy,oz@tx,ty,tz` (origin and a point that it is aimed at). The cut
    /// follows the plane through both rays, and ends at the rays unless --through is given; it goes
    /// through all that lies between them, front and back, unless --layers first is given.
    /// Several pairs are cuts one after another; where one begins with the ray with which the one
    /// before ended, both are parts of one polyline.
    #[arg(long, value_name = "A B")]
    pub(crate) rays: Vec<String>,

    /// A file of rays: two a line, `#` begins a comment.
    #[arg(long, value_name = "FILE")]
    pub(crate) rays_file: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) camera: CameraArgs,

    /// A plane in the place of rays, as point:normal; may be given repeatedly.
    ///
    /// `px,py,pz:nx,ny,nz`, the normal of any length. The mesh is cut wherever the plane goes.
    #[arg(
        long,
        value_name = "P:N",
        allow_hyphen_values = true,
        conflicts_with_all = ["rays", "rays_file", "through"]
    )]
    pub(crate) plane: Vec<String>,

    /// Cut all layers between the rays, or those that the rays meet first.
    ///
    /// first: of what hangs together where the plane meets the mesh, the part that the first ray
    /// hits first, and that of the second; where a ray misses, the part that comes next to it. A slit
    /// in the front of a garment leaves its back whole.
    #[arg(
        long,
        value_enum,
        value_name = "all|first",
        hide_possible_values = true,
        default_value_t,
        conflicts_with = "plane"
    )]
    pub(crate) layers: Layers,

    /// Show the lips of cuts this far apart: a length, or N% of an edge.
    ///
    /// A percentage is of the mean edge. The two sides of a cut coincide, so the cut is invisible,
    /// and programs that join coincident points close it. With this option each lip is written half
    /// the gap away from the other, within the surface, and not at all at a tip; where a face would turn
    /// over, less. The file has the true places too: `mend`, another `cut` and the masses go by
    /// these. Without it a gap stays as it is, and --gap 0 closes it.
    #[arg(long, value_name = "D", value_parser = super::read::gap, allow_hyphen_values = true)]
    pub(crate) gap: Option<Gap>,

    /// Write the seam into this file, as lines of OBJ.
    ///
    /// For each cut an object of `v` and `l` statements: the edges that it tore, in order.
    #[arg(long, value_name = "FILE")]
    pub(crate) seam: Option<PathBuf>,

    /// Write where each vertex, corner and face comes from, as JSON.
    ///
    /// For each `v` of the output and each corner of its faces, those of the input that it lies
    /// between, with weights; for each face the one that it was part of. All are counted from 0, corners
    /// through all faces. So weights, bones and materials of other programs can follow.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["repair", "separate_fans"])]
    pub(crate) map: Option<PathBuf>,

    /// Write each piece into a file of its own in this folder.
    ///
    /// `piece_00000.obj`, the largest, and so on, with the objects, groups, materials, texture
    /// coordinates and normals of its faces, and `pieces.json`, which lists them with these names. A
    /// piece by itself has no record of the cut and no gap: to mend, keep the whole as well, with -o.
    #[arg(long, value_name = "DIR")]
    pub(crate) pieces: Option<PathBuf>,

    /// How to cut.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) method: Method,

    /// How near the end of an edge, as a fraction of it, a crossing is moved to that end.
    ///
    /// 0 gives a seam straight to the last digit and may give thin faces; with R, the altitude of
    /// no new face is below R(1-R) of that of the face it was part of. An end of the cut moves
    /// within its face where it would leave a thinner one. Up to 0.49; for the method exact.
    #[arg(long, value_name = "R", allow_negative_numbers = true, default_value_t = tearmesh::Scissor::SNAP)]
    pub(crate) snap: f64,

    /// Move a vertex taken for a crossing onto the plane, along its edge.
    ///
    /// `tearmesh mend --simplify` puts it back.
    #[arg(long)]
    pub(crate) snap_move: bool,

    /// Cut wherever the plane goes, not only between the rays.
    #[arg(long)]
    pub(crate) through: bool,

    /// Where a cut ends: at vertices between the rays, or at edges whose midpoint is.
    #[arg(long, hide_short_help = true, value_enum, default_value_t)]
    pub(crate) tips: Tips,

    /// How a split divides mass: by the area of the faces, or by half.
    #[arg(long, hide_short_help = true, value_enum, default_value_t)]
    pub(crate) mass: Mass,

    /// Repair the input: also drop duplicate and superfluous faces.
    ///
    /// Of faces on the same three vertices the first stays, and of those on an edge the first two
    /// that run in opposite directions; then fans are separated as by --separate-fans. Each
    /// repair is a warning with its line. A flipped face is never repaired.
    #[arg(long)]
    pub(crate) repair: bool,

    /// Give each fan of an input vertex a vertex of its own.
    ///
    /// A fan is a set of faces round the vertex that are joined by shared edges. The
    /// first keeps the vertex, and the others get new ones at the same place.
    #[arg(long, hide_short_help = true)]
    pub(crate) separate_fans: bool,

    /// Succeed, and write the mesh, even if nothing was cut.
    #[arg(long)]
    pub(crate) allow_miss: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// Points of a picture in the place of rays.
#[derive(Debug, clap::Args)]
pub(crate) struct CameraArgs {
    /// A camera in the place of rays, with --fov, --viewport and --points.
    ///
    /// eye@target: what it looks at is in the middle of the picture, which shows it in perspective, as in
    /// --camera 0,0,5@0,0,0 --fov 40 --viewport 800x600 --points 200,300 600,250.
    #[arg(
        long,
        value_name = "EYE@AT",
        allow_hyphen_values = true,
        value_parser = super::read::look,
        requires_all = ["fov", "viewport", "points"],
        conflicts_with_all = ["rays", "rays_file", "plane"]
    )]
    pub(crate) camera: Option<[Point; 2]>,

    /// What is upright in the picture.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = super::read::point,
        default_value = "0,1,0", hide_short_help = true)]
    pub(crate) up: Point,

    /// The angle of view, from the lower edge to the upper one, in degrees.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "DEG",
        allow_negative_numbers = true,
        requires = "camera"
    )]
    pub(crate) fov: Option<f64>,

    /// The width and height of the picture in pixels.
    #[arg(long, hide_short_help = true, value_name = "WxH", value_parser = super::read::size, requires = "camera")]
    pub(crate) viewport: Option<[f64; 2]>,

    /// Two pixels of its picture, from the top left; may be given repeatedly.
    ///
    /// Fractions are places in a pixel: the middle of the first one is 0.5,0.5. A pair that begins
    /// where the one before ended goes on from there. The report says which --rays they are.
    #[arg(long, value_name = "X,Y X,Y", requires = "camera")]
    pub(crate) points: Vec<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Insert vertices where the plane crosses edges: a straight seam.
    #[default]
    Exact,
    /// Label the faces by side and unshare the seam; adds no face.
    Partition,
    /// The paper's first form: leaves irregular meshes undivided.
    Uniform,
    /// The paper's better form: leaves crumbs, and a long seam.
    Alternating,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tips {
    #[default]
    Vertex,
    Midpoint,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Layers {
    #[default]
    All,
    First,
}

impl Method {
    /// As it is typed, and as it stands in the report.
    pub(crate) fn name(self) -> &'static str {
        cut_name(self.of_library())
    }

    pub(crate) fn of_library(self) -> tearmesh::CutMethod {
        match self {
            Method::Exact => tearmesh::CutMethod::Exact,
            Method::Partition => tearmesh::CutMethod::Partition,
            Method::Uniform => tearmesh::CutMethod::Uniform,
            Method::Alternating => tearmesh::CutMethod::Alternating,
        }
    }
}

/// [`Method::name`] of a method of the library.
pub(crate) fn cut_name(method: tearmesh::CutMethod) -> &'static str {
    match method {
        tearmesh::CutMethod::Partition => "partition",
        tearmesh::CutMethod::Uniform => "uniform",
        tearmesh::CutMethod::Alternating => "alternating",
        _ => "exact",
    }
}

impl Tips {
    /// As it is typed, and as it stands in the report.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Tips::Vertex => "vertex",
            Tips::Midpoint => "midpoint",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mass {
    #[default]
    Area,
    Half,
}
