//! What the commands that look at a running system share: which system.

use clap::Args;
use scl::runtime_dir::RuntimeDir;
use scl_observe::System;
use scl_terminal::{Problem, choose_system, named_system};
use std::ffi::OsString;

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

    /// Whether the user names one.
    ///
    /// # Errors
    /// Those of [`named_system`].
    pub(crate) fn is_named(&self) -> Result<bool, Problem> {
        named_system(self.system.as_deref(), &variable).map(|name| name.is_some())
    }

    /// The name of the system; `here` is that of the working folder.
    ///
    /// # Errors
    /// Those of [`choose_system`].
    pub(crate) fn choose(&self, here: &dyn Fn() -> Option<String>) -> Result<Option<String>, Problem> {
        let runtime_dir = RuntimeDir::existing(&variable).ok().flatten();
        let running = runtime_dir.and_then(|dir| dir.running_systems().ok()).unwrap_or_default();
        choose_system(self.system.as_deref(), &variable, &running, here)
    }

    /// Finds the system, or waits for its first start if it is named.
    ///
    /// # Errors
    /// Those of [`System::find_or_await`].
    pub(crate) fn find_or_await(&self) -> Result<System, Problem> {
        System::find_or_await(self.system.as_deref())
    }

    /// Finds the system that is named, or all that run.
    ///
    /// # Errors
    /// Those of [`System::find_all`].
    pub(crate) fn find_all(&self) -> Result<Vec<System>, Problem> {
        System::find_all(self.system.as_deref())
    }
}

fn variable(name: &str) -> Option<OsString> {
    std::env::var_os(name)
}
