//! The command `tearmesh`.

mod closed;

use std::io::{self, BufWriter, IsTerminal};
use std::process::ExitCode;

use tearmesh_cli::{Streams, abandon_output, interrupt, run};

fn main() -> ExitCode {
    // An interrupted run leaves no half of a file behind; a simulation ends after its step and
    // is saved. If the handler cannot be
    // installed, the system's own ends the program just as well.
    let _ = ctrlc::set_handler(|| {
        if !interrupt() {
            abandon_output();
            std::process::exit(130);
        }
    });
    let (stdin, stdout, stderr) = (io::stdin(), io::stdout(), io::stderr());
    let (mut open, mut closed) = (BufWriter::new(stdout.lock()), closed::Closed);
    let streams = Streams {
        output_is_terminal: stdout.is_terminal(),
        error_is_terminal: stderr.is_terminal(),
        input: &mut stdin.lock(),
        output: match closed::is_output() {
            true => &mut closed,
            false => &mut open,
        },
        error: &mut stderr.lock(),
    };
    run(std::env::args_os(), streams).into()
}
