//! What can be typed.

use std::ffi::{OsStr, OsString};
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};
use tearmesh::Point;
use tearmesh_lab::pareto::{MeshKind, SCENES};

use crate::say::Color;
use crate::scene::SolverName;

/// Cuts and tears triangle meshes in OBJ files, and verifies what it does.
#[derive(Debug, Parser)]
#[command(name = "tearmesh", version, disable_help_subcommand = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Cut(Box<CutArgs>),
    Tear(Box<TearArgs>),
    Mend(MendArgs),
    Check(CheckArgs),
    Chart(ChartArgs),
}

/// Where a verb reads and writes, and how it says what it did.
#[derive(Debug, clap::Args)]
pub(crate) struct FileArgs {
    /// The OBJ file to read; `-` is standard input.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,

    /// Where to write the mesh; `-` is standard output.
    ///
    /// Without it the mesh goes to standard output if that is a pipe or a file.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,

    /// Allow the output to replace the input.
    #[arg(long)]
    pub(crate) in_place: bool,

    /// Do everything but write.
    #[arg(long)]
    pub(crate) dry_run: bool,

    /// Print words, or the report as JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: Format,

    /// Write the JSON report to a file as well.
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,

    /// Leave times out of the report, so that it is the same on every run.
    #[arg(long)]
    pub(crate) no_timing: bool,

    /// When to use colours.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

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
    /// follows the plane through both rays, and ends at the rays unless --through is given.
    /// Several pairs are cuts one after another; where one begins with the ray with which the one
    /// before ended, both are parts of one polyline.
    #[arg(long, value_name = "A B")]
    pub(crate) rays: Vec<String>,

    /// A file of rays: two a line, `#` begins a comment.
    #[arg(long, value_name = "FILE")]
    pub(crate) rays_file: Option<PathBuf>,

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

    /// Write the seam into this file, as lines of OBJ.
    ///
    /// For each cut an object of `v` and `l` statements: the edges that it tore, in order.
    #[arg(long, value_name = "FILE")]
    pub(crate) seam: Option<PathBuf>,

    /// How to cut.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) method: Method,

    /// How near an end of its edge, as a part of it, a crossing is taken for the end.
    ///
    /// 0 gives a seam straight to the last digit and may give thin faces; with R, the altitude of
    /// no new face is below R(1-R) of that of the face it was part of. An end of the cut moves
    /// within its face where it would leave a thinner one. Up to 0.49; for the method exact.
    #[arg(long, value_name = "R", allow_negative_numbers = true, default_value_t = tearmesh::Scissor::SNAP)]
    pub(crate) snap: f64,

    /// Move a vertex that was taken for a crossing onto the plane, along the edge.
    ///
    /// `tearmesh mend --simplify` puts it back.
    #[arg(long)]
    pub(crate) snap_move: bool,

    /// Cut wherever the plane goes, not only between the rays.
    #[arg(long)]
    pub(crate) through: bool,

    /// Where a cut ends: at vertices between the rays, or at edges whose midpoint is.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) tips: Tips,

    /// How a split divides mass: by the area of the faces, or by half.
    #[arg(long, value_enum, default_value_t)]
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
    #[arg(long)]
    pub(crate) separate_fans: bool,

    /// Succeed, and write the mesh, even if nothing was cut.
    #[arg(long)]
    pub(crate) allow_miss: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

const TEAR_EXAMPLES: &str = "\
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
#[command(after_long_help = format!("{TEAR_EXAMPLES}{}", crate::scene::schema()))]
pub(crate) struct TearArgs {
    /// hang, flag, rip, trouser, or a scene file in TOML.
    ///
    /// `hang`: two corners are clamped. `flag`: wind, and after 1.5 s a cut. `rip`: hung by its
    /// upper edge, one vertex is grabbed and dragged down. `trouser`: a slit strip, its legs pulled
    /// apart. A scene file can start from one of these; its keys are listed below.
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

    /// Tear by energy, in joules for each metre.
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
    /// A vertex tears at so many times the load of the threshold. Vertices count from 1, as in OBJ;
    /// those not named have strength 1. `#` begins a comment. In a torn file a `v` that is written
    /// for another fan of a vertex (its comments `#~ fan` name it first) is that vertex.
    #[arg(long, value_name = "FILE")]
    pub(crate) strength: Option<PathBuf>,

    /// How long, in seconds (default: as the scene says).
    ///
    /// hang 2, flag and rip 3, trouser 4.
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

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

const MEND_EXAMPLES: &str = "\
Examples:
  tearmesh mend torn.obj -o whole.obj
      sews everything that was torn
  tearmesh mend torn.obj --last 1 --simplify -o before.obj
      undoes the last cut, and takes out the vertices that it inserted";

/// Sew what was torn, from the record that the file has of it.
#[derive(Debug, Parser)]
#[command(after_long_help = MEND_EXAMPLES)]
pub(crate) struct MendArgs {
    /// Undo only the last N cuts.
    #[arg(long, value_name = "N", conflicts_with = "near")]
    pub(crate) last: Option<NonZeroUsize>,

    /// Sew only what lies near this point: within --radius of it.
    #[arg(long, value_name = "X,Y,Z", requires = "radius", allow_hyphen_values = true, value_parser = point)]
    pub(crate) near: Option<Point>,

    /// How near.
    #[arg(
        long,
        value_name = "R",
        requires = "near",
        allow_negative_numbers = true
    )]
    pub(crate) radius: Option<f64>,

    /// Sew nothing if two vertices that belong together are farther apart than this.
    ///
    /// What moved apart is otherwise joined at the mean, by mass.
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,

    /// Take out the vertices that cuts inserted and that keep nothing apart any more.
    ///
    /// And put back, to the bit, those that a cut with --snap-move moved. Without this option both
    /// stay, and another `mend --simplify` can still do it. What was edited since is kept.
    #[arg(long)]
    pub(crate) simplify: bool,

    #[command(flatten)]
    pub(crate) files: FileArgs,
}

/// Reads a point.
fn point(text: &str) -> Result<Point, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|number| number.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect::<Option<_>>()
        .unwrap_or_default();
    match numbers[..] {
        [x, y, z] => Ok(Point::new(x, y, z)),
        _ => Err("expected three numbers with commas between them, as in 0,1.5,0".to_owned()),
    }
}

const CHECK_EXAMPLES: &str = "\
Examples:
  tearmesh check models/*.obj
      a line for each file: ok, or the first thing that is wrong, with its line
  tearmesh check -v shirt.obj
      everything that is wrong, with the text of the lines concerned";

/// Check OBJ files: whether they can be read and are meshes that can be cut.
#[derive(Debug, Parser)]
#[command(after_long_help = CHECK_EXAMPLES)]
pub(crate) struct CheckArgs {
    /// The OBJ files; `-` is standard input.
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,

    /// Print a line of words for each file, or a line of JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: Format,

    /// When to use colours.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print only the files that fail.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Show everything there is to say of each file, with the text of the lines.
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

const CHART_EXAMPLES: &str = "\
Examples:
  tearmesh chart tear -o tear.svg
      the force that tears strips of five meshes, by stretch ratio and by toughness
  tearmesh chart pareto --scene swing,hang --size 8 -o p.svg --csv p.csv
      what each method costs and how far it is off, in two scenes on a small mesh";

/// Make an experiment, and draw its chart.
#[derive(Debug, Parser)]
#[command(after_long_help = CHART_EXAMPLES)]
pub(crate) struct ChartArgs {
    /// Which: tear (force to tear, against displacement and mesh size), or pareto (work of all methods
    /// against precision).
    #[arg(value_enum, value_name = "WHAT", hide_possible_values = true)]
    pub(crate) what: What,

    /// Where to write the chart, as SVG; `-` is standard output.
    #[arg(short, long, value_name = "X.svg")]
    pub(crate) output: PathBuf,

    /// Write the figures as a table.
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,

    /// Write the figures as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) pareto: ParetoArgs,

    /// When to use colours on the screen.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// What `chart pareto` takes beside what all charts do.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Options of pareto")]
pub(crate) struct ParetoArgs {
    /// The scenes, all unless named.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        value_parser = clap::builder::PossibleValuesParser::new(SCENES.map(|scene| scene.name)))]
    pub(crate) scene: Vec<String>,

    /// How sheets are meshed.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "grid")]
    pub(crate) mesh: Vec<ChartMesh>,

    /// Cells a side.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "16",
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,

    /// How many runs go on at a time; as many as there are processors unless said.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// The visits of edges after which a run is given up.
    #[arg(long, value_name = "N")]
    pub(crate) visits_max: Option<u64>,

    /// Take times, and write a second chart by CPU time.
    #[arg(long, value_name = "T.svg")]
    pub(crate) time_chart: Option<PathBuf>,

    /// How often each run is made again, alone, for its time; 0 takes that of the one beside others.
    #[arg(long, value_name = "N", default_value = "5", requires = "time_chart")]
    pub(crate) repeats: u32,
}

impl ParetoArgs {
    /// An option that was given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let all = [
            ("--scene", !self.scene.is_empty()),
            ("--mesh", self.mesh != [ChartMesh::Grid]),
            ("--size", self.size != [16]),
            ("--threads", self.threads.is_some()),
            ("--visits-max", self.visits_max.is_some()),
            ("--time-chart", self.time_chart.is_some()),
        ];
        all.into_iter()
            .find(|(_, given)| *given)
            .map(|(name, _)| name)
    }
}

/// How a chart's sheets are meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ChartMesh {
    Grid,
    Delaunay,
}

impl ChartMesh {
    pub(crate) fn of_library(self) -> MeshKind {
        match self {
            ChartMesh::Grid => MeshKind::Grid,
            ChartMesh::Delaunay => MeshKind::Delaunay,
        }
    }
}

/// An experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum What {
    Tear,
    Pareto,
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

/// Whose faces a frame has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Topology {
    #[default]
    Own,
    Final,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mass {
    #[default]
    Area,
    Half,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    Json,
}

/// Makes one argument of `--rays A B`, so that a negative number is no option, and an option is
/// no second ray.
///
/// `--rays A B`, `--rays "A B"`, `--rays "A;B"` and `--rays=A B` all become `--rays=A;B`. What
/// does not look like a ray is left to the parser.
pub(crate) fn join_rays(args: &[OsString]) -> Vec<OsString> {
    let mut joined = Vec::with_capacity(args.len());
    let mut rest = args.iter().peekable();
    while let Some(arg) = rest.next() {
        if arg == "--" {
            joined.push(arg.clone());
            joined.extend(rest.by_ref().cloned());
            break;
        }
        let mut value = match arg.to_str() {
            Some("--rays") => String::new(),
            Some(arg) if arg.starts_with("--rays=") => arg["--rays=".len()..].to_owned(),
            _ => {
                joined.push(arg.clone());
                continue;
            }
        };
        while crate::rays::split_pair(&value).count() < 2
            && let Some(ray) = rest.next_if(|next| looks_like_rays(next))
        {
            value.push(';');
            value.push_str(&ray.to_string_lossy());
        }
        if value.is_empty() && arg == "--rays" {
            joined.push(arg.clone());
        } else {
            joined.push(format!("--rays={}", value.trim_start_matches(';')).into());
        }
    }
    joined
}

/// Whether an argument is meant as a ray: numbers with commas between them, or what is written like
/// one, for which an error about the ray says more than one about an argument too many.
fn looks_like_rays(arg: &OsStr) -> bool {
    let text = arg.to_string_lossy();
    let number = text.trim_start().trim_start_matches(['+', '-']);
    let is_number = number.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_ray = !text.starts_with('-') && text.contains([':', '@']);
    text.contains(',') && (is_number || is_ray)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(args: &str) -> String {
        let args: Vec<OsString> = args.split('|').map(OsString::from).collect();
        let joined = join_rays(&args);
        joined
            .iter()
            .map(|arg| arg.to_string_lossy())
            .collect::<Vec<_>>()
            .join("|")
    }

    #[test]
    fn the_arguments_parse_without_a_clash() {
        use clap::CommandFactory as _;
        Args::command().debug_assert();
    }

    #[test]
    fn two_rays_become_one_argument_however_they_are_written() {
        let one = "cut|--rays=1,2,3:4,5,6;-1,0,0@7,8,9|-o|x";
        for args in [
            "cut|--rays|1,2,3:4,5,6|-1,0,0@7,8,9|-o|x",
            "cut|--rays|1,2,3:4,5,6;-1,0,0@7,8,9|-o|x",
            "cut|--rays=1,2,3:4,5,6;-1,0,0@7,8,9|-o|x",
            "cut|--rays=1,2,3:4,5,6|-1,0,0@7,8,9|-o|x",
        ] {
            assert_eq!(joined(args), one);
        }
        assert_eq!(
            joined("cut|--rays|1,2,3:4,5,6 -1,0,0@7,8,9|-o|x"),
            "cut|--rays=1,2,3:4,5,6 -1,0,0@7,8,9|-o|x"
        );
    }

    #[test]
    fn what_is_no_ray_is_left_alone() {
        assert_eq!(
            joined("cut|--rays|1,2,3:4,5,6|-o|x"),
            "cut|--rays=1,2,3:4,5,6|-o|x"
        );
        assert_eq!(joined("cut|--rays|-o|x"), "cut|--rays|-o|x");
        assert_eq!(
            joined("cut|--|--rays|1,2,3:4,5,6|1,2,3:4,5,6"),
            "cut|--|--rays|1,2,3:4,5,6|1,2,3:4,5,6"
        );
        assert_eq!(joined("cut|--rays-file|a,b"), "cut|--rays-file|a,b");
    }
}
