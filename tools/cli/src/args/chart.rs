//! What `chart` takes.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};
use tearmesh_lab::fig7;
use tearmesh_lab::pareto::{MeshKind, SCENES};
use tearmesh_lab::stability::STIFFNESS_N_PER_M;

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
    /// The force that tears strips of five meshes, by stretch ratio and by toughness.
    Tear(DrawArgs),
    /// The work of all methods against their precision.
    Pareto(ParetoArgs),
    /// Where methods fail, by theory and as measured, and what one is told of it.
    Stability(StabilityArgs),
    /// The time that it takes to split vertices while a cloth is ripped, by ghost pairs and without
    /// (figure 7 of the paper).
    Fig7(Fig7Args),
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

/// What `chart pareto` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct ParetoArgs {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

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

/// What `chart fig7` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Fig7Args {
    #[command(flatten)]
    pub(crate) draw: DrawArgs,

    /// Cells a side of the patches that are ripped.
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
