//! `chart stability`: where methods fail, and what one is told.

use indicatif::ProgressDrawTarget;
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};
use tearmesh_lab::parts::Missing;
use tearmesh_lab::stability::{self, Options, Study, Teller, Told};
use tearmesh_lab::{Provenance, pool};

use super::experiment::{self, Experiment, Stop, Watch, list};
use super::files::{Ended, some_time};
use crate::args::StabilityArgs;
use crate::exit::Exit;
use crate::say::Fault;
use crate::streams::Streams;
use crate::tear::advice;

/// The limits of a stiffness took so many seconds of a processor on the machine that charts were first made
/// on, and the scenes so many.
const LIMITS_S: f64 = 7.0;
const SCENES_S: f64 = 10.0;

pub(super) fn work(
    args: &StabilityArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let stability = Stability(Options {
        stiffness_n_per_m: args.stiffness.clone(),
        threads: args.threads.unwrap_or_else(pool::workers),
    });
    experiment::work(&stability, &args.draw, target, streams)
}

struct Stability(Options);

impl Experiment for Stability {
    type Study = Study;

    fn command(&self) -> String {
        let stiffness = list(&self.0.stiffness_n_per_m);
        format!("tearmesh chart stability --stiffness {stiffness}")
    }

    fn expected(&self) -> String {
        let pieces = stability::pieces(&self.0);
        let work_s = LIMITS_S * self.0.stiffness_n_per_m.len() as f64 + SCENES_S;
        let about = some_time(work_s / self.0.threads.get() as f64);
        format!("{pieces} limits and scenes, some {about}")
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        let pieces = stability::pieces(&self.0) as f64;
        let mut done = 0.0;
        let heard = |name: &str| {
            done += 1.0;
            watch(name, done / pieces);
        };
        let study = stability::study(&self.0, provenance, &Command, stop, heard);
        Ok(study)
    }

    fn svg(study: &Study) -> Option<String> {
        stability::svg(study)
    }

    fn csv(study: &Study) -> String {
        stability::csv(study)
    }

    fn summary(study: &Study) -> String {
        stability::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
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
