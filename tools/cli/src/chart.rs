//! The verb `chart`.

mod all;
mod choice;
mod cut;
mod experiment;
mod fig7;
mod files;
mod pareto;
mod parts;
mod plane;
mod progress;
mod provenance;
mod space;
mod stability;
mod tear;

use indicatif::ProgressDrawTarget;

use crate::args::{ChartArgs, DrawArgs, What};
use crate::exit::Exit;
use crate::streams::Streams;

/// Makes the experiment, draws it, and gives the exit status.
pub(crate) fn run(args: &ChartArgs, streams: &mut Streams<'_>) -> Exit {
    let (draw, done) = match &args.what {
        What::All(args) => return all::run(args, run, streams),
        What::Tear(args) => {
            let draw = &args.draw;
            (draw, tear::work(args, target(draw, streams), streams))
        }
        What::Pareto(args) => {
            let draw = &args.draw;
            (draw, pareto::work(args, target(draw, streams), streams))
        }
        What::Plane(args) => {
            let draw = &args.draw;
            (draw, plane::work(args, target(draw, streams), streams))
        }
        What::Stability(args) => {
            let draw = &args.draw;
            (draw, stability::work(args, target(draw, streams), streams))
        }
        What::Space(args) => {
            let draw = &args.draw;
            (draw, space::work(args, target(draw, streams), streams))
        }
        What::Choice(args) => {
            let draw = &args.draw;
            (draw, choice::work(args, target(draw, streams), streams))
        }
        What::Cut(args) => {
            let draw = &args.draw;
            (draw, cut::work(args, target(draw, streams), streams))
        }
        What::Fig7(args) => {
            let draw = &args.draw;
            (draw, fig7::work(args, target(draw, streams), streams))
        }
    };
    match done {
        Ok(exit) => exit,
        Err((exit, fault)) => streams.fail(&fault, draw.color, exit),
    }
}

/// Where progress is shown: on a terminal alone.
fn target(draw: &DrawArgs, streams: &Streams<'_>) -> ProgressDrawTarget {
    if streams.error_is_terminal && !draw.quiet {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    }
}
