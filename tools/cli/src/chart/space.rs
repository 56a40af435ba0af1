//! `chart space`: a finer mesh or a shorter step.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::parts::Missing;
use tearmesh_lab::space::{self, Options, Plan, SpaceScene, Study, VISITS_MAX};
use tearmesh_lab::{Provenance, pool};

use super::experiment::{Experiment, Parted, Stop, Watch, list, work_in_parts};
use super::files::{Ended, some_time};
use super::parts::Part;
use super::progress::{VISIT_S, on_threads};
use crate::args::SpaceArgs;
use crate::exit::Exit;
use crate::say::Fault;
use crate::streams::Streams;

pub(super) fn work(
    args: &SpaceArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let options = options(args);
    let plan = Plan::new(&options).map_err(|error| {
        let help = "as in --size 16,32,64 --finest 128 --part 1,0.5";
        let fault = Fault::error("E-USAGE", error.to_string()).help(help);
        (Exit::Usage, fault)
    })?;
    let space = Space { options, plan };
    work_in_parts(&space, &args.parts, &args.draw, target, streams)
}

struct Space {
    options: Options,
    plan: Plan,
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

impl Experiment for Space {
    type Study = Study;

    fn command(&self) -> String {
        command(&self.options)
    }

    fn expected(&self) -> String {
        let threads = self.options.threads;
        let seconds = VISIT_S * self.plan.guessed_visits() / threads.get() as f64;
        let (runs, threads) = (self.plan.runs(), on_threads(threads));
        format!("{runs} runs {threads}, some {}", some_time(seconds))
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        Ok(Some(self.plan.study(provenance, stop, watch)))
    }

    fn svg(study: &Study) -> Option<String> {
        space::svg(study)
    }

    fn csv(study: &Study) -> String {
        space::csv(study)
    }

    fn summary(study: &Study) -> String {
        space::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
}

/// A part is a scene.
impl Parted for Space {
    fn parts(&self) -> Vec<Part> {
        let part = |&scene: &SpaceScene| {
            let alone = Options {
                scenes: vec![scene],
                ..self.options.clone()
            };
            Part {
                name: scene.name().to_owned(),
                command: command(&alone),
            }
        };
        self.options.scenes.iter().map(part).collect()
    }
}

fn command(options: &Options) -> String {
    format!(
        "tearmesh chart space --scene {} --size {} --finest {} --method {} --part {} --visits-max {}",
        list(options.scenes.iter().map(|scene| scene.name())),
        list(&options.cells),
        options.finest,
        list(&options.methods),
        list(&options.parts),
        options.visits_max,
    )
}
