//! `chart all`: every chart, one after the other, into one folder.

use std::path::Path;
use std::time::Instant;

use clap::{Parser, ValueEnum};

use super::files::some_time;
use crate::args::{AllArgs, ChartArgs};
use crate::exit::Exit;
use crate::output;
use crate::say::{Fault, count};
use crate::streams::Streams;

/// The charts, the quick ones first, and what each takes where all is to be small.
const CHARTS: [(&str, &str); 6] = [
    ("stability", "--stiffness 1000"),
    ("cut", "--size 8,12 --cuts 3"),
    ("fig7", "--size 4,8"),
    ("choice", "--scenes 1-3 --seconds 0.03"),
    (
        "tear",
        "--strips 4,6 --scene rip --size 6 --method implicit,pbd --seeds 2",
    ),
    ("pareto", "--scene swing --size 3 --visits-max 100000"),
];

/// Makes each chart as if its command was typed. One that fails is said to, and the next is begun; an
/// interruption ends all. The exit status is that of the first that failed.
pub(super) fn run(
    args: &AllArgs,
    chart: impl Fn(&ChartArgs, &mut Streams<'_>) -> Exit,
    streams: &mut Streams<'_>,
) -> Exit {
    let commands = CHARTS.map(|(name, small)| words(args, name, small));
    if args.plan {
        let lines = commands.map(|words| format!("tearmesh {}\n", words.typed()));
        let printed = output::print(streams.output, |out| {
            out.write_all(lines.concat().as_bytes())
        });
        return match printed {
            Ok(_) => Exit::Done,
            Err(fault) => streams.fail(&fault, args.color, Exit::Output),
        };
    }
    if let Err(error) = std::fs::create_dir_all(&args.output) {
        let fault = output::cannot_write(&args.output, &error);
        return streams.fail(&fault, args.color, Exit::Output);
    }
    let (begun, mut worst, mut failed) = (Instant::now(), Exit::Done, Vec::new());
    for ((name, _), words) in CHARTS.into_iter().zip(commands) {
        let parsed = ChartArgs::try_parse_from(&words.0);
        let exit = match parsed {
            Ok(parsed) => chart(&parsed, streams),
            Err(error) => {
                let message = format!("chart {name} is not understood: {error}");
                streams.fail(
                    &Fault::error("E-BUG-INVARIANT", message),
                    args.color,
                    Exit::Bug,
                )
            }
        };
        if exit != Exit::Done {
            failed.push(name);
            if worst == Exit::Done {
                worst = exit;
            }
        }
        if exit == Exit::Interrupted {
            return exit;
        }
    }
    if !args.quiet {
        let made = count(CHARTS.len() - failed.len(), "chart", "charts");
        let took = some_time(begun.elapsed().as_secs_f64());
        let not = match failed.is_empty() {
            true => String::new(),
            false => format!("; not {}", failed.join(", ")),
        };
        let name = args.output.display();
        let said = output::print(streams.output, |out| {
            writeln!(out, "{made} in {name}, in {took}{not}")
        });
        if let Err(fault) = said {
            return streams.fail(&fault, args.color, Exit::Output);
        }
    }
    worst
}

/// A command, word by word.
struct Words(Vec<std::ffi::OsString>);

impl Words {
    /// As it is typed in a shell.
    fn typed(&self) -> String {
        let quoted = self.0.iter().map(|word| {
            let word = word.to_string_lossy();
            let is_plain = |c: char| c.is_alphanumeric() || "-_./,:=+@%".contains(c);
            match !word.is_empty() && word.chars().all(is_plain) {
                true => word.into_owned(),
                false => format!("'{}'", word.replace('\'', r"'\''")),
            }
        });
        quoted.collect::<Vec<_>>().join(" ")
    }
}

fn words(args: &AllArgs, name: &str, small: &str) -> Words {
    let file = |ending: &str| args.output.join(Path::new(name).with_extension(ending));
    let mut words = vec!["chart".into(), name.into()];
    if args.small {
        words.extend(small.split(' ').map(Into::into));
    }
    for (option, ending) in [("-o", "svg"), ("--csv", "csv"), ("--json", "json")] {
        words.extend([option.into(), file(ending).into_os_string()]);
    }
    if let Some(color) = args.color.to_possible_value() {
        words.extend(["--color".into(), color.get_name().into()]);
    }
    if args.quiet {
        words.push("-q".into());
    }
    Words(words)
}
