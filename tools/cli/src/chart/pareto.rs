//! `chart pareto`: work against precision.

use std::path::PathBuf;
use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::pareto::{self, By, Case, Options, SCENES, Study, VISITS_MAX};
use tearmesh_lab::parts::Missing;
use tearmesh_lab::{Provenance, pool};

use super::experiment::{Experiment, Parted, Stop, Watch, list, work_in_parts};
use super::files::{Ended, some_time};
use super::parts::Part;
use super::progress::{VISIT_S, on_threads};
use crate::args::ParetoArgs;
use crate::exit::Exit;
use crate::streams::Streams;

pub(super) fn work(
    args: &ParetoArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let pareto = Pareto {
        options: options(args),
        time_chart: args.time_chart.clone(),
    };
    work_in_parts(&pareto, &args.parts, &args.draw, target, streams)
}

struct Pareto {
    options: Options,
    /// The file for the chart by CPU time.
    time_chart: Option<PathBuf>,
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

impl Experiment for Pareto {
    type Study = Study;

    fn is_timed(&self) -> bool {
        self.time_chart.is_some()
    }

    fn command(&self) -> String {
        command(&self.options, self.is_timed())
    }

    fn expected(&self) -> String {
        let options = &self.options;
        let cases = pareto::cases(options);
        let runs: usize = cases.iter().map(|case| pareto::plan(case).len()).sum();
        let seconds = VISIT_S * pareto::guessed_visits(options) / options.threads.get() as f64;
        let threads = on_threads(options.threads);
        format!("{runs} runs {threads}, some {}", some_time(seconds))
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        let clock: &(dyn Fn() -> Duration + Sync) = &|| ThreadTime::now().as_duration();
        let clock = self.is_timed().then_some(clock);
        let study = pareto::study(&self.options, provenance, clock, stop, watch);
        Ok(Some(study))
    }

    fn svg(study: &Study) -> Option<String> {
        pareto::svg(study, By::Visits)
    }

    fn csv(study: &Study) -> String {
        pareto::csv(study)
    }

    fn summary(study: &Study) -> String {
        pareto::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }

    fn other_file(&self) -> Option<&PathBuf> {
        self.time_chart.as_ref()
    }

    fn other(&self, study: &Study) -> Option<String> {
        pareto::svg(study, By::Time)
    }
}

/// A part is a case: a scene on a mesh.
impl Parted for Pareto {
    fn parts(&self) -> Vec<Part> {
        let cases = pareto::cases(&self.options);
        let part = |case: &Case| {
            let alone = Options {
                scenes: vec![case.scene],
                meshes: vec![case.mesh],
                cells: vec![case.cells],
                ..self.options.clone()
            };
            Part {
                name: case.part_name(),
                command: command(&alone, self.is_timed()),
            }
        };
        cases.iter().map(part).collect()
    }
}

fn command(options: &Options, is_timed: bool) -> String {
    let times = match is_timed {
        true => format!(" --time-chart … --repeats {}", options.repeats),
        false => String::new(),
    };
    format!(
        "tearmesh chart pareto --scene {} --mesh {} --size {} --visits-max {}{times}",
        list(options.scenes.iter().map(|scene| scene.name)),
        list(options.meshes.iter().map(|mesh| mesh.name())),
        list(&options.cells),
        options.visits_max,
    )
}
