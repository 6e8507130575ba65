//! What the tests across processes share: programs that are told what to do line by line, and a folder to meet in.

pub mod fuzz;
mod process;
mod python;
mod script;

pub use process::{HANGS, Process};
pub use python::python_with_pyzmq;
pub use script::{Commands, say, stand_still};

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A runtime folder of its own for one test, with a path short enough for any socket.
pub struct Place {
    folder: TempDir,
    transport: &'static str,
}

/// Runs a test with listening gates that listen on Unix sockets, and on TCP.
pub fn on_each_transport(test: impl Fn(Place)) {
    for transport in ["ipc", "tcp"] {
        test(Place::new(transport));
    }
}

impl Place {
    /// A fresh folder in which listening gates listen on `ipc` or `tcp`.
    pub fn new(transport: &'static str) -> Self {
        Self { folder: TempDir::with_prefix("scl").expect("a folder for the test"), transport }
    }

    /// The runtime folder.
    pub fn runtime_dir(&self) -> &Path {
        self.folder.path()
    }

    /// A program that meets the others here.
    pub fn start(&self, program: &str, arguments: &[&str]) -> Process {
        self.start_with(program, arguments, &[])
    }

    /// A program that meets the others here, with more in its environment.
    pub fn start_with(&self, program: &str, arguments: &[&str], more: &[(&str, &str)]) -> Process {
        let mut environment =
            vec![("SCL_RUNTIME_DIR", self.folder.path().as_os_str()), ("SCL_TRANSPORT", self.transport.as_ref())];
        environment.extend(more.iter().map(|(name, value)| (*name, OsStr::new(value))));
        Process::start(program, arguments, &environment)
    }

    /// A program started by a shell after some preparation, for example `ulimit -n 40`.
    pub fn start_after(&self, preparation: &str, program: &str, arguments: &[&str]) -> Process {
        let script = format!("{preparation} && exec {program} {}", arguments.join(" "));
        self.start("sh", &["-c", &script])
    }

    /// The socket in a system's folder whose name starts in a way.
    pub fn socket(&self, system: &str, start: &str) -> PathBuf {
        let folder = self.folder.path().join(system);
        let entries = std::fs::read_dir(&folder).expect("the system's folder");
        let mut paths = entries.flatten().map(|entry| entry.path());
        let starts = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(start));
        paths.find(starts).unwrap_or_else(|| panic!("no socket `{start}` in {}", folder.display()))
    }
}
