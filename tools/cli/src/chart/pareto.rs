//! `chart pareto`: work against precision.

use std::path::PathBuf;
use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tearmesh_lab::pareto::{self, By, Options, Provenance, SCENES, Study, VISITS_MAX};
use tearmesh_lab::pool;

use super::files::{Ended, bug, check, json, tell, write};
use crate::args::ChartArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::{Fault, Screen, is_colored};
use crate::streams::Streams;

/// A visit of an edge took some 9 ns on the machine that charts were first made on.
const VISIT_S: f64 = 9e-9;

/// Runs the experiment, and draws its charts. What is done when it is interrupted is drawn as well.
pub(super) fn work(
    args: &ChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let files = [
        Some(&args.output),
        args.csv.as_ref(),
        args.json.as_ref(),
        args.pareto.time_chart.as_ref(),
    ];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    check(&files)?;
    let options = options(args);
    let expected = expected(&options);
    let guard = Guard::new();
    if !args.quiet {
        // Nowhere is left to say it if standard error is closed.
        let _ = writeln!(streams.error, "{expected}");
    }
    let study = made(args, &options, target, &guard);
    drop(guard);
    let drawn = |by| {
        let svg = pareto::svg(&study, by);
        svg.ok_or_else(|| bug("the chart cannot be drawn".to_owned()))
    };
    write(&args.output, &drawn(By::Visits)?, streams)?;
    if let Some(path) = &args.pareto.time_chart {
        write(path, &drawn(By::Time)?, streams)?;
    }
    if let Some(path) = &args.csv {
        write(path, &pareto::csv(&study), streams)?;
    }
    if let Some(path) = &args.json {
        write(path, &json(&study), streams)?;
    }
    tell(
        pareto::summary(&study).trim_end(),
        &files,
        args.quiet,
        streams,
    )?;
    if !study.is_interrupted {
        return Ok(Exit::Done);
    }
    let message = "interrupted; runs that were not done stand as failed";
    let fault = Fault::warning("W-CHART-INTERRUPTED", message.to_owned());
    let mut screen = Screen {
        colored: is_colored(args.color, streams.error_is_terminal),
        error: streams.error,
    };
    // As above.
    let _ = screen.show(&fault);
    Ok(Exit::Interrupted)
}

fn options(args: &ChartArgs) -> Options {
    let wanted = &args.pareto;
    let of_name = |name: &String| SCENES.into_iter().find(|scene| scene.name == name);
    let scenes: Vec<_> = wanted.scene.iter().filter_map(of_name).collect();
    let repeats = match wanted.time_chart {
        Some(_) => wanted.repeats,
        None => 0,
    };
    Options {
        scenes: if scenes.is_empty() {
            SCENES.to_vec()
        } else {
            scenes
        },
        meshes: wanted.mesh.iter().map(|mesh| mesh.of_library()).collect(),
        cells: wanted.size.clone(),
        threads: wanted.threads.unwrap_or_else(pool::workers),
        visits_max: wanted.visits_max.unwrap_or(VISITS_MAX),
        repeats,
    }
}

/// How many runs there will be, and how long they will take.
fn expected(options: &Options) -> String {
    let cases = pareto::cases(options);
    let runs: usize = cases.iter().map(|case| pareto::plan(case).len()).sum();
    let seconds = VISIT_S * pareto::guessed_visits(options) / options.threads.get() as f64;
    let about = match seconds {
        s if s < 90.0 => format!("{} s", s.ceil().max(1.0)),
        s => format!("{} min", (s / 60.0).ceil()),
    };
    let threads = match options.threads.get() {
        1 => "one thread".to_owned(),
        n => format!("{n} threads"),
    };
    format!("{runs} runs on {threads}, some {about}; Ctrl-C ends it with what is done")
}

fn made(args: &ChartArgs, options: &Options, target: ProgressDrawTarget, guard: &Guard) -> Study {
    let bar = ProgressBar::with_draw_target(Some(1000), target);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent} % {eta} {msg}") {
        bar.set_style(style);
    }
    let clock: &(dyn Fn() -> Duration + Sync) = &|| ThreadTime::now().as_duration();
    let is_timed = args.pareto.time_chart.is_some();
    let study = pareto::study(
        options,
        provenance(options, is_timed),
        is_timed.then_some(clock),
        &|| guard.is_interrupted(),
        |name, part| {
            bar.set_position((1000.0 * part) as u64);
            bar.set_message(name.to_owned());
        },
    );
    bar.finish_and_clear();
    study
}

/// What charts say of where they come from: the command with all that decides their figures.
fn provenance(options: &Options, is_timed: bool) -> Provenance {
    let list = |names: Vec<String>| names.join(",");
    let scenes = options.scenes.iter().map(|scene| scene.name.to_owned());
    let meshes = options.meshes.iter().map(|mesh| mesh.name().to_owned());
    let sizes = options.cells.iter().map(u32::to_string);
    let mut command = format!(
        "tearmesh chart pareto --scene {} --mesh {} --size {} --visits-max {}",
        list(scenes.collect()),
        list(meshes.collect()),
        list(sizes.collect()),
        options.visits_max,
    );
    if is_timed {
        command += &format!(" --time-chart … --repeats {}", options.repeats);
    }
    Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("TEARMESH_COMMIT").to_owned(),
        compiler: env!("TEARMESH_COMPILER").to_owned(),
        processor: is_timed.then(processor),
    }
}

/// What the processor calls itself, where the system says so, or else its architecture.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = text.lines().filter(|line| line.starts_with("model name"));
    let named = lines.next().and_then(|line| line.split_once(':'));
    named.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| {
        name.trim().to_owned()
    })
}
