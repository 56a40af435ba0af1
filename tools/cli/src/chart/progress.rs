//! How long a chart will take, and how far it is.

use std::num::NonZero;

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

/// The parts of a bar.
const PARTS: f64 = 1000.0;

/// A bar with a percentage, the time that is left, and a message behind it.
pub(super) fn bar(target: ProgressDrawTarget) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(PARTS as u64), target);
    match ProgressStyle::with_template("{wide_bar} {percent} % {eta} {msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Shows the part of all work that is done, and the name of what was done last.
pub(super) fn show(bar: &ProgressBar, name: &str, part: f64) {
    bar.set_position((PARTS * part) as u64);
    bar.set_message(name.to_owned());
}

/// Which threads runs share, in words.
pub(super) fn on_threads(threads: NonZero<usize>) -> String {
    match threads.get() {
        1 => "on one thread".to_owned(),
        n => format!("on {n} threads"),
    }
}
