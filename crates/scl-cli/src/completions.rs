//! `scl completions`: words that a shell offers after `scl`.

mod names;

use clap::{Args, Command};
use clap_complete::{Shell, generate};
use names::add_names;
use scl_terminal::print_out;
use std::process::ExitCode;

/// Print a script with which a shell completes the commands and options of `scl`.
///
/// In bash, zsh and fish, the names of gates and components are those of the running system.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl completions bash > ~/.local/share/bash-completion/completions/scl
  scl completions zsh > ~/.zfunc/_scl         in a folder of $fpath
  scl completions fish > ~/.config/fish/completions/scl.fish")]
pub(crate) struct CompletionsArguments {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
}

/// The body of `scl completions`, for this command line.
pub(crate) fn print_completions(arguments: &CompletionsArguments, command_line: &Command) -> ExitCode {
    // Leave out hidden commands: they are internal, but the bash generator would offer them.
    let visible = command_line.get_subcommands().filter(|command| !command.is_hide_set()).cloned();
    let mut command_line = Command::new("scl").version(env!("CARGO_PKG_VERSION")).subcommands(visible);
    let mut script = Vec::new();
    generate(arguments.shell, &mut command_line, "scl", &mut script);
    let script = String::from_utf8_lossy(&script).into_owned();
    print_out(&add_names(arguments.shell, &command_line, script));
    ExitCode::SUCCESS
}
