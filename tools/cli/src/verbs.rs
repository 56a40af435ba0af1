//! The verbs of the command.

mod chart;
mod check;
mod cut;
mod mend;
mod play;
mod render;
mod shell;
mod tear;
mod view;

use std::ffi::OsString;

use crate::args::Verb;
use crate::exit::Exit;
use crate::streams::Streams;

/// Carries out a verb, and gives the exit status. `typed` is for reproducers.
pub(crate) fn run(verb: &Verb, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    match verb {
        Verb::Cut(args) => cut::run(args, typed, streams),
        Verb::Tear(args) => tear::run(args, typed, streams),
        Verb::Mend(args) => mend::run(args, typed, streams),
        Verb::Render(args) => args.look.run(streams, |faults, streams| {
            render::run(args, faults, streams)
        }),
        Verb::View(args) => args.look.run(streams, |faults, streams| match args.play {
            true => play::run(&view::to_play(args)?, faults, streams),
            false => view::run(args, faults, streams),
        }),
        Verb::Play(args) => args
            .look
            .run(streams, |faults, streams| play::run(args, faults, streams)),
        Verb::Check(args) => check::run(args, streams),
        Verb::Chart(args) => chart::run(args, typed, streams),
        Verb::Completions(args) => shell::complete(args, streams),
        Verb::Man(args) => shell::man(args, streams),
    }
}
