//! `chart pareto`: work against precision.

use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::pareto::{self, By, Case, Options, SCENES, Study, VISITS_MAX};
use tearmesh_lab::pool;

use super::files::{Ended, bug, check, some_time, tell, write, write_all};
use super::parts::{self, Part};
use super::progress::{self, PARTS, PERCENT, VISIT_S};
use super::provenance;
use crate::args::ParetoArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// Runs the experiment, or puts it together of its parts, and draws its charts. What is done when it is
/// interrupted is drawn as well.
pub(super) fn work(
    args: &ParetoArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, args.time_chart.as_ref())?;
    let options = options(args);
    let is_timed = args.time_chart.is_some();
    let parts = || parts(&options, is_timed);
    if parts::plan(&args.parts, draw, parts, streams)? {
        return Ok(Exit::Done);
    }
    let study: Study = match &args.parts.gather {
        Some(folder) => parts::gather(&parts(), folder, command(&options, is_timed))?,
        None => {
            progress::announce(&expected(&options), draw, streams);
            made(&options, is_timed, target)
        }
    };
    let drawn = |by| {
        let svg = pareto::svg(&study, by);
        svg.ok_or_else(|| bug("the chart cannot be drawn".to_owned()))
    };
    let by_visits = drawn(By::Visits)?;
    write_all(draw, &by_visits, || pareto::csv(&study), &study, streams)?;
    if let Some(path) = &args.time_chart {
        write(path, &drawn(By::Time)?, streams)?;
    }
    tell(
        pareto::summary(&study).trim_end(),
        &files,
        draw.quiet,
        streams,
    )?;
    if !study.is_interrupted {
        return Ok(parts::warn(&study.missing, draw, streams));
    }
    let message = "interrupted; runs that were not done stand as failed".to_owned();
    let fault = Fault::warning("W-CHART-INTERRUPTED", message);
    Ok(streams.fail(&fault, draw.color, Exit::Interrupted))
}

/// A part is a case: a scene on a mesh.
fn parts(options: &Options, is_timed: bool) -> Vec<Part> {
    let cases = pareto::cases(options);
    let part = |case: &Case| {
        let alone = Options {
            scenes: vec![case.scene],
            meshes: vec![case.mesh],
            cells: vec![case.cells],
            ..options.clone()
        };
        Part {
            name: case.name().replace('/', "-"),
            command: command(&alone, is_timed),
        }
    };
    cases.iter().map(part).collect()
}

fn options(args: &ParetoArgs) -> Options {
    let of_name = |name: &String| SCENES.into_iter().find(|scene| scene.name == name);
    let scenes: Vec<_> = args.scene.iter().filter_map(of_name).collect();
    let repeats = match args.time_chart {
        Some(_) => args.repeats,
        None => 0,
    };
    Options {
        scenes: if scenes.is_empty() {
            SCENES.to_vec()
        } else {
            scenes
        },
        meshes: args.mesh.iter().map(|mesh| mesh.of_library()).collect(),
        cells: args.size.clone(),
        threads: args.threads.unwrap_or_else(pool::workers),
        visits_max: args.visits_max.unwrap_or(VISITS_MAX),
        repeats,
    }
}

/// How many runs there will be, and how long they will take.
fn expected(options: &Options) -> String {
    let cases = pareto::cases(options);
    let runs: usize = cases.iter().map(|case| pareto::plan(case).len()).sum();
    let seconds = VISIT_S * pareto::guessed_visits(options) / options.threads.get() as f64;
    let about = some_time(seconds);
    let threads = match options.threads.get() {
        1 => "one thread".to_owned(),
        n => format!("{n} threads"),
    };
    format!("{runs} runs on {threads}, some {about}; Ctrl-C ends it with what is done")
}

fn made(options: &Options, is_timed: bool, target: ProgressDrawTarget) -> Study {
    let guard = Guard::new();
    let bar = progress::bar(PARTS, PERCENT, target);
    let clock: &(dyn Fn() -> Duration + Sync) = &|| ThreadTime::now().as_duration();
    let study = pareto::study(
        options,
        provenance::of(command(options, is_timed), is_timed),
        is_timed.then_some(clock),
        &|| guard.is_interrupted(),
        |name, part| {
            bar.set_position((PARTS as f64 * part) as u64);
            bar.set_message(name.to_owned());
        },
    );
    bar.finish_and_clear();
    study
}

/// The command with all that decides the figures.
fn command(options: &Options, is_timed: bool) -> String {
    let list = |names: Vec<String>| names.join(",");
    let scenes = options.scenes.iter().map(|scene| scene.name.to_owned());
    let meshes = options.meshes.iter().map(|mesh| mesh.name().to_owned());
    let sizes = options.cells.iter().map(u32::to_string);
    let times = match is_timed {
        true => format!(" --time-chart … --repeats {}", options.repeats),
        false => String::new(),
    };
    format!(
        "tearmesh chart pareto --scene {} --mesh {} --size {} --visits-max {}{times}",
        list(scenes.collect()),
        list(meshes.collect()),
        list(sizes.collect()),
        options.visits_max,
    )
}
