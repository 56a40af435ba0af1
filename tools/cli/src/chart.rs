//! The verb `chart`: every experiment is run, drawn and tabled in the same way.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use cpu_time::ThreadTime;
use serde::Serialize;
use tearmesh_lab::cut::Cuts;
use tearmesh_lab::experiment::{
    Bounds, Chart, Experiment, Provenance, conduct, guess_s, read_table, table, workers,
};
use tearmesh_lab::fig7::Fig7;
use tearmesh_lab::guide::{self, Guide};
use tearmesh_lab::pareto::{self, Pareto, SCENES};
use tearmesh_lab::plot;
use tearmesh_lab::sheet::MeshKind;
use tearmesh_lab::stability::Stability;
use tearmesh_lab::tear::{EnsembleScene, Tear};

use crate::args::{ChartArgs, DrawArgs, GuideArgs, ParetoArgs, TearChartArgs, What};
use crate::exit::{Exit, Stop};
use crate::files::{unwritable, write_beside};
use crate::input::cannot_read;
use crate::interrupt::Guard;
use crate::output;
use crate::say::Fault;
use crate::streams::Streams;

/// Runs an experiment, writes what is wanted of it, and returns the exit status.
pub(crate) fn run(args: &ChartArgs, streams: &mut Streams<'_>) -> Exit {
    let (draw, done) = match &args.what {
        What::Guide(args) => (&args.draw, work(&guide(args), &args.draw, streams)),
        What::Pareto(args) => (&args.draw, work(&pareto(args), &args.draw, streams)),
        What::Stability(args) => {
            let stability = Stability {
                stiffness_n_per_m: args.stiffness.clone(),
                threads: threads(&args.draw),
            };
            (&args.draw, work(&stability, &args.draw, streams))
        }
        What::Tear(args) => {
            let done = tear(args).and_then(|tear| work(&tear, &args.draw, streams));
            (&args.draw, done)
        }
        What::Cut(args) => {
            let cuts = Cuts::new(args.size.clone(), args.cuts);
            (&args.draw, work(&cuts, &args.draw, streams))
        }
        What::Fig7(args) => {
            let cells = args.size.clone();
            (&args.draw, work(&Fig7 { cells }, &args.draw, streams))
        }
    };
    done.unwrap_or_else(|stop| streams.conclude(Err(stop), Vec::new(), draw.color, true))
}

fn threads(draw: &DrawArgs) -> NonZero<usize> {
    draw.threads.unwrap_or_else(workers)
}

fn guide(args: &GuideArgs) -> Guide {
    let threads = threads(&args.draw);
    Guide::new(match args.quick {
        true => guide::Options {
            cells: 16,
            seeds: 2,
            diagonals: 2,
            threads,
        },
        false => guide::Options {
            cells: args.size,
            seeds: args.seeds,
            diagonals: args.diagonals,
            threads,
        },
    })
}

fn pareto(args: &ParetoArgs) -> Pareto {
    let is_named = |name: &str, names: &[String]| names.iter().any(|other| other == name);
    let scenes = SCENES.into_iter();
    let scenes = scenes.filter(|one| args.scene.is_empty() || is_named(one.name, &args.scene));
    let meshes = MeshKind::ALL.into_iter();
    Pareto::new(pareto::Options {
        scenes: scenes.collect(),
        meshes: meshes
            .filter(|mesh| is_named(mesh.name(), &args.mesh))
            .collect(),
        cells: args.size.clone(),
        stiffness_n_per_m: args.stiffness.clone(),
        mass_ratios: args.mass_ratio.clone(),
        threads: threads(&args.draw),
        visits_max: args.visits_max,
        repeats: args.time.then_some(args.repeats),
    })
}

fn tear(args: &TearChartArgs) -> Result<Tear, Stop> {
    let strips = if args.no_strips {
        &[][..]
    } else {
        &args.strips
    };
    if strips.len() == 1 {
        let message = "`--strips` takes two numbers or more: forces are compared".to_owned();
        return Err(Stop::usage(message, "as in --strips 8,16"));
    }
    let is_named = |scene: &EnsembleScene| args.scene.iter().any(|name| name == scene.name());
    let scenes = EnsembleScene::ALL.into_iter().filter(is_named);
    let mut cells = args.size.clone();
    cells.sort_unstable();
    cells.dedup();
    Ok(Tear {
        strips: strips.to_vec(),
        // Ensembles without seeds have no runs.
        scenes: scenes.filter(|_| args.seeds > 0).collect(),
        cells,
        methods: args.method.clone(),
        seeds: args.seeds,
        threads: threads(&args.draw),
    })
}

/// The text of a file.
fn read(path: &Path) -> Result<String, Stop> {
    let text = std::fs::read_to_string(path);
    text.map_err(|error| {
        Stop::new(
            Exit::Input,
            cannot_read(&path.display().to_string(), &error),
        )
    })
}

/// Runs an experiment or reads its table, and writes chart, table and figures, as far as they are wanted.
fn work<E: Chart>(
    experiment: &E,
    draw: &DrawArgs,
    streams: &mut Streams<'_>,
) -> Result<Exit, Stop> {
    let files = check(draw)?;
    let mut provenance = provenance(experiment);
    let (rows, missing) = match &draw.from {
        Some(path) => {
            provenance.command = format!("drawn from {}", path.display());
            provenance.processor = None;
            let refused = |why: &str| {
                let message = format!("{} is not a table of this chart: {why}", path.display());
                let help = "give one that --csv of the same chart wrote";
                let fault = Fault::error("E-CHART-TABLE", message).help(help);
                Stop::new(Exit::Input, fault)
            };
            let rows = read_table(&read(path)?).map_err(|error| refused(&error.to_string()))?;
            if rows.is_empty() {
                return Err(refused("it has no rows"));
            }
            (rows, 0)
        }
        None => conducted(experiment, draw, streams)?,
    };
    let tabled = || table(&rows).map_err(|error| bug(&error.to_string()));
    if let Some(path) = &draw.output {
        write(
            path,
            &plot::svg(&experiment.figure(&rows, &provenance)),
            streams,
        )?;
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
    print_summary(
        experiment.summary(&rows).trim(),
        &files,
        draw.quiet,
        streams,
    )?;
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
    let about_s = guess_s(experiment, &plan) / experiment.threads().get() as f64;
    if !draw.quiet {
        // Nowhere is left to say it if standard error is closed.
        let about = some_time(about_s);
        let _ = writeln!(
            streams.error,
            "{runs} runs, about {about} (Ctrl-C stops and keeps finished runs)"
        );
    }
    let bar = streams.bar(BAR as u64, "{wide_bar} {percent} % {eta}", !draw.quiet);
    let guard = Guard::new();
    let bounds = Bounds {
        clock: experiment
            .is_timed()
            .then_some(&|| ThreadTime::now().as_duration()),
        stop: &|| guard.is_interrupted(),
    };
    let conducted = conduct(experiment, &bounds, |fraction| {
        bar.set_position((BAR * fraction) as u64);
    });
    bar.finish_and_clear();
    let missing = conducted.planned - conducted.done;
    if conducted.done == 0 && missing > 0 {
        let message = "interrupted before any run was done; nothing written".to_owned();
        let fault = Fault::warning("W-CHART-INTERRUPTED", message);
        return Err(Stop::new(Exit::Interrupted, fault));
    }
    Ok((conducted.rows, missing))
}

/// The length of a progress bar.
const BAR: f64 = 1000.0;

/// A duration in words, rounded up.
fn some_time(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{} s", s.ceil().max(1.0)),
        s => format!("{} min", (s / 60.0).ceil()),
    }
}

fn provenance<E: Experiment>(experiment: &E) -> Provenance {
    Provenance {
        command: experiment.command(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("TEARMESH_COMMIT").to_owned(),
        compiler: env!("TEARMESH_COMPILER").to_owned(),
        processor: experiment.is_timed().then(processor),
    }
}

/// The name of the processor if the system has one, or else its architecture.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = text.lines().filter(|line| line.starts_with("model name"));
    let named = lines.next().and_then(|line| line.split_once(':'));
    named.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| {
        name.trim().to_owned()
    })
}

/// The files that are wanted. All must be places of their own that can be written, and only the chart may be
/// standard output.
fn check(draw: &DrawArgs) -> Result<Vec<&PathBuf>, Stop> {
    let files = [draw.output.as_ref(), draw.csv.as_ref(), draw.json.as_ref()];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    let is_output = |path: &PathBuf| path == Path::new("-") && draw.output.as_ref() == Some(path);
    for (i, path) in files.iter().enumerate() {
        let is_it = |other: &&PathBuf| other == path || output::is_same_place(other, path);
        let is_twice = files[..i].iter().any(is_it);
        if is_twice || (*path == Path::new("-") && !(i == 0 && is_output(path))) {
            let message = format!("`{}` is named twice, or is not a file", path.display());
            return Err(Stop::usage(message, "name a file for each"));
        }
    }
    for path in files.iter().filter(|path| **path != Path::new("-")) {
        output::check(path).map_err(|error| unwritable(path, &error))?;
    }
    Ok(files)
}

fn write(path: &Path, text: &str, streams: &mut Streams<'_>) -> Result<(), Stop> {
    if path == Path::new("-") {
        let printed = output::print(streams.output, |out| out.write_all(text.as_bytes()));
        return printed
            .map(|_| ())
            .map_err(|fault| Stop::new(Exit::Output, fault));
    }
    write_beside(path, |out| out.write_all(text.as_bytes()))
}

/// Prints a summary and the names of the files, unless the chart is on standard output.
fn print_summary(
    summary: &str,
    files: &[&PathBuf],
    is_quiet: bool,
    streams: &mut Streams<'_>,
) -> Result<(), Stop> {
    if is_quiet || files.first().is_some_and(|path| *path == Path::new("-")) {
        return Ok(());
    }
    let names: Vec<_> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let names = names.join(", ");
    let printed = output::print(streams.output, |out| {
        writeln!(out, "{summary}\nwrote {names}")
    });
    let printed =
        printed.map_err(|fault| Stop::new(Exit::Output, fault.help(format!("wrote {names}"))));
    printed.map(|_| ())
}

fn bug(message: &str) -> Stop {
    let fault = Fault::error("E-BUG-INVARIANT", message.to_owned());
    Stop::new(Exit::Bug, fault)
}
