//! What the commands that look at a running system share: which system.

use clap::Args;

/// Which system a command looks at.
#[derive(Debug, Clone, Args)]
pub(crate) struct SystemArgument {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
}

impl SystemArgument {
    /// Its name, if the user gives one.
    pub(crate) fn name(&self) -> Option<&str> {
        self.system.as_deref()
    }
}
