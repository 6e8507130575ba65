//! The command `scl-gateway`, or `scl gateway`.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod check;
mod files;
mod log;
mod make_keys;
mod one_thread;
mod run;

use clap::{Parser, Subcommand};
use scl_terminal::finish_output;
use std::process::ExitCode;

/// Connect the components of a system that run on several hosts.
#[derive(Parser)]
#[command(name = "scl gateway", version, arg_required_else_help = true)]
#[command(after_help = "\
Examples:
  scl gateway keys                make certificates for the hosts of ./launch.yaml
  scl gateway check --host board  on the board: see whether its gateway can run
  scl run --host board            on the board: start its components and its gateway

`scl run --host` starts the gateway automatically. docs/deploy.md is about certificates and services.

Exit code: 0 fine, 1 something is wrong with the certificates, 2 could not run.")]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::CheckArguments),
    Keys(make_keys::KeysArguments),
    Run(run::RunArguments),
}

fn main() -> ExitCode {
    finish_output(match CommandLine::parse().command {
        Command::Check(arguments) => check::check(&arguments),
        Command::Keys(arguments) => make_keys::make_keys(&arguments),
        Command::Run(arguments) => run::run(&arguments),
    })
}
