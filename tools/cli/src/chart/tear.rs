//! `chart tear`: the force that tears strips.

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressDrawTarget};
use tearmesh_lab::tear;

use super::files::{Ended, bug, check, json, tell, write};
use crate::args::ChartArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// Tears them, and draws the chart.
pub(super) fn work(
    args: &ChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let files = [Some(&args.output), args.csv.as_ref(), args.json.as_ref()];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    check(&files)?;
    let bar = ProgressBar::with_draw_target(Some(2 * tear::CELLS.len() as u64), target);
    let guard = Guard::new();
    let study = tear::study(&tear::CELLS, true, |done| {
        bar.set_position(done as u64);
        !guard.is_interrupted()
    });
    bar.finish_and_clear();
    drop(guard);
    let Some(study) = study.map_err(|error| bug(error.to_string()))? else {
        let message = "interrupted; nothing written".to_owned();
        return Err((
            Exit::Interrupted,
            Fault::warning("W-CHART-INTERRUPTED", message),
        ));
    };
    let svg = tear::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write(&args.output, &svg, streams)?;
    if let Some(path) = &args.csv {
        write(path, &tear::csv(&study), streams)?;
    }
    if let Some(path) = &args.json {
        write(path, &json(&study), streams)?;
    }
    tell(&study.conclusion, &files, args.quiet, streams)?;
    Ok(Exit::Done)
}
