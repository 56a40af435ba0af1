//! `chart choice`: what choosing a method by scene could save.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::choice::{self, Options, Study};
use tearmesh_lab::parts::Missing;
use tearmesh_lab::{Provenance, pool};

use super::experiment::{Experiment, Parted, Stop, Watch, work_in_parts};
use super::files::{Ended, some_time};
use super::parts::Part;
use super::progress::VISIT_S;
use crate::args::ChoiceArgs;
use crate::exit::Exit;
use crate::streams::Streams;

pub(super) fn work(
    args: &ChoiceArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let choice = Choice(Options {
        seed: args.seed,
        scenes: args.scenes.clone(),
        seconds: args.seconds,
        threads: args.threads.unwrap_or_else(pool::workers),
    });
    work_in_parts(&choice, &args.parts, &args.draw, target, streams)
}

struct Choice(Options);

impl Experiment for Choice {
    type Study = Study;

    fn command(&self) -> String {
        command(&self.0)
    }

    fn expected(&self) -> String {
        let options = &self.0;
        let (first, last) = (options.scenes.start(), options.scenes.end());
        let work_s = VISIT_S * choice::guessed_visits(options);
        let about = some_time(work_s / options.threads.get() as f64);
        let count = last - first + 1;
        format!("scenes {first} to {last}, {count} in all, some {about}")
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        let heard = |number: u32, part| watch(&format!("scene {number}"), part);
        Ok(choice::study(&self.0, provenance, stop, heard))
    }

    fn svg(study: &Study) -> Option<String> {
        choice::svg(study)
    }

    fn csv(study: &Study) -> String {
        choice::csv(study)
    }

    fn summary(study: &Study) -> String {
        choice::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
}

/// The scenes of a part.
const SCENES: usize = 5;

/// A part is a range of scenes.
impl Parted for Choice {
    fn parts(&self) -> Vec<Part> {
        let options = &self.0;
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
}

fn command(options: &Options) -> String {
    let (first, last) = (options.scenes.start(), options.scenes.end());
    format!(
        "tearmesh chart choice --seed {} --scenes {first}-{last} --seconds {}",
        options.seed, options.seconds
    )
}
