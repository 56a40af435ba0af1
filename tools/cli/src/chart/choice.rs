//! `chart choice`: what choosing a method by scene could save.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::choice::{self, Options, Study};
use tearmesh_lab::pool;

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::parts::{self, Part};
use super::progress::{self, PARTS, PERCENT, VISIT_S};
use super::provenance;
use crate::args::ChoiceArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::streams::Streams;

/// Makes the experiment, or puts it together of its parts, and draws the chart.
pub(super) fn work(
    args: &ChoiceArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let options = Options {
        seed: args.seed,
        scenes: args.scenes.clone(),
        seconds: args.seconds,
        threads: args.threads.unwrap_or_else(pool::workers),
    };
    let parts = || parts(&options);
    if parts::plan(&args.parts, draw, parts, streams)? {
        return Ok(Exit::Done);
    }
    let study: Study = match &args.parts.gather {
        Some(folder) => parts::gather(&parts(), folder, command(&options))?,
        None => {
            progress::announce(&expected(&options), draw, streams);
            made(&options, target)?
        }
    };
    let svg = choice::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || choice::csv(&study), &study, streams)?;
    let words = choice::summary(&study);
    tell(words.trim_end(), &files, draw.quiet, streams)?;
    Ok(parts::warn(&study.missing, draw, streams))
}

/// The scenes of a part.
const SCENES: usize = 5;

/// A part is a range of scenes.
fn parts(options: &Options) -> Vec<Part> {
    let last = *options.scenes.end();
    let part = |first: u32| {
        let last = last.min(first + SCENES as u32 - 1);
        let alone = Options {
            scenes: first..=last,
            ..options.clone()
        };
        Part {
            name: format!("{first}-{last}"),
            command: command(&alone),
        }
    };
    options.scenes.clone().step_by(SCENES).map(part).collect()
}

fn made(options: &Options, target: ProgressDrawTarget) -> Ended<Study> {
    let bar = progress::bar(PARTS, PERCENT, target);
    let guard = Guard::new();
    let study = choice::study(
        options,
        provenance::of(command(options), false),
        &|| guard.is_interrupted(),
        |number, done| {
            bar.set_position((done * PARTS as f64) as u64);
            bar.set_message(format!("scene {number}"));
        },
    );
    bar.finish_and_clear();
    study.ok_or_else(interrupted)
}

/// How many scenes there will be, and how long they will take.
fn expected(options: &Options) -> String {
    let (first, last) = (options.scenes.start(), options.scenes.end());
    let work_s = VISIT_S * choice::guessed_visits(options);
    let about = some_time(work_s / options.threads.get() as f64);
    let count = last - first + 1;
    format!(
        "scenes {first} to {last}, {count} in all, some {about}; Ctrl-C ends it without a chart"
    )
}

/// The command with all that decides the figures.
fn command(options: &Options) -> String {
    let (first, last) = (options.scenes.start(), options.scenes.end());
    format!(
        "tearmesh chart choice --seed {} --scenes {first}-{last} --seconds {}",
        options.seed, options.seconds
    )
}
