//! The option `--system`, which the commands that work with a running system share.

use clap::Args;

/// Which system a command looks at.
#[derive(Debug, Clone, Args)]
pub(crate) struct SystemArgument {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
}

impl SystemArgument {
    /// Returns the name of the system, if the user has given one.
    pub(crate) fn name(&self) -> Option<&str> {
        self.system.as_deref()
    }
}
