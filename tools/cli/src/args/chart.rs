//! The arguments of `chart`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Parser, Subcommand};
use tearmesh_lab::default_names;
use tearmesh_lab::pareto::{VISITS_MAX, scene_names};
use tearmesh_lab::sheet::MeshKind;
use tearmesh_lab::stability::STIFFNESS_N_PER_M;
use tearmesh_lab::step;
use tearmesh_lab::tear;
use tearmesh_lab::tear::EnsembleScene;

use super::read::within;
use super::scene::ChangeArgs;
use crate::say::Color;

const EXAMPLES: &str = "\
Examples:
  tearmesh chart guide --quick -o guide.svg
      which method to use for which scene, on small meshes
  tearmesh chart pareto --scene swing,hang --size 8 -o p.svg --csv p.csv
      the cost and the error of every method, in two scenes on a small mesh
  tearmesh chart pareto --from p.csv -o p.svg
      the same chart again from its table, without a run
  tearmesh chart step flag.obj --scene rip -o step.svg
      whether the result of a scene on a mesh depends on the time step";

/// Run an experiment and plot the result.
///
/// A name such as `bdf2-100@2` is a run: the method BDF2 with a tolerance of 100, at twice its base step. For
/// `pbd-4` and `xpbd-4`, the number is that of sweeps per step. `@default` stands for default settings.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES, disable_help_subcommand = true)]
pub(crate) struct ChartArgs {
    #[command(subcommand)]
    pub(crate) what: What,
}

/// An experiment.
#[derive(Debug, Subcommand)]
pub(crate) enum What {
    /// Which method to use for which scene: cost against error in the built-in scenes.
    Guide(GuideArgs),
    /// Work against precision: the cost and the error of every method over many steps.
    Pareto(ParetoArgs),
    /// Where methods fail, in theory and as measured, and which messages users get.
    Stability(StabilityArgs),
    /// The force that tears strips of five meshes, by stretch ratio and by toughness; and what follows the first
    /// tear, over many seeds.
    Tear(TearChartArgs),
    /// Whether the result of a scene depends on its time step: the scene with many seeds, at its step and at half of it.
    Step(Box<StepArgs>),
    /// The time of cuts by every method, the distance of their seams from the plane, their pieces and their faces.
    Cut(CutChartArgs),
    /// The time to split vertices while a cloth is ripped, with ghost pairs and without (Figure 7 of the paper).
    Fig7(Fig7Args),
}

/// The arguments of all charts.
#[derive(Debug, clap::Args)]
pub(crate) struct DrawArgs {
    /// Write the chart as SVG; `-` is standard output.
    #[arg(short, long, value_name = "X.svg", required_unless_present = "csv")]
    pub(crate) output: Option<PathBuf>,

    /// Write the table, with a row for each run.
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,

    /// Draw this table of the same chart, and run nothing.
    #[arg(long, value_name = "TABLE.csv")]
    pub(crate) from: Option<PathBuf>,

    /// Runs at a time (default: one per processor; `cut` and `fig7` are timed one by one).
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// When to use colours on the screen.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// The arguments of `chart guide`.
#[derive(Debug, clap::Args)]
pub(crate) struct GuideArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells along the longest side of the meshes.
    #[arg(long, value_name = "N", default_value_t = 64,
        default_value_if("quick", "true", "16"),
        value_parser = clap::value_parser!(u32).range(8..=256))]
    pub(crate) size: u32,

    /// Seeds of the ensembles of a flag; torn lengths take half of them.
    #[arg(long, value_name = "N", default_value_t = 16,
        default_value_if("quick", "true", "2"),
        value_parser = clap::value_parser!(u64).range(2..=10_000))]
    pub(crate) seeds: u64,

    /// Meshes with different diagonals, which show the error of the mesh itself.
    #[arg(long, value_name = "N", default_value_t = 8,
        default_value_if("quick", "true", "2"),
        value_parser = clap::value_parser!(u64).range(2..=1000))]
    pub(crate) diagonals: u64,

    /// Take 16 cells, two seeds and two meshes, for a look within a minute.
    #[arg(long, conflicts_with_all = ["size", "seeds", "diagonals"])]
    pub(crate) quick: bool,
}

/// The arguments of `chart pareto`.
#[derive(Debug, clap::Args)]
pub(crate) struct ParetoArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Scenes (default: all).
    #[arg(long, value_name = "NAME", value_delimiter = ',', hide_default_value = true,
        default_values_t = scene_names().map(str::to_owned),
        value_parser = clap::builder::PossibleValuesParser::new(scene_names()))]
    pub(crate) scene: Vec<String>,

    /// Kinds of meshes.
    #[arg(long, value_name = "KIND", value_delimiter = ',', default_value = "grid",
        value_parser = clap::builder::PossibleValuesParser::new(MeshKind::ALL.map(MeshKind::name)))]
    pub(crate) mesh: Vec<String>,

    /// Cells per side.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "16",
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,

    /// Stiffness of the springs in N/m (default: that of the scene).
    #[arg(long, value_name = "K", value_delimiter = ',', value_parser = stiffness)]
    pub(crate) stiffness: Vec<f64>,

    /// Factor on the mass of the middle particle, as of the slivers next to a cut (default: that of the scene).
    #[arg(long, value_name = "R", value_delimiter = ',', value_parser = ratio)]
    pub(crate) mass_ratio: Vec<f64>,

    /// Give up a run after this many edge visits.
    #[arg(long, value_name = "N", default_value_t = VISITS_MAX)]
    pub(crate) visits_max: u64,
}

fn ratio(text: &str) -> Result<f64, String> {
    within(text, 1e-6..=1.0, "a number from 1e-6 to 1")
}

fn stiffness(text: &str) -> Result<f64, String> {
    within(text, 1e-3..=1e9, "a number from 1e-3 to 1e9")
}

/// The arguments of `chart stability`.
#[derive(Debug, clap::Args)]
pub(crate) struct StabilityArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Stiffness of the springs in N/m.
    #[arg(long, value_name = "K", value_delimiter = ',', default_values_t = STIFFNESS_N_PER_M,
        value_parser = stiffness)]
    pub(crate) stiffness: Vec<f64>,
}

/// The arguments of `chart tear`.
#[derive(Debug, clap::Args)]
pub(crate) struct TearChartArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells across the strips: at least two even numbers, as the slit runs along edges.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = tear::CELLS,
        default_value_if("no_strips", "true", None), value_parser = even)]
    pub(crate) strips: Vec<u32>,

    /// Tear no strips.
    #[arg(long, conflicts_with = "strips")]
    pub(crate) no_strips: bool,

    /// Scenes that are played with many seeds.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = EnsembleScene::ALL.map(|scene| scene.name().to_owned()),
        value_parser = clap::builder::PossibleValuesParser::new(EnsembleScene::ALL.map(EnsembleScene::name)))]
    pub(crate) scene: Vec<String>,

    /// Methods that play them.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = default_names().map(str::to_owned),
        value_parser = clap::builder::PossibleValuesParser::new(default_names()))]
    pub(crate) method: Vec<String>,

    /// Seeds of an ensemble; 0 for no ensembles.
    #[arg(long, value_name = "N", default_value_t = tear::SEEDS,
        value_parser = clap::value_parser!(u64).range(0..=10_000))]
    pub(crate) seeds: u64,

    /// Cells across in those scenes (default: 16 for trouser, 32 for rip).
    #[arg(long, value_name = "N", value_delimiter = ',',
        value_parser = clap::value_parser!(u32).range(4..=256))]
    pub(crate) size: Vec<u32>,
}

fn even(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(cells) if (4..=256).contains(&cells) && cells % 2 == 0 => Ok(cells),
        _ => Err("an even number from 4 to 256".to_owned()),
    }
}

/// The arguments of `chart step`.
///
/// Tearing is chaotic. Each run moves the vertices by up to a nanometre, and stores the faces in another
/// order. The medians of first tear, torn length, pieces, forces and work are compared: same, differ, or
/// cannot tell.
#[derive(Debug, clap::Args)]
pub(crate) struct StepArgs {
    /// The OBJ file of the cloth at rest, in metres; `-` is standard input.
    #[arg(value_name = "IN", required_unless_present = "from")]
    pub(crate) input: Option<PathBuf>,

    /// hang, flag, rip, trouser, fall, or a scene file in TOML, as of `tear`.
    #[arg(long, value_name = "SCENE", required_unless_present = "from")]
    pub(crate) scene: Option<String>,

    #[command(flatten)]
    pub(crate) change: ChangeArgs,

    /// Seeds at each step.
    #[arg(long, value_name = "N", default_value_t = step::SEEDS,
        value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(crate) seeds: u64,

    #[command(flatten)]
    pub(crate) draw: DrawArgs,
}

/// The arguments of `chart cut`.
#[derive(Debug, clap::Args)]
pub(crate) struct CutChartArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells per side of the sheets that are cut.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [64, 224],
        value_parser = clap::value_parser!(u32).range(4..=1024))]
    pub(crate) size: Vec<u32>,

    /// Random lines along which each sheet is cut.
    #[arg(long, value_name = "N", default_value_t = 40,
        value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) cuts: u32,
}

/// The arguments of `chart fig7`.
#[derive(Debug, clap::Args)]
pub(crate) struct Fig7Args {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells per side of the patches that are ripped.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [8, 16, 32, 64],
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,
}
