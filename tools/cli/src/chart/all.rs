//! `chart all`: every chart, one after the other, into one folder.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Parser, ValueEnum};

use super::files::some_time;
use crate::args::{AllArgs, ChartArgs};
use crate::exit::Exit;
use crate::output;
use crate::say::{Fault, count};
use crate::streams::Streams;

/// A chart among all.
struct Chart {
    name: &'static str,
    /// The options with which it is small.
    small: &'static str,
    /// Whether it can be made in parts. Charts of times compare runs of one machine, and stability takes half
    /// a minute.
    is_divided: bool,
    /// Whether a second chart is drawn by CPU time, of the runs as they are: repeated alone, each six times,
    /// they would take an hour.
    is_timed: bool,
}

const fn chart(name: &'static str, small: &'static str, is_divided: bool) -> Chart {
    Chart {
        name,
        small,
        is_divided,
        is_timed: false,
    }
}

/// The charts, the quick ones first.
const CHARTS: [Chart; 8] = [
    chart("stability", "--stiffness 1000", false),
    chart("cut", "--size 8,12 --cuts 3", false),
    chart("fig7", "--size 4,8", false),
    chart("choice", "--scenes 1-3 --seconds 0.03", true),
    Chart {
        is_timed: true,
        ..chart("pareto", "--scene swing --size 3 --visits-max 100000", true)
    },
    chart(
        "plane",
        "--stiffness 1000,10000 --ratio 1,0.01 --size 4 --method verlet,xpbd-1",
        true,
    ),
    chart(
        "space",
        "--scene hang,slit --size 2,4 --finest 8 --method verlet,xpbd-4 --part 1,0.5",
        true,
    ),
    chart(
        "tear",
        "--strips 4,6 --scene rip --size 6 --method implicit,pbd --seeds 2",
        true,
    ),
];

/// Makes each chart as if its command was typed, prints the commands of its parts, or puts it together of them.
/// One that fails is said to, and the next is begun; an interruption ends all. The exit status is that of the
/// first that failed.
pub(super) fn run(
    args: &AllArgs,
    make: impl Fn(&ChartArgs, &mut Streams<'_>) -> Exit,
    streams: &mut Streams<'_>,
) -> Exit {
    if let Err(error) = std::fs::create_dir_all(&args.output) {
        let fault = output::cannot_write(&args.output, &error);
        return streams.fail(&fault, args.color, Exit::Output);
    }
    let (begun, mut worst, mut failed) = (Instant::now(), Exit::Done, Vec::new());
    let mut charts = CHARTS;
    if args.plan {
        // Those who share the work are all at it until the end, if what takes longest is begun first.
        charts.reverse();
    }
    for chart in &charts {
        let exit = one(chart, args, &make, streams);
        if exit != Exit::Done {
            failed.push(chart.name);
            if worst == Exit::Done {
                worst = exit;
            }
        }
        if exit == Exit::Interrupted {
            return exit;
        }
    }
    if args.quiet || args.plan {
        return worst;
    }
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
    match said {
        Ok(_) => worst,
        Err(fault) => streams.fail(&fault, args.color, Exit::Output),
    }
}

/// Does with one chart what is wanted of all.
fn one(
    chart: &Chart,
    args: &AllArgs,
    make: &impl Fn(&ChartArgs, &mut Streams<'_>) -> Exit,
    streams: &mut Streams<'_>,
) -> Exit {
    let mut words = words(args, chart);
    if args.plan && !chart.is_divided {
        let line = format!("tearmesh {}\n", typed(&words));
        let printed = output::print(streams.output, |out| out.write_all(line.as_bytes()));
        return match printed {
            Ok(_) => Exit::Done,
            Err(fault) => streams.fail(&fault, args.color, Exit::Output),
        };
    }
    if args.gather && !chart.is_divided {
        return is_there(&file(args, chart, "json"), args, streams);
    }
    if args.plan {
        words.push("--plan".into());
    }
    if args.gather {
        words.extend([
            "--gather".into(),
            file(args, chart, "parts").into_os_string(),
        ]);
    }
    match ChartArgs::try_parse_from(&words) {
        Ok(parsed) => make(&parsed, streams),
        Err(error) => {
            let message = format!("chart {} is not understood: {error}", chart.name);
            let fault = Fault::error("E-BUG-INVARIANT", message);
            streams.fail(&fault, args.color, Exit::Bug)
        }
    }
}

/// Whether a chart that is made in one go is there.
fn is_there(json: &Path, args: &AllArgs, streams: &mut Streams<'_>) -> Exit {
    if json.exists() {
        return Exit::Done;
    }
    let message = format!("{} is missing", json.display());
    let help = "run its line of --plan again";
    let fault = Fault::warning("W-CHART-PARTS", message).help(help);
    streams.fail(&fault, args.color, Exit::Simulation)
}

fn file(args: &AllArgs, chart: &Chart, ending: &str) -> PathBuf {
    args.output
        .join(Path::new(chart.name).with_extension(ending))
}

/// A command as it is typed in a shell.
fn typed(words: &[OsString]) -> String {
    let words = words.iter().map(|word| word.to_string_lossy());
    let words: Vec<_> = words.collect();
    // No file has a name that no shell can be told.
    shlex::try_join(words.iter().map(AsRef::as_ref)).unwrap_or_else(|_| words.join(" "))
}

/// The command of a chart, word by word.
fn words(args: &AllArgs, chart: &Chart) -> Vec<OsString> {
    let mut words: Vec<OsString> = vec!["chart".into(), chart.name.into()];
    if args.small {
        words.extend(chart.small.split(' ').map(Into::into));
    }
    for (option, ending) in [("-o", "svg"), ("--csv", "csv"), ("--json", "json")] {
        words.extend([option.into(), file(args, chart, ending).into_os_string()]);
    }
    if chart.is_timed {
        let name = format!("{}-time.svg", chart.name);
        let times = args.output.join(name).into_os_string();
        words.extend(["--time-chart".into(), times]);
        words.extend(["--repeats".into(), "0".into()]);
    }
    if let Some(color) = args.color.to_possible_value() {
        words.extend(["--color".into(), color.get_name().into()]);
    }
    if args.quiet {
        words.push("-q".into());
    }
    words
}
