//! The reproducer of a bug of ours: the input as OBJ, with the command and the broken invariants in
//! comments. The same command on this file shows the bug again.

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::Path;

use crate::input::Input;
use crate::output;
use crate::say::Fault;

const NAME: &str = "tearmesh-reproducer.obj";

/// Says that an invariant broke, and writes the reproducer into the current folder.
pub(crate) fn report(args: &[OsString], input: Option<&Input>, broken: &[String]) -> Fault {
    if cfg!(fuzzing) {
        // The fuzzer keeps the input: no file is to be written.
        panic!("{}", broken.join("; "));
    }
    let written = output::write(Path::new(NAME), |out| reproducer(out, args, input, broken));
    let with = match written {
        Ok(()) => format!(", with the file `{NAME}`"),
        Err(fault) => format!(" ({})", fault.message),
    };
    let help = format!("this is a bug in tearmesh: please report it{with}");
    Fault::error("E-BUG-INVARIANT", broken.join("; ")).help(help)
}

fn reproducer(
    out: &mut dyn Write,
    args: &[OsString],
    input: Option<&Input>,
    broken: &[String],
) -> io::Result<()> {
    let version = env!("CARGO_PKG_VERSION");
    writeln!(out, "# tearmesh {version} broke an invariant")?;
    let words = args.iter().skip(1).map(|arg| arg.to_string_lossy());
    let command: Vec<_> = words.collect();
    let command = command.join(" ").replace(['\n', '\r'], " ");
    writeln!(out, "# command: tearmesh {command}")?;
    for line in broken.iter().flat_map(|text| text.lines()) {
        writeln!(out, "# {line}")?;
    }
    if let Some(input) = input {
        let lost = |_| io::Error::other("the input cannot be read again");
        io::copy(&mut input.open().map_err(lost)?, out)?;
    }
    Ok(())
}
