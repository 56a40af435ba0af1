//! `chart space`: a finer mesh or a shorter step.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::pool;
use tearmesh_lab::space::{self, Options, Plan, SpaceScene, Study, VISITS_MAX};

use super::files::{Ended, bug, check, some_time, tell, write_all};
use super::parts::{self, Part};
use super::progress::{self, PARTS, PERCENT, VISIT_S};
use super::provenance;
use crate::args::SpaceArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// Runs the experiment, or puts it together of its parts, and draws its chart. What is done when it is interrupted is drawn as well.
pub(super) fn work(
    args: &SpaceArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let options = options(args);
    let plan = Plan::new(&options).map_err(|error| {
        let help = "as in --size 16,32,64 --finest 128 --part 1,0.5";
        let fault = Fault::error("E-USAGE", error.to_string()).help(help);
        (Exit::Usage, fault)
    })?;
    let parts = || parts(&options);
    if parts::plan(&args.parts, draw, parts, streams)? {
        return Ok(Exit::Done);
    }
    let study: Study = match &args.parts.gather {
        Some(folder) => parts::gather(&parts(), folder, command(&options))?,
        None => {
            progress::announce(&expected(&plan, &options), draw, streams);
            made(&plan, &options, target)
        }
    };
    let svg = space::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || space::csv(&study), &study, streams)?;
    let words = space::summary(&study);
    tell(words.trim_end(), &files, draw.quiet, streams)?;
    if !study.is_interrupted {
        return Ok(parts::warn(&study.missing, draw, streams));
    }
    let message = "interrupted; runs that were not done stand as failed".to_owned();
    let fault = Fault::warning("W-CHART-INTERRUPTED", message);
    Ok(streams.fail(&fault, draw.color, Exit::Interrupted))
}

/// A part is a scene.
fn parts(options: &Options) -> Vec<Part> {
    let part = |&scene: &SpaceScene| {
        let alone = Options {
            scenes: vec![scene],
            ..options.clone()
        };
        Part {
            name: scene.name().to_owned(),
            command: command(&alone),
        }
    };
    options.scenes.iter().map(part).collect()
}

fn made(plan: &Plan, options: &Options, target: ProgressDrawTarget) -> Study {
    let guard = Guard::new();
    let bar = progress::bar(PARTS, PERCENT, target);
    let provenance = provenance::of(command(options), false);
    let study = plan.study(provenance, &|| guard.is_interrupted(), |name, part| {
        bar.set_position((PARTS as f64 * part) as u64);
        bar.set_message(name.to_owned());
    });
    bar.finish_and_clear();
    study
}

fn options(args: &SpaceArgs) -> Options {
    let all = SpaceScene::ALL.into_iter();
    let is_wanted = |scene: &SpaceScene| args.scene.iter().any(|name| name == scene.name());
    Options {
        scenes: all.filter(is_wanted).collect(),
        cells: args.size.clone(),
        finest: args.finest,
        methods: args.method.clone(),
        parts: args.part.clone(),
        threads: args.threads.unwrap_or_else(pool::workers),
        visits_max: args.visits_max.unwrap_or(VISITS_MAX),
    }
}

/// How many runs there will be, and how long they will take.
fn expected(plan: &Plan, options: &Options) -> String {
    let seconds = VISIT_S * plan.guessed_visits() / options.threads.get() as f64;
    let about = some_time(seconds);
    let threads = match options.threads.get() {
        1 => "one thread".to_owned(),
        n => format!("{n} threads"),
    };
    let runs = plan.runs();
    format!("{runs} runs on {threads}, some {about}; Ctrl-C ends it with what is done")
}

/// The command with all that decides its figures.
fn command(options: &Options) -> String {
    let list = |words: &mut dyn Iterator<Item = String>| words.collect::<Vec<_>>().join(",");
    let scenes = options.scenes.iter().map(|scene| scene.name().to_owned());
    format!(
        "tearmesh chart space --scene {} --size {} --finest {} --method {} --part {} --visits-max {}",
        list(&mut { scenes }),
        list(&mut options.cells.iter().map(u32::to_string)),
        options.finest,
        options.methods.join(","),
        list(&mut options.parts.iter().map(f64::to_string)),
        options.visits_max,
    )
}
