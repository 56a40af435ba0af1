//! The arguments of all verbs that change a mesh.

use std::path::PathBuf;

use clap::ValueEnum;

use crate::say::Color;

/// Where a verb reads and writes, and how it says what it did.
#[derive(Debug, clap::Args)]
pub(crate) struct FileArgs {
    /// The OBJ file to read; `-` is standard input.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,

    /// Where to write the mesh; `-` is standard output.
    ///
    /// Without it, the mesh goes to standard output if that is a pipe or a file. Only OBJ is written:
    /// names of other formats are refused.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,

    /// Allow the output to replace the input; without -o, replace it.
    #[arg(long)]
    pub(crate) in_place: bool,

    /// Do everything, but write no file except reports.
    #[arg(long)]
    pub(crate) dry_run: bool,

    /// Print a summary, or the report as JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: Format,

    /// Write the JSON report to a file as well.
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,

    /// Draw a picture of the resulting mesh, as PNG.
    ///
    /// The whole mesh, from its broad side: pieces in colours, torn edges red. `tearmesh render` draws
    /// other views.
    #[arg(long, value_name = "F.png")]
    pub(crate) picture: Option<PathBuf>,

    /// Write a page for a browser that shows the mesh, as HTML.
    ///
    /// One file that needs no network: turn the mesh, and click two points to plan a cut. The page of
    /// `tear` plays the simulation. `tearmesh view` makes pages of other files.
    #[arg(long, value_name = "F.html")]
    pub(crate) view: Option<PathBuf>,

    /// Leave times out of the report, so that it is the same on every run.
    #[arg(long, hide_short_help = true)]
    pub(crate) no_timing: bool,

    /// When to use colours.
    #[arg(long, value_enum, default_value_t, hide_short_help = true)]
    pub(crate) color: Color,

    /// Print no summary.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Show all diagnostics, also minor notes.
    ///
    /// Without it, at most three diagnostics of each kind are shown.
    /// `tear` also prints the cost of the simulation, in element visits.
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

impl FileArgs {
    /// The place of a file other than the mesh, unless the run is dry.
    pub(crate) fn wanted<'p>(&self, path: &'p Option<PathBuf>) -> Option<&'p PathBuf> {
        path.as_ref().filter(|_| !self.dry_run)
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    Json,
}
