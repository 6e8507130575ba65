//! What the commands that look at a running system share: which system, and how they fail.

use clap::Args;
use scl_observe::System;
use scl_terminal::{Problem, print_err};
use std::process::ExitCode;

/// Exit code: the command could not do its work.
pub(crate) const COULD_NOT_DO: u8 = 2;

/// Which system a command looks at.
#[derive(Debug, Clone, Args)]
pub(crate) struct SystemArgument {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    pub(crate) system: Option<String>,
}

impl SystemArgument {
    /// Finds the system.
    ///
    /// # Errors
    /// Those of [`System::find`].
    pub(crate) fn find(&self) -> Result<System, Problem> {
        System::find(self.system.as_deref())
    }
}

/// The exit code of a command; a problem is printed and means that the command could not do its work.
pub(crate) fn exit_code(result: Result<ExitCode, Problem>) -> ExitCode {
    result.unwrap_or_else(|problem| {
        print_err(&problem.to_string());
        ExitCode::from(COULD_NOT_DO)
    })
}
