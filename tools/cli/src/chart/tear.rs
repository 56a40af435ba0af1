//! `chart tear`: the force that tears strips, and what comes of cascades.

use std::path::PathBuf;

use indicatif::ProgressDrawTarget;
use tearmesh_lab::parts::Missing;
use tearmesh_lab::tear::cascade::{self, CascadeScene, METHODS, Options};
use tearmesh_lab::tear::{self, Chart};
use tearmesh_lab::{Provenance, pool};

use super::experiment::{Experiment, Parted, Stop, Watch, list, work_in_parts};
use super::files::{Ended, bug, some_time};
use super::parts::Part;
use crate::args::TearChartArgs;
use crate::exit::Exit;
use crate::say::Fault;
use crate::streams::Streams;

/// A strip with a cell across took so many seconds of a processor on the machine that charts were first made
/// on; one of n cells has n times n of them, and steps n times as short.
const STRIP_S: f64 = 5e-3;

pub(super) fn work(
    args: &TearChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let tear = Tear {
        strips: strips(args)?,
        options: options(args),
        runs: args.runs.as_ref(),
    };
    work_in_parts(&tear, &args.parts, &args.draw, target, streams)
}

struct Tear<'a> {
    /// The numbers of cells across the strips.
    strips: &'a [u32],
    /// The options of cascades.
    options: Options,
    /// The file for a table of all runs.
    runs: Option<&'a PathBuf>,
}

/// The strips that are wanted: none, or two or more.
fn strips(args: &TearChartArgs) -> Ended<&[u32]> {
    match &args.strips[..] {
        _ if args.no_strips => Ok(&[]),
        [_] => {
            let message = "`--strips` takes two numbers or more: forces are compared".to_owned();
            let fault = Fault::error("E-USAGE", message).help("as in --strips 8,16");
            Err((Exit::Usage, fault))
        }
        strips => Ok(strips),
    }
}

fn options(args: &TearChartArgs) -> Options {
    let is_named = |scene: &CascadeScene| args.scene.iter().any(|name| name == scene.name());
    let scenes = CascadeScene::ALL.into_iter().filter(is_named);
    Options {
        // Of ensembles without seeds there is nothing to tell.
        scenes: scenes.filter(|_| args.seeds > 0).collect(),
        cells: {
            let mut cells = args.size.clone();
            cells.sort_unstable();
            cells.dedup();
            cells
        },
        methods: args.method.clone(),
        seeds: args.seeds,
        threads: args.threads.unwrap_or_else(pool::workers),
    }
}

impl Tear<'_> {
    /// The seconds of a processor that strips take, and those of cascades.
    fn seconds(&self) -> [f64; 2] {
        [strips_s(self.strips), cascades_s(&self.options)]
    }
}

impl Experiment for Tear<'_> {
    type Study = Chart;

    fn command(&self) -> String {
        command(self.strips, &self.options)
    }

    fn expected(&self) -> String {
        let [strips_s, cascades_s] = self.seconds();
        let processors = self.options.threads.get() as f64;
        let about = some_time((strips_s + cascades_s) / processors);
        let (strips, runs) = (2 * self.strips.len(), cascade::runs(&self.options));
        format!("{strips} strips and {runs} runs of cascades, some {about}")
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Chart>> {
        let [strips_s, cascades_s] = self.seconds();
        let share = strips_s / (strips_s + cascades_s).max(f64::MIN_POSITIVE);
        let (mut study, mut missing) = (tear::Study::default(), Vec::new());
        if !self.strips.is_empty() {
            let tests = 2.0 * self.strips.len() as f64;
            let torn = tear::study(self.strips, true, self.options.threads, stop, |done| {
                watch("strips", share * done as f64 / tests);
            });
            match torn.map_err(|error| bug(error.to_string()))? {
                Some(torn) => study = torn,
                None => missing.push(Missing::interrupted(STRIPS.to_owned())),
            }
        }
        let played = cascade::play(&self.options, stop, |name, part| {
            watch(name, share + (1.0 - share) * part);
        });
        let (cascades, unplayed) = played.map_err(|error| bug(error.to_string()))?;
        missing.extend(unplayed);
        let is_nothing = study.tests.is_empty() && cascades.is_empty();
        Ok((!is_nothing).then(|| Chart {
            missing,
            ..Chart::new(provenance, study, cascades)
        }))
    }

    fn svg(chart: &Chart) -> Option<String> {
        tear::svg(chart)
    }

    fn csv(chart: &Chart) -> String {
        tear::csv(chart)
    }

    fn summary(chart: &Chart) -> String {
        let conclusion = &chart.study.conclusion;
        format!("{conclusion}\n{}", cascade::summary(&chart.cascades))
    }

    fn missing(chart: &Chart) -> &[Missing] {
        &chart.missing
    }

    fn other_file(&self) -> Option<&PathBuf> {
        self.runs
    }

    fn other(&self, chart: &Chart) -> Option<String> {
        Some(cascade::csv(&chart.cascades, &chart.missing))
    }
}

/// The name of the part that has all strips.
const STRIPS: &str = "strips";

/// A part is all strips, or the ensembles of one scene on one mesh by one method.
impl Parted for Tear<'_> {
    fn parts(&self) -> Vec<Part> {
        let options = &self.options;
        let none = Options {
            scenes: Vec::new(),
            ..options.clone()
        };
        let of_strips = Part {
            name: STRIPS.to_owned(),
            command: command(self.strips, &none),
        };
        let has_strips = !self.strips.is_empty();
        let mut parts: Vec<Part> = has_strips.then_some(of_strips).into_iter().collect();
        for &scene in &options.scenes {
            for cells in options.sizes(scene) {
                for method in METHODS.into_iter().filter(|name| options.plays(name)) {
                    let alone = Options {
                        scenes: vec![scene],
                        cells: vec![cells],
                        methods: vec![method.to_owned()],
                        ..options.clone()
                    };
                    parts.push(Part {
                        name: cascade::part_name(scene, cells, method),
                        command: command(&[], &alone),
                    });
                }
            }
        }
        parts
    }
}

/// The command with all that decides the figures.
fn command(strips: &[u32], options: &Options) -> String {
    let strips = match strips {
        [] => "--no-strips".to_owned(),
        strips => format!("--strips {}", list(strips)),
    };
    let size = match &options.cells[..] {
        [] => String::new(),
        cells => format!(" --size {}", list(cells)),
    };
    let cascades = match &options.scenes[..] {
        [] => "--seeds 0".to_owned(),
        scenes => format!(
            "--scene {} --method {} --seeds {}{size}",
            list(scenes.iter().map(|scene| scene.name())),
            list(&options.methods),
            options.seeds
        ),
    };
    format!("tearmesh chart tear {strips} {cascades}")
}

/// The seconds of a processor that strips take.
fn strips_s(strips: &[u32]) -> f64 {
    let cubes = strips.iter().map(|&cells| f64::from(cells).powi(3));
    2.0 * STRIP_S * cubes.sum::<f64>()
}

/// The seconds of a processor that a run at the step of each method took there, and those of all runs at it,
/// half and a quarter of it: a mesh twice as fine has four times as many edges, and steps that are shorter,
/// by half where the method is explicit.
fn cascades_s(options: &Options) -> f64 {
    let run_s = |scene: CascadeScene, cells: u32, method: &str| {
        let known = RUN_S.iter().find(|(name, _)| *name == method);
        let [trouser, rip] = known.map_or([1.0; 2], |(_, seconds)| *seconds);
        let finer = f64::from(cells) / f64::from(scene.cells());
        finer.powf(2.5)
            * match scene {
                CascadeScene::Trouser => trouser,
                CascadeScene::Rip => rip,
            }
    };
    let mut each_s = 0.0;
    for &scene in &options.scenes {
        for cells in options.sizes(scene) {
            let methods = options.methods.iter();
            each_s += methods.map(|name| run_s(scene, cells, name)).sum::<f64>();
        }
    }
    7.0 * options.seeds as f64 * each_s
}

/// By method, of trouser tests and rips of their own sizes.
const RUN_S: [(&str, [f64; 2]); 5] = [
    ("verlet", [6.0, 1.2]),
    ("xpbd", [2.0, 0.5]),
    ("implicit", [5.0, 2.5]),
    ("pbd", [2.5, 0.8]),
    ("provot", [20.0, 6.0]),
];
