//! `chart tear`: the force that tears strips, and what comes of cascades.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::pool;
use tearmesh_lab::tear::cascade::{self, CascadeScene, Options};
use tearmesh_lab::tear::{self, Chart};

use super::files::{Ended, bug, check, interrupted, some_time, tell, write, write_all};
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

/// Tears strips and plays cascades, and draws the chart.
pub(super) fn work(
    args: &TearChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, args.runs.as_ref())?;
    if args.strips.len() < 2 {
        let message = "`--strips` takes two numbers or more: forces are compared".to_owned();
        let fault = Fault::error("E-USAGE", message).help("as in --strips 8,16");
        return Err((Exit::Usage, fault));
    }
    let options = options(args);
    let cascades_s = cascades_s(&options);
    let cubes = args.strips.iter().map(|&cells| f64::from(cells).powi(3));
    let strips_s = 2.0 * STRIP_S * cubes.sum::<f64>();
    let words = expected(args, &options, [strips_s, cascades_s]);
    progress::announce(&words, draw, streams);
    let bar = progress::bar(PARTS, PERCENT, target);
    let guard = Guard::new();
    let stop = || guard.is_interrupted();
    let strips = 2.0 * args.strips.len() as f64;
    let share = strips_s / (strips_s + cascades_s);
    let show = |part: f64, name: &str| {
        bar.set_position((PARTS as f64 * part) as u64);
        bar.set_message(name.to_owned());
    };
    let study = tear::study(&args.strips, true, options.threads, &stop, |done| {
        show(share * done as f64 / strips, "strips");
    });
    let study = study.map_err(|error| bug(error.to_string()))?;
    let study = study.ok_or_else(interrupted)?;
    let cascades = cascade::play(&options, &stop, |name, part| {
        show(share + (1.0 - share) * part, name);
    });
    bar.finish_and_clear();
    drop(guard);
    let cascades = cascades.map_err(|error| bug(error.to_string()))?;
    let cascades = cascades.ok_or_else(interrupted)?;
    let chart = Chart::new(
        provenance::of(command(args, &options), false),
        study,
        cascades,
    );
    let svg = tear::svg(&chart).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || tear::csv(&chart.study), &chart, streams)?;
    if let Some(path) = &args.runs {
        write(path, &cascade::csv(&chart.cascades), streams)?;
    }
    let words = format!(
        "{}\n{}",
        chart.study.conclusion,
        cascade::summary(&chart.cascades)
    );
    tell(words.trim_end(), &files, draw.quiet, streams)?;
    Ok(Exit::Done)
}

fn options(args: &TearChartArgs) -> Options {
    let is_named = |scene: &CascadeScene| args.scene.iter().any(|name| name == scene.name());
    let scenes = CascadeScene::ALL.into_iter().filter(is_named);
    Options {
        // Of ensembles without seeds there is nothing to tell.
        scenes: scenes.filter(|_| args.seeds > 0).collect(),
        cells: args.size,
        methods: args.method.clone(),
        seeds: args.seeds,
        threads: args.threads.unwrap_or_else(pool::workers),
    }
}

/// The command with all that decides the figures.
fn command(args: &TearChartArgs, options: &Options) -> String {
    let strips: Vec<String> = args.strips.iter().map(u32::to_string).collect();
    let strips = format!("tearmesh chart tear --strips {}", strips.join(","));
    let scenes: Vec<&str> = options.scenes.iter().map(|scene| scene.name()).collect();
    let size = options
        .cells
        .map_or(String::new(), |cells| format!(" --size {cells}"));
    match scenes.is_empty() {
        true => format!("{strips} --seeds 0"),
        false => format!(
            "{strips} --scene {} --method {} --seeds {}{size}",
            scenes.join(","),
            options.methods.join(","),
            options.seeds
        ),
    }
}

/// How many runs there will be, and how long they will take.
fn expected(args: &TearChartArgs, options: &Options, [strips_s, cascades_s]: [f64; 2]) -> String {
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
        2 * args.strips.len()
    )
}

/// The seconds of a processor that a run at the step of each method took there, and those of all runs at it,
/// half and a quarter of it: a mesh twice as fine has four times as many edges, and steps that are shorter,
/// by half where the method is explicit.
fn cascades_s(options: &Options) -> f64 {
    let run_s = |scene: CascadeScene, method: &str| {
        let known = RUN_S.iter().find(|(name, _)| *name == method);
        let [trouser, rip] = known.map_or([1.0; 2], |(_, seconds)| *seconds);
        let finer = f64::from(options.cells.unwrap_or(scene.cells())) / f64::from(scene.cells());
        finer.powf(2.5)
            * match scene {
                CascadeScene::Trouser => trouser,
                CascadeScene::Rip => rip,
            }
    };
    let methods = || options.methods.iter();
    let each = options.scenes.iter();
    let each = each.flat_map(|&scene| methods().map(move |method| run_s(scene, method)));
    7.0 * options.seeds as f64 * each.sum::<f64>()
}

/// By method, of trouser tests and rips of their own sizes.
const RUN_S: [(&str, [f64; 2]); 5] = [
    ("verlet", [3.0, 0.6]),
    ("xpbd", [1.2, 0.3]),
    ("implicit", [3.5, 1.4]),
    ("pbd", [1.8, 0.5]),
    ("provot", [10.0, 3.8]),
];
