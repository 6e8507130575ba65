//! `scl stop`: stops components that `scl run` has started, or all of them.

use crate::request::{RequestArguments, request};
use clap::Args;
use scl_run::control::Command;
use std::process::ExitCode;

/// Stop components that `scl run` has started, and wait until they have ended.
///
/// Without a name, everything is stopped and each `scl run` of the system ends. A component that is stopped by its name
/// is not restarted, whatever its `restart` says; the others keep running.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl stop                        everything
  scl stop sensor                 one component
  scl stop --system rover         where several systems run

Exit code: 0 stopped, 1 something was not stopped, 2 nothing was done.")]
pub(crate) struct StopArguments {
    /// The components; all if none is named.
    #[arg(value_name = "COMPONENT")]
    components: Vec<String>,
    #[command(flatten)]
    request: RequestArguments,
}

/// The body of `scl stop`.
pub(crate) fn stop(arguments: &StopArguments) -> ExitCode {
    request(Command::Stop, &arguments.components, false, &arguments.request)
}
