//! What `chart` takes.

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};
use tearmesh_lab::pareto::{METHODS as SERIES, MeshKind, PARTS, SCENES};
use tearmesh_lab::space::{self, SpaceScene};
use tearmesh_lab::stability::STIFFNESS_N_PER_M;
use tearmesh_lab::tear::cascade::{CascadeScene, METHODS, SEEDS};
use tearmesh_lab::{choice, fig7, plane, tear};

use crate::say::Color;

const EXAMPLES: &str = "\
Examples:
  tearmesh chart tear -o tear.svg
      the force that tears strips of five meshes, by stretch ratio and by toughness
  tearmesh chart pareto --scene swing,hang --size 8 -o p.svg --csv p.csv
      what each method costs and how far it is off, in two scenes on a small mesh";

/// Make an experiment, and draw its chart.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES, disable_help_subcommand = true)]
pub(crate) struct ChartArgs {
    #[command(subcommand)]
    pub(crate) what: What,
}

/// An experiment.
#[derive(Debug, Subcommand)]
pub(crate) enum What {
    /// The force that tears strips of five meshes, by stretch ratio and by toughness; and what comes of
    /// cascades by every method, with many seeds.
    Tear(TearChartArgs),
    /// The work of all methods against their precision.
    Pareto(ParetoArgs),
    /// The cheapest method at a fixed error, by the stiffness of springs and the mass of one particle; and
    /// from which stiffness on XPBD is cheaper than Verlet's method.
    Plane(PlaneArgs),
    /// Where methods fail, by theory and as measured, and what one is told of it.
    Stability(StabilityArgs),
    /// Whether a finer mesh or a shorter step is the better buy, by errors against a mesh that is finer still.
    Space(SpaceArgs),
    /// What choosing a method by scene could save, over scenes drawn at random.
    Choice(ChoiceArgs),
    /// The time of cuts by every method and several snaps, against how far their seams are off.
    Cut(CutChartArgs),
    /// The time that it takes to split vertices while a cloth is ripped, by ghost pairs and without
    /// (figure 7 of the paper).
    Fig7(Fig7Args),
    /// All of these with their defaults, each as chart, table and figures, into one folder.
    All(AllArgs),
}

/// What all charts take.
#[derive(Debug, clap::Args)]
pub(crate) struct DrawArgs {
    /// Where to write the chart, as SVG; `-` is standard output.
    #[arg(short, long, value_name = "X.svg")]
    pub(crate) output: PathBuf,

    /// Write the figures as a table.
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,

    /// Write the figures as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,

    /// When to use colours on the screen.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// What charts take that can be made in parts.
#[derive(Debug, clap::Args)]
pub(crate) struct PartsArgs {
    /// Make the folder X.parts alone, and print the commands that make the chart in parts, one a line, as for
    /// GNU parallel.
    #[arg(long, conflicts_with = "gather")]
    pub(crate) plan: bool,

    /// Draw what the commands of --plan have left in this folder, and name what is missing.
    #[arg(long, value_name = "X.parts")]
    pub(crate) gather: Option<PathBuf>,
}

/// What `chart pareto` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct ParetoArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    #[command(flatten)]
    pub(crate) parts: PartsArgs,

    /// The scenes (default: all).
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        value_parser = clap::builder::PossibleValuesParser::new(SCENES.map(|scene| scene.name)))]
    pub(crate) scene: Vec<String>,

    /// How sheets are meshed.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "grid")]
    pub(crate) mesh: Vec<ChartMesh>,

    /// Cells per side.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "16",
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,

    /// How many runs are made at a time (default: one per processor).
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// The visits of edges after which a run is given up.
    #[arg(long, value_name = "N")]
    pub(crate) visits_max: Option<u64>,

    /// Take times, and write a second chart by CPU time.
    #[arg(long, value_name = "T.svg")]
    pub(crate) time_chart: Option<PathBuf>,

    /// How often each run is repeated alone to be timed; 0 takes the time of the parallel run.
    #[arg(long, value_name = "N", default_value = "5", requires = "time_chart")]
    pub(crate) repeats: u32,
}

/// What `chart plane` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct PlaneArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    #[command(flatten)]
    pub(crate) parts: PartsArgs,

    /// The stiffness of springs, in N/m.
    #[arg(long, value_name = "K", value_delimiter = ',',
        default_values_t = plane::STIFFNESS_N_PER_M, value_parser = stiffness)]
    pub(crate) stiffness: Vec<f64>,

    /// The factor by which the mass of the middle particle is multiplied, as next to cuts.
    #[arg(long, value_name = "R", value_delimiter = ',',
        default_values_t = plane::MASS_RATIOS, value_parser = ratio)]
    pub(crate) ratio: Vec<f64>,

    /// The methods with their settings.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = plane::SERIES.map(str::to_owned),
        value_parser = clap::builder::PossibleValuesParser::new(SERIES.map(|method| method.name)))]
    pub(crate) method: Vec<String>,

    /// Cells per side.
    #[arg(long, value_name = "N", default_value_t = plane::CELLS,
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: u32,

    /// Give up runs that cost N times as much as Verlet's method with its base step.
    #[arg(long, value_name = "N", default_value_t = plane::COST_MAX, value_parser = multiple)]
    pub(crate) cost_max: f64,

    /// How many runs are made at a time (default: one per processor).
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

fn ratio(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(ratio) if (1e-6..=1.0).contains(&ratio) => Ok(ratio),
        _ => Err("a number from 1e-6 to 1".to_owned()),
    }
}

fn multiple(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(multiple) if (1.0..=1e6).contains(&multiple) => Ok(multiple),
        _ => Err("a number from 1 to 1e6".to_owned()),
    }
}

/// What `chart tear` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct TearChartArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    #[command(flatten)]
    pub(crate) parts: PartsArgs,

    /// Write each run of the ensembles as a table.
    #[arg(long, value_name = "FILE")]
    pub(crate) runs: Option<PathBuf>,

    /// Cells across the strips: two even numbers or more, as the slit runs along edges.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = tear::CELLS,
        value_parser = even)]
    pub(crate) strips: Vec<u32>,

    /// Tear no strips.
    #[arg(long, conflicts_with = "strips")]
    pub(crate) no_strips: bool,

    /// The scenes that are played with many seeds.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = CascadeScene::ALL.map(|scene| scene.name().to_owned()),
        value_parser = clap::builder::PossibleValuesParser::new(CascadeScene::ALL.map(|scene| scene.name())))]
    pub(crate) scene: Vec<String>,

    /// The methods that play them.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = METHODS.map(str::to_owned),
        value_parser = clap::builder::PossibleValuesParser::new(METHODS))]
    pub(crate) method: Vec<String>,

    /// Seeds of an ensemble; with 0 nothing is played.
    #[arg(long, value_name = "N", default_value_t = SEEDS,
        value_parser = clap::value_parser!(u64).range(0..=10_000))]
    pub(crate) seeds: u64,

    /// Cells across, of each scene its own unless said. With several it is told whether a finer mesh or a
    /// shorter step is the better buy.
    #[arg(long, value_name = "N", value_delimiter = ',',
        value_parser = clap::value_parser!(u32).range(4..=256))]
    pub(crate) size: Vec<u32>,

    /// How many runs go on at a time; as many as there are processors unless said.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

fn even(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(cells) if (4..=256).contains(&cells) && cells % 2 == 0 => Ok(cells),
        _ => Err("an even number from 4 to 256".to_owned()),
    }
}

/// What `chart stability` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct StabilityArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// The stiffness of springs whose limits are looked for, in N/m.
    #[arg(long, value_name = "K", value_delimiter = ',', default_values_t = STIFFNESS_N_PER_M,
        value_parser = stiffness)]
    pub(crate) stiffness: Vec<f64>,

    /// How many runs go on at a time; as many as there are processors unless said.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

fn stiffness(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(k) if (1e-3..=1e9).contains(&k) => Ok(k),
        _ => Err("a number from 1e-3 to 1e9".to_owned()),
    }
}

/// What `chart space` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct SpaceArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    #[command(flatten)]
    pub(crate) parts: PartsArgs,

    /// The scenes.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = SpaceScene::ALL.map(|scene| scene.name().to_owned()),
        value_parser = clap::builder::PossibleValuesParser::new(SpaceScene::ALL.map(|scene| scene.name())))]
    pub(crate) scene: Vec<String>,

    /// Cells per side of the meshes that are compared: multiples of the smallest, so that they share
    /// vertices.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = space::CELLS,
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,

    /// Cells per side of the mesh with which they are compared: finer than all, best by two halvings.
    #[arg(long, value_name = "N", default_value_t = space::FINEST,
        value_parser = clap::value_parser!(u32).range(2..=512))]
    pub(crate) finest: u32,

    /// The methods with their settings.
    #[arg(long, value_name = "NAME", value_delimiter = ',',
        default_values_t = space::SERIES.map(str::to_owned),
        value_parser = clap::builder::PossibleValuesParser::new(SERIES.map(|method| method.name)))]
    pub(crate) method: Vec<String>,

    /// The steps, as parts of each method's base step; one must be half of another.
    #[arg(long, value_name = "PART", value_delimiter = ',', default_values_t = space::STEPS,
        value_parser = part)]
    pub(crate) part: Vec<f64>,

    /// How many runs go on at a time; as many as there are processors unless said.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// The visits of edges after which a run is given up.
    #[arg(long, value_name = "N")]
    pub(crate) visits_max: Option<u64>,
}

fn part(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(part) if PARTS.contains(&part) => Ok(part),
        _ => Err(format!(
            "one of {}",
            PARTS.map(|part| part.to_string()).join(", ")
        )),
    }
}

/// What `chart choice` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct ChoiceArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    #[command(flatten)]
    pub(crate) parts: PartsArgs,

    /// The seed that scenes are drawn from.
    #[arg(long, value_name = "N", default_value_t = choice::SEED)]
    pub(crate) seed: u64,

    /// The scenes to make, by their numbers.
    #[arg(long, value_name = "FIRST-LAST", default_value = "1-60", value_parser = numbers)]
    pub(crate) scenes: RangeInclusive<u32>,

    /// The time that each scene takes, in seconds.
    #[arg(long, value_name = "S", default_value_t = choice::SECONDS, value_parser = seconds)]
    pub(crate) seconds: f64,

    /// How many scenes are made at a time; as many as there are processors unless said.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

fn numbers(text: &str) -> Result<RangeInclusive<u32>, String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) if 1 <= first && first <= last && last <= 10_000 => Ok(first..=last),
        _ => Err("a number from 1 to 10000, or two of them as in 1-20".to_owned()),
    }
}

/// Reactions are means over 1/60 s, which a scene has to last.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(s) if (0.02..=10.0).contains(&s) => Ok(s),
        _ => Err("a number from 0.02 to 10".to_owned()),
    }
}

/// What `chart cut` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct CutChartArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells a side of the sheets that are cut.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [64, 224],
        value_parser = clap::value_parser!(u32).range(4..=1024))]
    pub(crate) size: Vec<u32>,

    /// Lines at random that each is cut along.
    #[arg(long, value_name = "N", default_value = "40",
        value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) cuts: u32,

    /// Draw what a record of `tearmesh-bench cut` has beside them: tools/bench/record/*/cut.txt.
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
}

/// What `chart all` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct AllArgs {
    /// The folder for `NAME.svg`, `NAME.csv` and `NAME.json` of each chart, and for `pareto-time.svg`; made
    /// where there is none.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Make folders alone, and print the commands that make the charts, one a line, as for GNU parallel: of
    /// those that can be made in parts, the parts.
    #[arg(long, conflicts_with = "gather")]
    pub(crate) plan: bool,

    /// Draw what the commands of --plan have left in the folder, and name what is missing.
    #[arg(long)]
    pub(crate) gather: bool,

    /// Small meshes and few seeds, for a look in half a minute.
    #[arg(long)]
    pub(crate) small: bool,

    /// When to use colours on the screen.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) color: Color,

    /// Print no summaries.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// What `chart fig7` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Fig7Args {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells per side of the patches that are ripped.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = fig7::CELLS,
        value_parser = clap::value_parser!(u32).range(2..=256))]
    pub(crate) size: Vec<u32>,
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
