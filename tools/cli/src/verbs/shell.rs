//! The verbs `completions` and `man`, by clap's generators.

use clap::{Command, CommandFactory as _};

use crate::args::{Args, CompletionsArgs, ManArgs};
use crate::exit::Exit;
use crate::output;
use crate::say::{Color, Fault};
use crate::streams::Streams;

/// Prints what a shell needs to complete the command.
pub(crate) fn complete(args: &CompletionsArgs, streams: &mut Streams<'_>) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "tearmesh", &mut script);
    print(&script, streams)
}

/// Prints a page of the manual.
pub(crate) fn man(args: &ManArgs, streams: &mut Streams<'_>) -> Exit {
    let Some(command) = page_of(&args.verb) else {
        let message = format!("there is no verb `{}`", args.verb.join(" "));
        let fault = Fault::error("E-USAGE", message).help("`tearmesh help` lists the verbs");
        return streams.fail(&fault, Color::Auto, Exit::Usage);
    };
    let mut page = Vec::new();
    let source = concat!("tearmesh ", env!("CARGO_PKG_VERSION"));
    let made = clap_mangen::Man::new(command).source(source);
    let made = made.render(&mut page);
    made.expect("memory takes everything");
    print(&page, streams)
}

/// The command, or the verb below it. Once built, it knows the name of its page.
fn page_of(verb: &[String]) -> Option<Command> {
    let mut command = Args::command();
    command.build();
    for word in verb {
        command = command.find_subcommand(word)?.clone();
    }
    Some(command)
}

fn print(text: &[u8], streams: &mut Streams<'_>) -> Exit {
    let printed = output::print(streams.output, |out| out.write_all(text));
    let printed = printed.map(|_| Exit::Done);
    printed.unwrap_or_else(|fault| streams.fail(&fault, Color::Auto, Exit::Output))
}
