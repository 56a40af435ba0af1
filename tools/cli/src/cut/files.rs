//! Where a cut reads and writes, and what it refuses to write over.

use std::path::{Path, PathBuf};

use super::Stop;
use crate::args::{CutArgs, Format, Method, Tips};
use crate::say::Fault;
use crate::{Exit, output};

/// Where the mesh goes.
pub(super) enum Destination {
    Nowhere { why: &'static str },
    Output,
    File(PathBuf),
}

impl Destination {
    pub(super) fn of(args: &CutArgs, output_is_terminal: bool) -> Destination {
        match &args.output {
            _ if args.dry_run => Destination::Nowhere {
                why: "dry run, nothing written",
            },
            Some(path) if path == Path::new("-") => Destination::Output,
            Some(path) => Destination::File(path.clone()),
            None if args.format == Format::Json => Destination::Nowhere {
                why: "nothing written",
            },
            None if output_is_terminal => Destination::Nowhere {
                why: "nothing written: name a file with -o OUT",
            },
            None => Destination::Output,
        }
    }

    pub(super) fn name(&self) -> Option<String> {
        match self {
            Destination::Nowhere { .. } => None,
            Destination::Output => Some("-".to_owned()),
            Destination::File(path) => Some(path.display().to_string()),
        }
    }
}

/// Refuses streams and files that are wanted twice, and options that do not go together.
pub(super) fn check(args: &CutArgs) -> Result<(), Stop> {
    let usage = |message: String, help: &str| {
        Err(Stop::new(
            Exit::Usage,
            Fault::error("E-USAGE", message).help(help),
        ))
    };
    let CutArgs {
        input,
        output,
        report,
        format,
        rays_file,
        ..
    } = args;
    let (input, output, report) = (Some(input), output.as_ref(), report.as_ref());
    let is_stream = |path: &PathBuf| path == Path::new("-");
    if *format == Format::Json && output.is_some_and(is_stream) {
        let message = "`-o -` and `--format json` both want standard output".to_owned();
        return usage(
            message,
            "write the mesh to a file, or the report with --report FILE",
        );
    }
    if input.is_some_and(is_stream) && rays_file.as_ref().is_some_and(is_stream) {
        let message = "the mesh and the rays both come from standard input".to_owned();
        return usage(message, "name a file for one of them");
    }
    if report.is_some_and(is_stream) {
        let message = "`--report` takes the name of a file".to_owned();
        return usage(message, "print the report with --format json");
    }
    if args.tips == Tips::Midpoint && args.method != Method::Partition {
        let message = format!(
            "`--tips midpoint` is for the method partition, not {}",
            args.method.name()
        );
        return usage(
            message,
            "leave it out: the paper's methods split vertices between the rays",
        );
    }
    let same = |a: Option<&PathBuf>, b: Option<&PathBuf>| {
        matches!((a, b), (Some(a), Some(b))
            if !is_stream(a) && (a == b || output::is_same_file(a, b)))
    };
    if same(input, output) && !args.in_place {
        let name = output
            .map(|path| path.display().to_string())
            .unwrap_or_default();
        let message = format!("`{name}` is the input, and would be replaced");
        return usage(message, "write to another file, or add --in-place");
    }
    if same(input, report) || same(output, report) {
        let message = "the report would replace the mesh".to_owned();
        return usage(message, "write the report to a file of its own");
    }
    Ok(())
}
