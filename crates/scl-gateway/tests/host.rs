//! A host: its network, its runtime folder, and the programs that run there.

use crate::namespace::Namespace;
use crate::player::Player;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// One host of a system.
pub(crate) struct Host {
    pub(crate) name: String,
    pub(crate) address: String,
    /// Environment variables of its programs.
    pub(crate) environment: Vec<(String, String)>,
    namespace: Namespace,
    folder: TempDir,
}

impl Host {
    pub(crate) fn new(name: &str, address: String, namespace: Namespace) -> Self {
        // Short, for the paths of sockets.
        let folder = TempDir::with_prefix("scl").unwrap();
        Self { name: name.to_owned(), address, environment: Vec::new(), namespace, folder }
    }

    /// Its runtime folder.
    pub(crate) fn runtime_dir(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    /// The address and port of its gateway.
    pub(crate) fn socket_address(&self) -> String {
        format!("{}:7447", self.address)
    }

    /// Runs a program that changes its network.
    pub(crate) fn run(&self, line: &str) {
        self.namespace.run(line);
    }

    /// A program that will run on this host.
    pub(crate) fn command(&self, program: impl AsRef<Path>) -> Command {
        // Inside, because `LD_PRELOAD` would have its effect on the way there.
        let mut command = self.namespace.command("env");
        command.args(self.environment.iter().map(|(name, value)| format!("{name}={value}"))).arg(program.as_ref());
        // `SCL_LOG` is that of the test.
        for name in ["SCL_SYSTEM", "SCL_TRANSPORT", "SCL_STATS"] {
            command.env_remove(name);
        }
        command.env("SCL_RUNTIME_DIR", self.runtime_dir());
        command
    }

    /// Starts a component of a system on this host, whatever its launch file says.
    pub(crate) fn play(&self, component: &str, plan: &Path) -> Player {
        Player::start(self.command(std::env::current_exe().unwrap()), component, plan)
    }
}
