//! `chart stability`: where methods fail, and what one is told.

use indicatif::ProgressDrawTarget;
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};
use tearmesh_lab::pool;
use tearmesh_lab::stability::{self, Options, Teller, Told};

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::progress;
use super::provenance;
use crate::args::StabilityArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;
use crate::tear::advice;

/// The limits of a stiffness took so many seconds of a processor on the machine that charts were first made
/// on, and the scenes so many.
const LIMITS_S: f64 = 7.0;
const SCENES_S: f64 = 10.0;

/// Makes the experiment, and draws the map.
pub(super) fn work(
    args: &StabilityArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let options = Options {
        stiffness_n_per_m: args.stiffness.clone(),
        threads: args.threads.unwrap_or_else(pool::workers),
    };
    let pieces = stability::pieces(&options);
    let work_s = LIMITS_S * options.stiffness_n_per_m.len() as f64 + SCENES_S;
    let about = some_time(work_s / options.threads.get() as f64);
    let words = format!("{pieces} limits and scenes, some {about}; Ctrl-C ends it without a chart");
    progress::announce(&words, draw, streams);
    let bar = progress::bar(pieces as u64, "{pos}/{len}", target);
    let guard = Guard::new();
    let stiffness: Vec<String> = args.stiffness.iter().map(f64::to_string).collect();
    let command = format!(
        "tearmesh chart stability --stiffness {}",
        stiffness.join(",")
    );
    let study = stability::study(
        &options,
        provenance::of(command, false),
        &Command,
        &|| guard.is_interrupted(),
        |name| {
            bar.inc(1);
            bar.set_message(name.to_owned());
        },
    );
    bar.finish_and_clear();
    drop(guard);
    let study = study.ok_or_else(interrupted)?;
    let svg = stability::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || stability::csv(&study), &study, streams)?;
    let words = stability::summary(&study);
    tell(words.trim_end(), &files, draw.quiet, streams)?;
    Ok(Exit::Done)
}

/// What this command says, as it would say it of the same run.
struct Command;

impl Teller for Command {
    fn step(&self, error: &StepError) -> Told {
        Told {
            code: advice::code(error).to_owned(),
            words: error.to_string(),
        }
    }

    fn run(&self, run: &Run, frame: &Frame, error: Option<&StepError>) -> Vec<Told> {
        let before = advice::before(run, frame, &|vertex| vertex + 1).into_iter();
        let failure = error.map(|error| advice::failure(error, run));
        let all = before.chain(advice::after(run)).chain(failure);
        all.map(told).collect()
    }
}

fn told(fault: Fault) -> Told {
    let words = match fault.help {
        Some(help) => format!("{}; help: {help}", fault.message),
        None => fault.message,
    };
    Told {
        code: fault.code.to_owned(),
        words,
    }
}
