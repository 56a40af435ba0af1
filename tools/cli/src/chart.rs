//! The verb `chart`.

mod files;
mod pareto;
mod tear;

use indicatif::ProgressDrawTarget;

use crate::args::{ChartArgs, What};
use crate::exit::Exit;
use crate::say::Fault;
use crate::streams::Streams;

/// Makes the experiment, draws it, and gives the exit status.
pub(crate) fn run(args: &ChartArgs, streams: &mut Streams<'_>) -> Exit {
    let target = if streams.error_is_terminal && !args.quiet {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let done = match args.what {
        What::Pareto => pareto::work(args, target, streams),
        What::Tear => match args.pareto.given() {
            None => tear::work(args, target, streams),
            Some(option) => {
                let message = format!("`{option}` goes with `chart pareto`");
                Err((Exit::Usage, Fault::error("E-USAGE", message)))
            }
        },
    };
    match done {
        Ok(exit) => exit,
        Err((exit, fault)) => streams.fail(&fault, args.color, exit),
    }
}
