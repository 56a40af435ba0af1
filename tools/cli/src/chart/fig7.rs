//! `chart fig7`: what splitting vertices takes.

use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::fig7;

use super::files::{Ended, bug, check, interrupted, some_time, tell, write_all};
use super::progress::{self, PARTS, PERCENT};
use super::provenance;
use crate::args::Fig7Args;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::streams::Streams;

/// The seconds that a rip with one cell per side would take, as measured on the machine on which
/// charts were first made. A rip with n cells per side has n² cells, and steps n times as short.
const CELL_S: f64 = 3e-5;

/// Rips the patches, and draws the chart.
pub(super) fn work(
    args: &Fig7Args,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let draw = &args.draw;
    let files = check(draw, None)?;
    let costs: Vec<f64> = args.size.iter().map(|&n| f64::from(n).powi(3)).collect();
    let whole: f64 = costs.iter().sum();
    let (rips, about) = (costs.len(), some_time(CELL_S * whole));
    let words = format!("{rips} rips, some {about}; Ctrl-C ends it without a chart");
    progress::announce(&words, draw, streams);
    let sizes: Vec<String> = args.size.iter().map(u32::to_string).collect();
    let command = format!("tearmesh chart fig7 --size {}", sizes.join(","));
    let bar = progress::bar(PARTS, PERCENT, target);
    let guard = Guard::new();
    let clock = || -> Duration { ThreadTime::now().as_duration() };
    let study = fig7::study(
        &args.size,
        fig7::ROUNDS,
        provenance::of(command, true),
        &clock,
        |rip, part| {
            let before: f64 = costs[..rip].iter().sum();
            bar.set_position((PARTS as f64 * (before + part * costs[rip]) / whole) as u64);
            !guard.is_interrupted()
        },
    );
    bar.finish_and_clear();
    drop(guard);
    let study = study.map_err(|error| bug(error.to_string()))?;
    let study = study.ok_or_else(interrupted)?;
    let svg = fig7::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(draw, &svg, || fig7::csv(&study), &study, streams)?;
    tell(&study.conclusion, &files, draw.quiet, streams)?;
    Ok(Exit::Done)
}
