//! `chart cut`: what cuts take, and how far their seams are off.

use std::num::NonZero;
use std::path::Path;
use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::cut::{self, Options, Rival};

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::progress;
use super::provenance;
use crate::args::CutChartArgs;
use crate::exit::Exit;
use crate::input::cannot_read;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// A cut of a face, with all that is measured of it, took so many seconds on the machine that charts were
/// first made on.
const FACE_S: f64 = 2e-6;

/// Cuts the sheets, and draws the chart.
pub(super) fn work(
    args: &CutChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let rivals = match &args.record {
        Some(path) => read(path)?,
        None => Vec::new(),
    };
    let options = Options {
        cells: args.size.clone(),
        cuts: args.cuts,
        // Times of cuts beside each other are those of a memory that both wait for.
        threads: NonZero::<usize>::MIN,
    };
    let cuts = cut::cuts(&options);
    let faces: f64 = args.size.iter().map(|&n| 2.0 * f64::from(n).powi(2)).sum();
    let each = cuts as f64 / args.size.len() as f64;
    let about = some_time(FACE_S * faces * each);
    let words = format!("{cuts} cuts, some {about}; Ctrl-C ends it without a chart");
    progress::announce(&words, draw, streams);
    let bar = progress::bar(cuts as u64, "{pos}/{len} {eta}", target);
    let guard = Guard::new();
    let sizes: Vec<String> = args.size.iter().map(u32::to_string).collect();
    let mut command = format!(
        "tearmesh chart cut --size {} --cuts {}",
        sizes.join(","),
        args.cuts
    );
    if args.record.is_some() {
        command += " --record …";
    }
    let clock = || -> Duration { ThreadTime::now().as_duration() };
    let study = cut::study(
        &options,
        provenance::of(command, true),
        rivals,
        Some(&clock),
        &|| guard.is_interrupted(),
        |name| {
            bar.inc(1);
            bar.set_message(name.to_owned());
        },
    );
    bar.finish_and_clear();
    drop(guard);
    let study = study.ok_or_else(interrupted)?;
    let svg = cut::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || cut::csv(&study), &study, streams)?;
    tell(cut::summary(&study).trim_end(), &files, draw.quiet, streams)?;
    Ok(Exit::Done)
}

/// The rows of a record.
fn read(path: &Path) -> Ended<Vec<Rival>> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path);
    let text = text.map_err(|error| (Exit::Input, cannot_read(&name, &error)))?;
    cut::rivals(&text).map_err(|error| {
        let message = format!("{name} is no record of cuts: {error}");
        let help = "one that `tearmesh-bench cut` wrote, as in tools/bench/record";
        (
            Exit::Input,
            Fault::error("E-CHART-RECORD", message).help(help),
        )
    })
}
