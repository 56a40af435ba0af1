//! The arguments of `completions` and `man`.

use clap::Parser;
use clap_complete::Shell;

const EXAMPLES: &str = "\
Examples:
  tearmesh completions bash > ~/.local/share/bash-completion/completions/tearmesh
  tearmesh completions zsh > \"${fpath[1]}/_tearmesh\"";

/// Print a script that completes commands and options in a shell.
#[derive(Debug, Parser)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct CompletionsArgs {
    /// The shell.
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

const MAN_EXAMPLES: &str = "\
Examples:
  tearmesh man | man -l -
  tearmesh man cut > tearmesh-cut.1";

/// Print the manual page of the command or of one verb.
#[derive(Debug, Parser)]
#[command(after_long_help = MAN_EXAMPLES)]
pub(crate) struct ManArgs {
    /// The verb, as in `cut` or `chart fig7`.
    pub(crate) verb: Vec<String>,
}
