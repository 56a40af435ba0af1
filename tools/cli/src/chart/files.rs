//! The files of a chart: all can be written before it is begun.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::args::DrawArgs;
use crate::exit::Exit;
use crate::output;
use crate::say::Fault;
use crate::streams::Streams;

/// How a part of the work ended.
pub(super) type Ended<T> = Result<T, (Exit, Fault)>;

/// The files of a chart, with one that it alone has; all are places of their own that can be written,
/// and only the first may be standard output.
pub(super) fn check<'a>(args: &'a DrawArgs, other: Option<&'a PathBuf>) -> Ended<Vec<&'a PathBuf>> {
    let files = [
        Some(&args.output),
        args.csv.as_ref(),
        args.json.as_ref(),
        other,
    ];
    let files: Vec<&PathBuf> = files.into_iter().flatten().collect();
    for (i, path) in files.iter().enumerate() {
        let is_it = |other: &&PathBuf| other == path || output::is_same_place(other, path);
        let twice = *path != Path::new("-") && files[..i].iter().any(is_it);
        if twice || (i > 0 && *path == Path::new("-")) {
            let message = format!("`{}` is named twice, or is not a file", path.display());
            let fault = Fault::error("E-USAGE", message).help("name a file for each");
            return Err((Exit::Usage, fault));
        }
    }
    for path in files.iter().filter(|path| **path != Path::new("-")) {
        output::check(path).map_err(|error| unwritable(path, &error))?;
    }
    Ok(files)
}

/// Writes chart, table and figures, as far as they are wanted.
pub(super) fn write_all(
    args: &DrawArgs,
    svg: &str,
    csv: impl FnOnce() -> String,
    study: &impl Serialize,
    streams: &mut Streams<'_>,
) -> Ended<()> {
    write(&args.output, svg, streams)?;
    if let Some(path) = &args.csv {
        write(path, &csv(), streams)?;
    }
    if let Some(path) = &args.json {
        write(path, &json(study), streams)?;
    }
    Ok(())
}

/// Writes a text.
pub(super) fn write(path: &Path, text: &str, streams: &mut Streams<'_>) -> Ended<()> {
    if path == Path::new("-") {
        let printed = output::print(streams.output, |out| out.write_all(text.as_bytes()));
        return printed.map(|_| ()).map_err(|fault| (Exit::Output, fault));
    }
    let written = output::write(path, |out| out.write_all(text.as_bytes()));
    written.map_err(|error| unwritable(path, &error))
}

/// A study as JSON.
fn json(study: &impl Serialize) -> String {
    let mut json =
        serde_json::to_string_pretty(study).expect("a study of strings and numbers is JSON");
    json.push('\n');
    json
}

/// Says what came out, and what was written; nothing where the chart is on standard output.
pub(super) fn tell(
    words: &str,
    files: &[&PathBuf],
    is_quiet: bool,
    streams: &mut Streams<'_>,
) -> Ended<()> {
    if is_quiet || files.first().is_some_and(|path| *path == Path::new("-")) {
        return Ok(());
    }
    let names: Vec<_> = files
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let names = names.join(", ");
    let said = output::print(streams.output, |out| {
        writeln!(out, "{words}\nwrote {names}")
    });
    let said = said.map_err(|fault| (Exit::Output, fault.help(format!("wrote {names}"))));
    said.map(|_| ())
}

/// A duration in words, rounded up.
pub(super) fn some_time(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{} s", s.ceil().max(1.0)),
        s => format!("{} min", (s / 60.0).ceil()),
    }
}

/// Our own bug.
pub(super) fn bug(message: String) -> (Exit, Fault) {
    (Exit::Bug, Fault::error("E-BUG-INVARIANT", message))
}

fn unwritable(path: &Path, error: &std::io::Error) -> (Exit, Fault) {
    (Exit::Output, output::cannot_write(path, error))
}
