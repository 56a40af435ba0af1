//! The verb `chart`: every experiment is run, drawn and tabled in the same way.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Args as _, Command, CommandFactory as _};
use cpu_time::ThreadTime;
use tearmesh_cloth::scene::{Frame, Run};
use tearmesh_lab::cut::Cuts;
use tearmesh_lab::experiment::{Bounds, Chart, Provenance, processor, workers};
use tearmesh_lab::fig7::Fig7;
use tearmesh_lab::guide::Guide;
use tearmesh_lab::pareto::{self, Pareto};
use tearmesh_lab::sheet::MeshKind;
use tearmesh_lab::stability::Stability;
use tearmesh_lab::step::{Step, Subject};
use tearmesh_lab::tear::{EnsembleScene, Tear};

use crate::args::{
    Args, ChangeArgs, ChartArgs, DrawArgs, ParetoArgs, StepArgs, TearChartArgs, What,
};
use crate::exit::{Exit, Stop};
use crate::files::is_same;
use crate::input::{Input, cannot_read};
use crate::interrupt::Guard;
use crate::say::{Fault, shown};
use crate::scene::SceneSource;
use crate::session::{self, Opened};
use crate::streams::Streams;
use crate::{output, simulation, weld};

/// Runs an experiment, writes what is wanted of it, and returns the exit status.
pub(crate) fn run(args: &ChartArgs, line: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let command = command_line(line);
    match &args.what {
        What::Guide(args) => {
            let guide = Guide::new(args.size, args.seeds, args.diagonals);
            draw(&guide, command, &args.draw, streams)
        }
        What::Pareto(args) => draw(&pareto(args), command, &args.draw, streams),
        What::Stability(args) => {
            let stiffness_n_per_m = args.stiffness.clone();
            draw(
                &Stability { stiffness_n_per_m },
                command,
                &args.draw,
                streams,
            )
        }
        What::Tear(args) if args.strips.len() == 1 => {
            let message = "`--strips` takes two numbers or more: forces are compared";
            let stop = Stop::usage(message, "as in --strips 8,16");
            streams.conclude(Err(stop), Vec::new(), args.draw.color, true)
        }
        What::Tear(args) => draw(&tear(args), command, &args.draw, streams),
        What::Step(args) => {
            let mut faults = Vec::new();
            let done = step(args, command, &mut faults, streams);
            done.unwrap_or_else(|stop| streams.conclude(Err(stop), faults, args.draw.color, true))
        }
        What::Cut(args) => {
            let cuts = Cuts::new(&args.size, args.cuts);
            draw(&cuts, command, &args.draw, streams)
        }
        What::Fig7(args) => {
            let cells = args.size.clone();
            draw(&Fig7 { cells }, command, &args.draw, streams)
        }
    }
}

/// Does what is wanted of an experiment, says what went wrong, and returns the exit status.
fn draw(chart: &dyn Chart, command: String, args: &DrawArgs, streams: &mut Streams<'_>) -> Exit {
    let done = work(chart, command, args, streams);
    done.unwrap_or_else(|stop| streams.conclude(Err(stop), Vec::new(), args.color, true))
}

/// Plays the scene of a file, unless a table is drawn.
fn step(
    args: &StepArgs,
    command: String,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<Exit, Stop> {
    let seeds = args.seeds;
    let (Some(input), Some(scene), None) = (&args.input, &args.scene, &args.draw.from) else {
        let drawn = Step {
            subject: None,
            step_s: 0.0,
            seeds,
        };
        return work(&drawn, command, &args.draw, streams);
    };
    let (opened, frame, run) = begun(input, scene, &args.change, faults, streams)?;
    streams.show(&std::mem::take(faults), args.draw.color, false);
    let subject = Subject {
        mesh: &opened.mesh,
        positions: &opened.positions,
        frame: &frame,
        scene: run.scene(),
    };
    let played = Step {
        subject: Some(subject),
        step_s: run.step_s(),
        seeds,
    };
    work(&played, command, &args.draw, streams)
}

/// The cloth of a file, and the scene that is about to be played with it.
fn begun(
    input: &Path,
    scene: &str,
    change: &ChangeArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<(Opened, Frame, Run), Stop> {
    let source = SceneSource::find(scene, streams)?;
    let cuts = simulation::typed_cuts(change, faults)?;
    let input = Input::find(input, streams.input)?;
    let mut opened = session::open(&input, None, "or add", faults)?;
    weld::seams(&mut opened, change.weld, &mut Vec::new(), faults)?;
    let up = change.up.unwrap_or_else(|| source.up());
    let frame = Frame::new(&opened.mesh, opened.positions.as_slice(), up);
    let scene = simulation::scene(change, cuts, &source, &frame)?;
    let run = simulation::begin(scene, &opened, &frame, &source)?;
    Ok((opened, frame, run))
}

fn pareto(args: &ParetoArgs) -> Pareto {
    let is_named = |mesh: &MeshKind| args.mesh.iter().any(|name| name == mesh.name());
    let meshes = MeshKind::ALL.into_iter();
    Pareto::new(pareto::Options {
        scenes: args.scene.clone(),
        meshes: meshes.filter(is_named).collect(),
        cells: args.size.clone(),
        stiffness_n_per_m: args.stiffness.clone(),
        mass_ratios: args.mass_ratio.clone(),
        visits_max: args.visits_max,
    })
}

fn tear(args: &TearChartArgs) -> Tear {
    let is_named = |scene: &EnsembleScene| args.scene.iter().any(|name| name == scene.name());
    let scenes = EnsembleScene::ALL.into_iter().filter(is_named);
    let mut cells = args.size.clone();
    cells.sort_unstable();
    cells.dedup();
    Tear {
        strips: args.strips.clone(),
        // Ensembles without seeds have no runs.
        scenes: scenes.filter(|_| args.seeds > 0).collect(),
        cells,
        methods: args.method.clone(),
        seeds: args.seeds,
    }
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
            value if option.is_positional() => text += &format!(" {value}"),
            "true" => text += &format!(" --{name}"),
            values => text += &format!(" --{name} {values}"),
        }
    }
    text
}

/// Runs an experiment or reads its table, and writes chart, table and figures, as far as they are wanted.
fn work(
    chart: &dyn Chart,
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
        processor: chart.is_timed().then(processor),
    };
    let (drawing, missing) = match &draw.from {
        Some(path) => {
            let name = path.display().to_string();
            provenance.command = format!("drawn from {name}");
            provenance.processor = None;
            let text = std::fs::read_to_string(path);
            let text = text.map_err(|error| cannot_read(&name, &error))?;
            let drawing = match chart.draw(&text, &provenance) {
                Ok(drawing) if drawing.table.is_empty() => Err("it has no rows".to_owned()),
                drawing => drawing.map_err(|error| error.to_string()),
            };
            let refused = |why: String| {
                let message = format!("{name} is not a table of this chart: {why}");
                let help = "give one that --csv of the same chart wrote";
                Fault::error("E-CHART-TABLE", message).help(help)
            };
            (drawing.map_err(refused)?, 0)
        }
        None => {
            let (table, missing) = conducted(chart, draw, streams)?;
            let drawing = chart.draw(&table, &provenance);
            (drawing.expect("a table of its own"), missing)
        }
    };
    if let Some(path) = &draw.output {
        write(path, &drawing.svg, streams)?;
    }
    if let Some(path) = &draw.csv {
        write(path, &drawing.table, streams)?;
    }
    let is_streamed = files.first().is_some_and(|path| *path == Path::new("-"));
    if !draw.quiet && !is_streamed {
        let names = files.iter().map(|path| shown(path));
        let names: Vec<_> = names.collect();
        let names = format!("wrote {}", names.join(", "));
        let text = format!("{}\n{names}\n", drawing.summary.trim());
        let printed = output::print_text(streams.output, &text);
        printed.map_err(|fault| fault.help(names))?;
    }
    if missing == 0 {
        return Ok(Exit::Done);
    }
    let message = format!("interrupted; {missing} runs are missing");
    let fault = Fault::warning("W-CHART-INTERRUPTED", message);
    Ok(streams.fail(&fault, draw.color, Exit::Interrupted))
}

/// The table of an experiment that ran until its end or until it was interrupted, and how many runs are missing.
fn conducted(
    chart: &dyn Chart,
    draw: &DrawArgs,
    streams: &mut Streams<'_>,
) -> Result<(String, usize), Stop> {
    let runs = chart.runs();
    let threads = draw.threads.unwrap_or_else(workers);
    let about_s = chart.guess_s(threads);
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
        clock: chart
            .is_timed()
            .then_some(&|| ThreadTime::now().as_duration()),
        stop: &|| guard.is_interrupted(),
    };
    let (table, done) = chart.run(threads, &bounds, &mut |fraction| {
        bar.set_position((BAR * fraction) as u64);
    });
    bar.finish_and_clear();
    let missing = runs - done;
    if done == 0 && missing > 0 {
        let message = "interrupted before any run was done; nothing written";
        let fault = Fault::warning("W-CHART-INTERRUPTED", message);
        return Err(Stop::new(Exit::Interrupted, fault));
    }
    Ok((table, missing))
}

/// The length of a progress bar.
const BAR: f64 = 1000.0;

/// The files that are wanted. Both must be places of their own that can be written, and only the chart may be
/// standard output.
fn check(draw: &DrawArgs) -> Result<Vec<&PathBuf>, Stop> {
    let is_stream = |path: &Path| path == Path::new("-");
    if let Some(table) = &draw.csv {
        let mut chart = draw.output.iter();
        if is_stream(table) || chart.any(|chart| is_same(chart, table)) {
            let message = format!("`{}` is named twice, or is not a file", table.display());
            return Err(Stop::usage(message, "name a file for each"));
        }
    }
    let files: Vec<&PathBuf> = draw.output.iter().chain(&draw.csv).collect();
    let mut named = files.iter().filter(|path| !is_stream(path));
    named.try_for_each(|path| output::check(path))?;
    Ok(files)
}

fn write(path: &Path, text: &str, streams: &mut Streams<'_>) -> Result<(), Fault> {
    output::write_or_print(path, streams.output, |out| out.write_all(text.as_bytes())).map(|_| ())
}
