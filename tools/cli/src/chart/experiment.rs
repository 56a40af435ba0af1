//! What the commands of all charts do alike: they say how long it will take, run the experiment or put it
//! together of its parts, and write what came of it, however far it got.

use std::path::PathBuf;

use indicatif::ProgressDrawTarget;
use serde::Serialize;
use tearmesh_lab::Provenance;
use tearmesh_lab::parts::{Divided, Missing};

use super::files::{Ended, bug, check, tell, write, write_all};
use super::parts::{self, Part};
use super::{progress, provenance};
use crate::args::{DrawArgs, PartsArgs};
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::say::Fault;
use crate::streams::Streams;

/// Whether the experiment is to end.
pub(super) type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// What hears the name of what was done last, and the part of all work that is done.
pub(super) type Watch<'a> = &'a mut dyn FnMut(&str, f64);

/// An experiment that is drawn as a chart.
pub(super) trait Experiment {
    /// What comes of it.
    type Study: Serialize;

    /// Whether processor time is measured, so that the processor is part of the provenance.
    fn is_timed(&self) -> bool {
        false
    }

    /// The command with all that decides the figures.
    fn command(&self) -> String;

    /// How many runs there will be, and how long they will take.
    fn expected(&self) -> String;

    /// Runs it, or what there is time for; `None` if nothing was done.
    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Self::Study>>;

    /// The chart; `None` if the drawing library fails.
    fn svg(study: &Self::Study) -> Option<String>;

    /// The figures as a table.
    fn csv(study: &Self::Study) -> String;

    /// What the study says, in words.
    fn summary(study: &Self::Study) -> String;

    /// What was not done.
    fn missing(study: &Self::Study) -> &[Missing];

    /// A file that this chart alone has, if it is wanted.
    fn other_file(&self) -> Option<&PathBuf> {
        None
    }

    /// What that file has; `None` if the drawing library fails.
    fn other(&self, _study: &Self::Study) -> Option<String> {
        None
    }
}

/// An experiment that can be made in parts, on one machine or on several.
pub(super) trait Parted: Experiment<Study: Divided> {
    /// The parts, in the order of a single run.
    fn parts(&self) -> Vec<Part>;
}

/// Runs the experiment, and draws it.
pub(super) fn work<E: Experiment>(
    experiment: &E,
    draw: &DrawArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let files = check(draw, experiment.other_file())?;
    let study = made(experiment, draw, target, streams)?;
    draw_all(experiment, &study, &files, draw, streams)?;
    Ok(interrupted(E::missing(&study), draw, streams))
}

/// Runs the experiment or puts it together of its parts, and draws it; or prints the commands of the parts.
pub(super) fn work_in_parts<E: Parted>(
    experiment: &E,
    args: &PartsArgs,
    draw: &DrawArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let Some(folder) = &args.gather else {
        if args.plan {
            check(draw, experiment.other_file())?;
            return parts::plan(&experiment.parts(), draw, streams);
        }
        return work(experiment, draw, target, streams);
    };
    let files = check(draw, experiment.other_file())?;
    let study = parts::gather(&experiment.parts(), folder, experiment.command())?;
    draw_all(experiment, &study, &files, draw, streams)?;
    Ok(parts::warn(E::missing(&study), draw, streams))
}

/// Runs the experiment until its end or until it is interrupted.
fn made<E: Experiment>(
    experiment: &E,
    draw: &DrawArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<E::Study> {
    let expected = experiment.expected();
    progress::announce(
        &format!("{expected}; Ctrl-C ends it with what is done"),
        draw,
        streams,
    );
    let bar = progress::bar(target);
    let guard = Guard::new();
    let provenance = provenance::of(experiment.command(), experiment.is_timed());
    let study = experiment.study(provenance, &|| guard.is_interrupted(), &mut |name, part| {
        progress::show(&bar, name, part);
    });
    bar.finish_and_clear();
    study?.ok_or_else(|| {
        let message = "interrupted before anything was done; nothing written".to_owned();
        (
            Exit::Interrupted,
            Fault::warning("W-CHART-INTERRUPTED", message),
        )
    })
}

/// Writes all files that are wanted, and says what came out.
fn draw_all<E: Experiment>(
    experiment: &E,
    study: &E::Study,
    files: &[&PathBuf],
    draw: &DrawArgs,
    streams: &mut Streams<'_>,
) -> Ended<()> {
    let undrawn = || bug("the chart cannot be drawn".to_owned());
    let svg = E::svg(study).ok_or_else(undrawn)?;
    write_all(draw, &svg, || E::csv(study), study, streams)?;
    if let Some(path) = experiment.other_file() {
        write(path, &experiment.other(study).ok_or_else(undrawn)?, streams)?;
    }
    tell(E::summary(study).trim(), files, draw.quiet, streams)
}

/// Says what an interruption left out, and gives the exit status that says so.
fn interrupted(missing: &[Missing], draw: &DrawArgs, streams: &mut Streams<'_>) -> Exit {
    if missing.is_empty() {
        return Exit::Done;
    }
    let message = format!("interrupted; missing: {}", parts::names(missing));
    let fault = Fault::warning("W-CHART-INTERRUPTED", message);
    streams.fail(&fault, draw.color, Exit::Interrupted)
}

/// A list as it is typed in a command.
pub(super) fn list<T: ToString>(items: impl IntoIterator<Item = T>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| item.to_string()).collect();
    items.join(",")
}
