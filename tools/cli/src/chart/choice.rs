//! `chart choice`: what choosing a method by scene could save.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::choice::{self, Options};
use tearmesh_lab::pool;

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::progress;
use super::provenance;
use crate::args::ChoiceArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::streams::Streams;

/// A visit of an edge took so many seconds on the machine that charts were first made on.
const VISIT_S: f64 = 12e-9;

/// Makes the experiment, and draws the chart.
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
    let (first, last) = (*options.scenes.start(), *options.scenes.end());
    let work_s = VISIT_S * choice::guessed_visits(&options);
    let about = some_time(work_s / options.threads.get() as f64);
    let count = last - first + 1;
    let words = format!(
        "scenes {first} to {last}, {count} in all, some {about}; Ctrl-C ends it without a chart"
    );
    progress::announce(&words, draw, streams);
    let bar = progress::bar(progress::PARTS, progress::PERCENT, target);
    let guard = Guard::new();
    let command = format!(
        "tearmesh chart choice --seed {} --scenes {first}-{last} --seconds {}",
        args.seed, args.seconds
    );
    let study = choice::study(
        &options,
        provenance::of(command, false),
        &|| guard.is_interrupted(),
        |number, done| {
            bar.set_position((done * progress::PARTS as f64) as u64);
            bar.set_message(format!("scene {number}"));
        },
    );
    bar.finish_and_clear();
    drop(guard);
    let study = study.ok_or_else(interrupted)?;
    let svg = choice::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || choice::csv(&study), &study, streams)?;
    let words = choice::summary(&study);
    tell(words.trim_end(), &files, draw.quiet, streams)?;
    Ok(Exit::Done)
}
