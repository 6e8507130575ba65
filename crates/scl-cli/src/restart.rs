//! `scl restart`: stops components that `scl run` has started, and starts them again.

use crate::request::{RequestArguments, request};
use clap::Args;
use scl_run::control::Command;
use std::process::ExitCode;

/// Build components that `scl run` has started and restart them, while the others keep running.
///
/// What `scl run` has built for them is built first, while the old processes run. If that fails, they keep running.
/// Waits until their new processes run; for components with `ready_within` in the launch file, until they are ready.
/// Components that have ended are started.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl restart sensor
  scl restart sensor gps --system rover

Exit code: 0 restarted, 1 a build failed and the old process keeps running, or a component failed again, 2 nothing was done.")]
pub(crate) struct RestartArguments {
    /// The components.
    #[arg(value_name = "COMPONENT", required = true)]
    components: Vec<String>,
    /// Start the programs as they are, without building them first.
    #[arg(long)]
    no_build: bool,
    #[command(flatten)]
    request: RequestArguments,
}

/// The body of `scl restart`.
pub(crate) fn restart(arguments: &RestartArguments) -> ExitCode {
    request(Command::Restart, &arguments.components, !arguments.no_build, &arguments.request)
}
