//! The verb `chart`: every experiment is run, drawn and tabled in the same way.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Args as _, Command, CommandFactory as _};
use cpu_time::ThreadTime;
use serde::Serialize;
use tearmesh_lab::cut::Cuts;
use tearmesh_lab::experiment::{
    Bounds, Chart, Experiment, Provenance, conduct, guess_s, read_table, table, workers,
};
use tearmesh_lab::fig7::Fig7;
use tearmesh_lab::guide::Guide;
use tearmesh_lab::pareto::{self, Pareto, SCENES};
use tearmesh_lab::plot;
use tearmesh_lab::sheet::MeshKind;
use tearmesh_lab::stability::Stability;
use tearmesh_lab::tear::{EnsembleScene, Tear};

use crate::args::{Args, ChartArgs, DrawArgs, ParetoArgs, TearChartArgs, What};
use crate::exit::{Exit, Stop};
use crate::input::cannot_read;
use crate::interrupt::Guard;
use crate::output;
use crate::say::Fault;
use crate::streams::Streams;

/// Runs an experiment, writes what is wanted of it, and returns the exit status.
pub(crate) fn run(args: &ChartArgs, line: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let command = command_line(line);
    let (draw, done) = match &args.what {
        What::Guide(args) => {
            let guide = Guide::new(args.size, args.seeds, args.diagonals);
            (&args.draw, work(&guide, command, &args.draw, streams))
        }
        What::Pareto(args) => (
            &args.draw,
            work(&pareto(args), command, &args.draw, streams),
        ),
        What::Stability(args) => {
            let stiffness_n_per_m = args.stiffness.clone();
            let stability = Stability { stiffness_n_per_m };
            (&args.draw, work(&stability, command, &args.draw, streams))
        }
        What::Tear(args) => {
            let done = tear(args).and_then(|tear| work(&tear, command, &args.draw, streams));
            (&args.draw, done)
        }
        What::Cut(args) => {
            let cuts = Cuts::new(&args.size, args.cuts);
            (&args.draw, work(&cuts, command, &args.draw, streams))
        }
        What::Fig7(args) => {
            let cells = args.size.clone();
            (
                &args.draw,
                work(&Fig7 { cells }, command, &args.draw, streams),
            )
        }
    };
    done.unwrap_or_else(|stop| streams.conclude(Err(stop), Vec::new(), draw.color, true))
}

fn pareto(args: &ParetoArgs) -> Pareto {
    let is_named = |name: &str, names: &[String]| names.iter().any(|other| other == name);
    let scenes = SCENES.into_iter();
    let scenes = scenes.filter(|scene| is_named(scene.name, &args.scene));
    let meshes = MeshKind::ALL.into_iter();
    let meshes = meshes.filter(|mesh| is_named(mesh.name(), &args.mesh));
    Pareto::new(pareto::Options {
        scenes: scenes.collect(),
        meshes: meshes.collect(),
        cells: args.size.clone(),
        stiffness_n_per_m: args.stiffness.clone(),
        mass_ratios: args.mass_ratio.clone(),
        visits_max: args.visits_max,
    })
}

fn tear(args: &TearChartArgs) -> Result<Tear, Stop> {
    if args.strips.len() == 1 {
        let message = "`--strips` takes two numbers or more: forces are compared".to_owned();
        return Err(Stop::usage(message, "as in --strips 8,16"));
    }
    let is_named = |scene: &EnsembleScene| args.scene.iter().any(|name| name == scene.name());
    let scenes = EnsembleScene::ALL.into_iter().filter(is_named);
    let mut cells = args.size.clone();
    cells.sort_unstable();
    cells.dedup();
    Ok(Tear {
        strips: args.strips.clone(),
        // Ensembles without seeds have no runs.
        scenes: scenes.filter(|_| args.seeds > 0).collect(),
        cells,
        methods: args.method.clone(),
        seeds: args.seeds,
    })
}

/// The command line as it was read, with the defaults of all options that decide the numbers.
fn command_line(line: &[OsString]) -> String {
    let mut command = Args::command();
    let matches = command.try_get_matches_from_mut(line);
    let mut matches = &matches.expect("the line was read before");
    let (mut text, mut known) = ("tearmesh".to_owned(), &command);
    while let Some((verb, inner)) = matches.subcommand() {
        text += &format!(" {verb}");
        known = known.find_subcommand(verb).expect("it was read");
        matches = inner;
    }
    let draw = DrawArgs::augment_args(Command::default());
    // `--quick` stands for values that are written.
    let others = draw.get_arguments().map(|option| option.get_id().as_str());
    let others: Vec<&str> = others.chain(["quick", "help"]).collect();
    for option in known.get_arguments() {
        let id = option.get_id().as_str();
        if others.contains(&id) {
            continue;
        }
        let values = matches.get_raw(id).into_iter().flatten();
        let values: Vec<_> = values.map(OsStr::to_string_lossy).collect();
        let name = option.get_long().unwrap_or(id);
        match &*values.join(",") {
            "" | "false" => {}
            "true" => text += &format!(" --{name}"),
            values => text += &format!(" --{name} {values}"),
        }
    }
    text
}

/// Runs an experiment or reads its table, and writes chart, table and figures, as far as they are wanted.
fn work<E: Chart>(
    experiment: &E,
    command: String,
    draw: &DrawArgs,
    streams: &mut Streams<'_>,
) -> Result<Exit, Stop> {
    let files = check(draw)?;
    let mut provenance = Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("TEARMESH_COMMIT").to_owned(),
        compiler: env!("TEARMESH_COMPILER").to_owned(),
        processor: E::IS_TIMED.then(processor),
    };
    let (rows, missing) = match &draw.from {
        Some(path) => {
            let name = path.display().to_string();
            provenance.command = format!("drawn from {name}");
            provenance.processor = None;
            let text = std::fs::read_to_string(path);
            let text = text.map_err(|error| cannot_read(&name, &error))?;
            let rows = match read_table(&text) {
                Ok(rows) if rows.is_empty() => Err("it has no rows".to_owned()),
                rows => rows.map_err(|error| error.to_string()),
            };
            let refused = |why: String| {
                let message = format!("{name} is not a table of this chart: {why}");
                let help = "give one that --csv of the same chart wrote";
                Fault::error("E-CHART-TABLE", message).help(help)
            };
            (rows.map_err(refused)?, 0)
        }
        None => conducted(experiment, draw, streams)?,
    };
    let tabled = || table(&rows).map_err(|error| bug(&error.to_string()));
    if let Some(path) = &draw.output {
        let chart = plot::svg(&experiment.figure(&rows, &provenance));
        write(path, &chart, streams)?;
    }
    if let Some(path) = &draw.csv {
        write(path, &tabled()?, streams)?;
    }
    if let Some(path) = &draw.json {
        let json = serde_json::to_string_pretty(&Json {
            provenance,
            rows: &rows,
        });
        let json = json.map_err(|error| bug(&error.to_string()))?;
        write(path, &(json + "\n"), streams)?;
    }
    let is_streamed = files.first().is_some_and(|path| *path == Path::new("-"));
    if !draw.quiet && !is_streamed {
        let names = files.iter().map(|path| path.display().to_string());
        let names: Vec<_> = names.collect();
        let names = format!("wrote {}", names.join(", "));
        let summary = experiment.summary(&rows);
        let printed = output::print_text(streams.output, &format!("{}\n{names}\n", summary.trim()));
        printed.map_err(|fault| fault.help(names))?;
    }
    if missing == 0 {
        return Ok(Exit::Done);
    }
    let message = format!("interrupted; {missing} runs are missing");
    let fault = Fault::warning("W-CHART-INTERRUPTED", message);
    Ok(streams.fail(&fault, draw.color, Exit::Interrupted))
}

/// A table as JSON.
#[derive(Serialize)]
struct Json<'a, R> {
    provenance: Provenance,
    rows: &'a [R],
}

/// The rows of an experiment that ran until its end or until it was interrupted, and how many runs are missing.
fn conducted<E: Experiment>(
    experiment: &E,
    draw: &DrawArgs,
    streams: &mut Streams<'_>,
) -> Result<(Vec<E::Row>, usize), Stop> {
    let plan = experiment.plan();
    let runs: usize = plan.iter().map(Vec::len).sum();
    let threads = draw.threads.unwrap_or_else(workers);
    let about_s = guess_s(experiment, &plan) / experiment.threads(threads).get() as f64;
    if !draw.quiet {
        let about = match about_s {
            s if s < 90.0 => format!("{} s", s.ceil().max(1.0)),
            s => format!("{} min", (s / 60.0).ceil()),
        };
        let begun = format!("{runs} runs, about {about} (Ctrl-C stops and keeps finished runs)");
        // Nowhere is left to say it if standard error is closed.
        let _ = writeln!(streams.error, "{begun}");
    }
    let bar = streams.bar(BAR as u64, "{wide_bar} {percent} % {eta}", !draw.quiet);
    let guard = Guard::new();
    let bounds = Bounds {
        clock: E::IS_TIMED.then_some(&|| ThreadTime::now().as_duration()),
        stop: &|| guard.is_interrupted(),
    };
    let (rows, done) = conduct(experiment, threads, &bounds, |fraction| {
        bar.set_position((BAR * fraction) as u64);
    });
    bar.finish_and_clear();
    let missing = runs - done;
    if done == 0 && missing > 0 {
        let message = "interrupted before any run was done; nothing written";
        let fault = Fault::warning("W-CHART-INTERRUPTED", message);
        return Err(Stop::new(Exit::Interrupted, fault));
    }
    Ok((rows, missing))
}

/// The length of a progress bar.
const BAR: f64 = 1000.0;

/// The name of the processor if the system has one, or else its architecture.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = text.lines().filter(|line| line.starts_with("model name"));
    let named = lines.next().and_then(|line| line.split_once(':'));
    let named = named.map_or(std::env::consts::ARCH, |(_, name)| name.trim());
    named.to_owned()
}

/// The files that are wanted. All must be places of their own that can be written, and only the chart may be
/// standard output.
fn check(draw: &DrawArgs) -> Result<Vec<&PathBuf>, Stop> {
    let files = [draw.output.as_ref(), draw.csv.as_ref(), draw.json.as_ref()];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    let is_stream = |path: &PathBuf| path == Path::new("-");
    for (i, path) in files.iter().enumerate() {
        let is_it = |other: &&PathBuf| other == path || output::is_same_place(other, path);
        let is_chart = i == 0 && draw.output.is_some();
        if files[..i].iter().any(is_it) || (is_stream(path) && !is_chart) {
            let message = format!("`{}` is named twice, or is not a file", path.display());
            return Err(Stop::usage(message, "name a file for each"));
        }
    }
    let mut named = files.iter().filter(|path| !is_stream(path));
    named.try_for_each(|path| output::check(path))?;
    Ok(files)
}

fn write(path: &Path, text: &str, streams: &mut Streams<'_>) -> Result<(), Fault> {
    output::write_or_print(path, streams.output, |out| out.write_all(text.as_bytes())).map(|_| ())
}

fn bug(message: &str) -> Fault {
    Fault::error("E-BUG-INVARIANT", message)
}
