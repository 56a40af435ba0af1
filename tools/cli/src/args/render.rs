//! The arguments of `render`.

use std::path::PathBuf;

use clap::Parser;
use tearmesh::Point;
use tearmesh_view::PictureSize;

use super::look::LookArgs;

const EXAMPLES: &str = "\
Examples:
  tearmesh render torn.obj -o torn.png
      the whole mesh, from its broad side: pieces in colours, torn edges red
  tearmesh render flag.obj --scene rip --strip 4 -o strip.png
      four moments of the scene, from the first tear on
  tearmesh render flag.obj --rays 0.3,2,5:0,0,-1 0.3,-2,5:0,0,-1 --edges -o cut.png
      the cut between two rays, and the edges of the mesh";

/// Draw a picture of a mesh, as PNG.
///
/// Each piece has a colour, torn edges are red, and the boundary is dark. No window and no graphics card
/// are needed, and the same input gives the same picture on every machine.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct RenderArgs {
    /// The OBJ file to read; `-` is standard input.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,

    /// Where to write the picture; `-` is standard output.
    #[arg(short, long, value_name = "F.png")]
    pub(crate) output: PathBuf,

    /// The width and height of the picture in pixels.
    #[arg(long, value_name = "WxH", value_parser = super::read::size, default_value = "960x720")]
    pub(crate) size: PictureSize,

    /// The eye, and the point that it looks at: eye@target.
    ///
    /// `cut --camera` cuts between two pixels of this picture (--points) if it gets the same --camera,
    /// --up and --fov, and this --size as --viewport. Without a camera, the picture shows the whole mesh from
    /// its broad side, a little from above.
    #[arg(long, value_name = "EYE@AT", allow_hyphen_values = true, value_parser = super::read::look)]
    pub(crate) camera: Option<[Point; 2]>,

    /// The direction that is up in the picture: x, y, z, -x, -y, -z, or X,Y,Z.
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = super::read::up,
        default_value = "y")]
    pub(crate) up: Point,

    /// The vertical angle of view, in degrees.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, default_value_t = tearmesh_view::ANGLE_OF_VIEW)]
    pub(crate) fov: f64,

    /// Draw two rays, and the cut between them; may be given repeatedly.
    ///
    /// Written as for `cut --rays`.
    #[arg(long, value_name = "A B")]
    pub(crate) rays: Vec<String>,

    /// Draw the cut along a plane, as point:normal; may be given repeatedly.
    #[arg(long, value_name = "P:N", allow_hyphen_values = true)]
    pub(crate) plane: Vec<String>,

    /// Draw the bounding box of the mesh.
    #[arg(long = "box")]
    pub(crate) bounding_box: bool,

    /// Draw the edges between faces.
    #[arg(long)]
    pub(crate) edges: bool,

    /// Draw each face flat.
    #[arg(long, conflicts_with = "crease")]
    pub(crate) flat: bool,

    /// Draw edges as creases where two faces meet at this angle or more, in degrees.
    ///
    /// Without it, a mesh is drawn smooth, as cloth is, unless the file has normals that differ at a
    /// vertex; then the angle is 40 degrees.
    #[arg(long, value_name = "DEG", value_parser = super::read::angle)]
    pub(crate) crease: Option<f64>,

    /// Draw each face divided into N² faces, and bent as its normals say.
    #[arg(long, value_name = "N", default_value_t = 1, conflicts_with_all = ["flat", "crease"],
        value_parser = clap::value_parser!(u32).range(1..=8))]
    pub(crate) finer: u32,

    /// Draw threads that hang out of tears, along the texture if the file has one.
    #[arg(long)]
    pub(crate) fringe: bool,

    /// Also write the surface as it is drawn, for another renderer.
    ///
    /// It has normals, the faces of --finer, and the threads of --fringe as lines of the group `fringe`, but no
    /// record of its tears: cut and mend the file that was read.
    #[arg(long, value_name = "F.obj", conflicts_with = "strip")]
    pub(crate) obj: Option<PathBuf>,

    /// Play a scene, and draw N moments of it beside each other, from the first tear to the end.
    ///
    /// Each moment has the width and height of --size.
    #[arg(long, value_name = "N", requires = "scene", value_parser = clap::value_parser!(u32).range(1..=12))]
    pub(crate) strip: Option<u32>,

    /// The scene to play for --strip: hang, flag, rip, trouser, fall, or a scene file, as for `tear`.
    #[arg(long, value_name = "S", requires = "strip")]
    pub(crate) scene: Option<String>,

    /// How long to play it, in seconds.
    #[arg(long, value_name = "S", requires = "strip", value_parser = super::read::seconds)]
    pub(crate) seconds: Option<f64>,

    #[command(flatten)]
    pub(crate) look: LookArgs,
}
