//! The record of a run: the table, and beside it commit, compiler and CPU.

use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

use tearmesh_lab::experiment::processor;

/// The lines above a table.
pub(crate) fn heading(subcommand: &str) -> String {
    format!(
        "tearmesh-bench {subcommand}\ncommit    {}\ncompiler  {}\nCPU       {}\n",
        commit(),
        said_by("rustc", &["--version"]),
        processor()
    )
}

/// Writes a report to the file of this CPU and subcommand.
pub(crate) fn keep(subcommand: &str, report: &str) -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("record")
        .join(folder_name(&processor()));
    fs::create_dir_all(&folder)?;
    fs::write(folder.join(format!("{subcommand}.txt")), report)
}

/// The commit that is checked out, and whether files differ from it (records aside).
fn commit() -> String {
    let commit = said_by("git", &["rev-parse", "--short=12", "HEAD"]);
    let changes = [
        "status",
        "--porcelain",
        "--untracked-files=no",
        ":/",
        ":(exclude,top)tools/bench/record",
    ];
    match &*said_by("git", &changes) {
        "" | UNKNOWN => commit,
        _ => format!("{commit} with changes"),
    }
}

const UNKNOWN: &str = "unknown";

/// What a program prints, or `unknown` if it cannot be run.
fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output();
    match output {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        }
        _ => UNKNOWN.to_owned(),
    }
}

/// `Intel(R) Xeon(R) Processor` as `intel-xeon-processor`.
fn folder_name(cpu: &str) -> String {
    let plain = cpu.to_lowercase().replace("(r)", "").replace("(tm)", "");
    let words = plain
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}
