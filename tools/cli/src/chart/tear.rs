//! `chart tear`: the force that tears strips, and what comes of cascades.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::pool;
use tearmesh_lab::tear::cascade::{self, CascadeScene, METHODS, Options};
use tearmesh_lab::tear::{self, Chart};

use super::files::{Ended, bug, check, interrupted, some_time, tell, write, write_all};
use super::parts::{self, Part};
use super::progress::{self, PARTS, PERCENT};
use super::provenance;
use crate::args::TearChartArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// A strip with a cell across took so many seconds of a processor on the machine that charts were first made
/// on; one of n cells has n times n of them, and steps n times as short.
const STRIP_S: f64 = 4e-3;

/// Tears strips and plays cascades, or puts them together of parts, and draws the chart.
pub(super) fn work(
    args: &TearChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, args.runs.as_ref())?;
    let strips = strips(args)?;
    let options = options(args);
    let parts = || parts(strips, &options);
    if parts::plan(&args.parts, draw, parts, streams)? {
        return Ok(Exit::Done);
    }
    let chart: Chart = match &args.parts.gather {
        Some(folder) => parts::gather(&parts(), folder, command(strips, &options))?,
        None => {
            let seconds = [strips_s(strips), cascades_s(&options)];
            progress::announce(&expected(strips, &options, seconds), draw, streams);
            made(strips, &options, seconds, target)?
        }
    };
    let svg = tear::svg(&chart).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || tear::csv(&chart), &chart, streams)?;
    if let Some(path) = &args.runs {
        let runs = cascade::csv(&chart.cascades, &chart.missing);
        write(path, &runs, streams)?;
    }
    let conclusion = &chart.study.conclusion;
    let words = format!("{conclusion}\n{}", cascade::summary(&chart.cascades));
    tell(words.trim(), &files, draw.quiet, streams)?;
    Ok(parts::warn(&chart.missing, draw, streams))
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

/// A part is all strips, or the ensembles of one scene on one mesh by one method.
fn parts(strips: &[u32], options: &Options) -> Vec<Part> {
    let none = Options {
        scenes: Vec::new(),
        ..options.clone()
    };
    let of_strips = Part {
        name: "strips".to_owned(),
        command: command(strips, &none),
    };
    let mut parts: Vec<Part> = Some(of_strips)
        .filter(|_| !strips.is_empty())
        .into_iter()
        .collect();
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
                    name: format!("{}-{cells}-{method}", scene.name()),
                    command: command(&[], &alone),
                });
            }
        }
    }
    parts
}

fn made(
    strips: &[u32],
    options: &Options,
    [strips_s, cascades_s]: [f64; 2],
    target: ProgressDrawTarget,
) -> Ended<Chart> {
    let bar = progress::bar(PARTS, PERCENT, target);
    let guard = Guard::new();
    let stop = || guard.is_interrupted();
    let share = strips_s / (strips_s + cascades_s).max(f64::MIN_POSITIVE);
    let show = |part: f64, name: &str| {
        bar.set_position((PARTS as f64 * part) as u64);
        bar.set_message(name.to_owned());
    };
    let mut study = tear::Study::default();
    if !strips.is_empty() {
        let tests = 2.0 * strips.len() as f64;
        let torn = tear::study(strips, true, options.threads, &stop, |done| {
            show(share * done as f64 / tests, "strips");
        });
        let torn = torn.map_err(|error| bug(error.to_string()))?;
        study = torn.ok_or_else(interrupted)?;
    }
    let cascades = cascade::play(options, &stop, |name, part| {
        show(share + (1.0 - share) * part, name);
    });
    bar.finish_and_clear();
    let cascades = cascades.map_err(|error| bug(error.to_string()))?;
    let cascades = cascades.ok_or_else(interrupted)?;
    let provenance = provenance::of(command(strips, options), false);
    Ok(Chart::new(provenance, study, cascades))
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

/// The command with all that decides the figures.
fn command(strips: &[u32], options: &Options) -> String {
    let list: Vec<String> = strips.iter().map(u32::to_string).collect();
    let strips = match list.is_empty() {
        true => "--no-strips".to_owned(),
        false => format!("--strips {}", list.join(",")),
    };
    let scenes: Vec<&str> = options.scenes.iter().map(|scene| scene.name()).collect();
    let cells: Vec<String> = options.cells.iter().map(u32::to_string).collect();
    let size = match cells.is_empty() {
        true => String::new(),
        false => format!(" --size {}", cells.join(",")),
    };
    let cascades = match scenes.is_empty() {
        true => "--seeds 0".to_owned(),
        false => format!(
            "--scene {} --method {} --seeds {}{size}",
            scenes.join(","),
            options.methods.join(","),
            options.seeds
        ),
    };
    format!("tearmesh chart tear {strips} {cascades}")
}

/// How many runs there will be, and how long they will take.
fn expected(strips: &[u32], options: &Options, [strips_s, cascades_s]: [f64; 2]) -> String {
    let processors = options.threads.get() as f64;
    let least = some_time((strips_s + cascades_s) / processors);
    let most = some_time((strips_s + cascade::MORE as f64 * cascades_s) / processors);
    let runs = cascade::runs(options);
    let more = match runs {
        0 => String::new(),
        _ => format!(" to {most}, as seeds tell"),
    };
    format!(
        "{} strips and {runs} runs of cascades or more, {least}{more}; Ctrl-C ends it without a chart",
        2 * strips.len()
    )
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
    ("verlet", [3.0, 0.6]),
    ("xpbd", [1.2, 0.3]),
    ("implicit", [3.5, 1.4]),
    ("pbd", [1.8, 0.5]),
    ("provot", [10.0, 3.8]),
];
