//! Measurements of tearmesh beside other programs, each in one run on one machine.
//!
//! ```console
//! $ cargo run --release --manifest-path tools/bench/Cargo.toml -- read
//! $ cargo run --release --manifest-path tools/bench/Cargo.toml -- write --rounds 9 --record
//! ```
//!
//! | subcommand | measures |
//! |---|---|
//! | `read` | OBJ bytes in memory to a document in memory, beside five crates and a plain loop |
//! | `write` | a document to OBJ bytes in memory, beside `{}` and shortest digits |
//!
//! | option | meaning |
//! |---|---|
//! | `--faces N` | about how many faces each file has (1,000,000) |
//! | `--rounds N` | how often everything is measured (7); the table has medians |
//! | `--only WORD` | only contestants and files whose name holds the word, for a profiler |
//! | `--record` | also writes the table to `record/<CPU>/<subcommand>.txt` |
//!
//! Everything runs on one thread. In each round every contestant runs once, so a slow spell of the
//! machine falls on all of them: trust the ratios, not the MB/s. They share one allocator, too, and
//! what one leaves behind, the next starts from; so ratios differ by some tenths with other
//! company (`--only`). A record names the commit, the compiler and the CPU.

mod measure;
mod options;
mod read;
mod record;
mod rivals;
mod sheet;
mod write;

use std::process::ExitCode;

use crate::options::Options;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let subcommand = arguments.next().unwrap_or_default();
    let run: fn(&Options) -> String = match &*subcommand {
        "read" => read::run,
        "write" => write::run,
        _ => {
            eprintln!("expected a subcommand: read or write (see the top of main.rs)");
            return ExitCode::FAILURE;
        }
    };
    let options = match Options::parse(arguments) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    };
    let report = format!("{}\n{}", record::heading(&subcommand), run(&options));
    print!("{report}");
    if options.record
        && let Err(error) = record::keep(&subcommand, &report)
    {
        eprintln!("cannot record: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
