//! `chart tear`: the force that tears strips.

use indicatif::{ProgressBar, ProgressDrawTarget};
use tearmesh_lab::tear;

use super::files::{Ended, bug, check, interrupted, tell, write_all};
use crate::args::DrawArgs;
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::streams::Streams;

/// Tears them, and draws the chart.
pub(super) fn work(
    args: &DrawArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let files = check(args, None)?;
    let bar = ProgressBar::with_draw_target(Some(2 * tear::CELLS.len() as u64), target);
    let guard = Guard::new();
    let study = tear::study(&tear::CELLS, true, |done| {
        bar.set_position(done as u64);
        !guard.is_interrupted()
    });
    bar.finish_and_clear();
    drop(guard);
    let Some(study) = study.map_err(|error| bug(error.to_string()))? else {
        return Err(interrupted());
    };
    let svg = tear::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write_all(args, &svg, || tear::csv(&study), &study, streams)?;
    tell(&study.conclusion, &files, args.quiet, streams)?;
    Ok(Exit::Done)
}
