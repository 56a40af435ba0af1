//! The verb `chart`.

use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressDrawTarget};
use tearmesh_lab::tear;

use crate::args::{ChartArgs, What};
use crate::exit::Exit;
use crate::interrupt::Guard;
use crate::output;
use crate::say::Fault;
use crate::streams::Streams;

/// Makes the experiment, draws it, and gives the exit status.
pub(crate) fn run(args: &ChartArgs, streams: &mut Streams<'_>) -> Exit {
    match work(args, streams) {
        Ok(exit) => exit,
        Err((exit, fault)) => streams.fail(&fault, args.color, exit),
    }
}

type Ended = Result<Exit, (Exit, Fault)>;

fn work(args: &ChartArgs, streams: &mut Streams<'_>) -> Ended {
    let What::Tear = args.what;
    let files = [Some(&args.output), args.csv.as_ref(), args.json.as_ref()];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    for (i, path) in files.iter().enumerate() {
        let is_it = |other: &&PathBuf| other == path || output::is_same_place(other, path);
        let twice = *path != Path::new("-") && files[..i].iter().any(is_it);
        if twice || (i > 0 && *path == Path::new("-")) {
            let message = format!("`{}` is wanted twice, or is no file", path.display());
            let fault = Fault::error("E-USAGE", message).help("name a file for each");
            return Err((Exit::Usage, fault));
        }
    }
    for path in files.iter().filter(|path| **path != Path::new("-")) {
        output::check(path).map_err(|error| unwritable(path, &error))?;
    }
    let target = if streams.error_is_terminal && !args.quiet {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(2 * tear::CELLS.len() as u64), target);
    let guard = Guard::new();
    let study = tear::study(&tear::CELLS, true, |done| {
        bar.set_position(done as u64);
        !guard.is_interrupted()
    });
    bar.finish_and_clear();
    drop(guard);
    let bug = |message: String| (Exit::Bug, Fault::error("E-BUG-INVARIANT", message));
    let Some(study) = study.map_err(|error| bug(error.to_string()))? else {
        let message = "interrupted; nothing written".to_owned();
        return Err((
            Exit::Interrupted,
            Fault::warning("W-CHART-INTERRUPTED", message),
        ));
    };
    let svg = tear::svg(&study).ok_or_else(|| bug("the chart cannot be drawn".to_owned()))?;
    write(&args.output, &svg, streams)?;
    if let Some(path) = &args.csv {
        write(path, &tear::csv(&study), streams)?;
    }
    if let Some(path) = &args.json {
        let mut json = serde_json::to_string_pretty(&study)
            .expect("a study of strings and finite numbers is JSON");
        json.push('\n');
        write(path, &json, streams)?;
    }
    if args.quiet || args.output == Path::new("-") {
        return Ok(Exit::Done);
    }
    let names: Vec<_> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let names = names.join(", ");
    let said = output::print(streams.output, |out| {
        writeln!(out, "{}\nwrote {names}", study.conclusion)
    });
    said.map_err(|fault| (Exit::Output, fault.help(format!("wrote {names}"))))?;
    Ok(Exit::Done)
}

fn write(path: &Path, text: &str, streams: &mut Streams<'_>) -> Result<(), (Exit, Fault)> {
    if path == Path::new("-") {
        let printed = output::print(streams.output, |out| out.write_all(text.as_bytes()));
        return printed.map(|_| ()).map_err(|fault| (Exit::Output, fault));
    }
    let written = output::write(path, |out| out.write_all(text.as_bytes()));
    written.map_err(|error| unwritable(path, &error))
}

fn unwritable(path: &Path, error: &std::io::Error) -> (Exit, Fault) {
    (Exit::Output, output::cannot_write(path, error))
}
