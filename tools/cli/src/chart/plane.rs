//! `chart plane`: the cheapest method at a fixed error, by stiffness and mass ratio.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::plane::{self, Options, Study};
use tearmesh_lab::pool;

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::parts::{self, Part};
use super::progress::{self, PARTS, PERCENT, VISIT_S};
use super::provenance;
use crate::args::PlaneArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::streams::Streams;

/// Makes the experiment, or puts it together of its parts, and draws the map.
pub(super) fn work(
    args: &PlaneArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let options = Options {
        stiffness_n_per_m: args.stiffness.clone(),
        mass_ratios: args.ratio.clone(),
        cells: args.size,
        methods: args.method.clone(),
        cost_max: args.cost_max,
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
    let svg = plane::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || plane::csv(&study), &study, streams)?;
    tell(
        plane::summary(&study).trim_end(),
        &files,
        draw.quiet,
        streams,
    )?;
    Ok(parts::warn(&study.missing, draw, streams))
}

/// A part is a place of the plane.
fn parts(options: &Options) -> Vec<Part> {
    let places = options.stiffness_n_per_m.iter();
    let places = places.flat_map(|&k| options.mass_ratios.iter().map(move |&ratio| (k, ratio)));
    let part = |(k, ratio): (f64, f64)| {
        let alone = Options {
            stiffness_n_per_m: vec![k],
            mass_ratios: vec![ratio],
            ..options.clone()
        };
        Part {
            name: format!("{k:e}-{ratio:e}"),
            command: command(&alone),
        }
    };
    places.map(part).collect()
}

fn made(options: &Options, target: ProgressDrawTarget) -> Ended<Study> {
    let guard = Guard::new();
    let bar = progress::bar(PARTS, PERCENT, target);
    let study = plane::study(
        options,
        provenance::of(command(options), false),
        &|| guard.is_interrupted(),
        |name, part| {
            bar.set_position((PARTS as f64 * part) as u64);
            bar.set_message(name.to_owned());
        },
    );
    bar.finish_and_clear();
    study.ok_or_else(interrupted)
}

/// How many runs there will be, and how long they will take.
fn expected(options: &Options) -> String {
    let (runs, visits) = plane::expected(options);
    let about = some_time(VISIT_S * visits / options.threads.get() as f64);
    format!("{runs} runs, some {about}; Ctrl-C ends it without a chart")
}

/// The command with all that decides its figures.
fn command(options: &Options) -> String {
    let list = |numbers: &[f64]| {
        numbers
            .iter()
            .map(f64::to_string)
            .collect::<Vec<_>>()
            .join(",")
    };
    format!(
        "tearmesh chart plane --stiffness {} --ratio {} --method {} --size {} --cost-max {}",
        list(&options.stiffness_n_per_m),
        list(&options.mass_ratios),
        options.methods.join(","),
        options.cells,
        options.cost_max,
    )
}
