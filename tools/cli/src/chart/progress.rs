//! How long a chart will take, and how far it is.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::DrawArgs;
use crate::streams::Streams;

/// A visit of an edge took some 9 ns on the machine that charts were first made on.
pub(super) const VISIT_S: f64 = 9e-9;

/// Says what there is to do and how long that takes, unless nothing is to be said.
pub(super) fn announce(words: &str, draw: &DrawArgs, streams: &mut Streams<'_>) {
    if !draw.quiet {
        // Nowhere is left to say it if standard error is closed.
        let _ = writeln!(streams.error, "{words}");
    }
}

/// A bar of so many parts, with `numbers` and a message behind it.
pub(super) fn bar(parts: u64, numbers: &str, target: ProgressDrawTarget) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(parts), target);
    match ProgressStyle::with_template(&format!("{{wide_bar}} {numbers} {{msg}}")) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// The parts of a bar whose numbers are a percentage and the time that is left.
pub(super) const PARTS: u64 = 1000;

/// The numbers of a bar of [`PARTS`].
pub(super) const PERCENT: &str = "{percent} % {eta}";
