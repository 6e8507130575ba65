//! What the tests across processes share: programs that are told what to do line by line, and a folder to meet in.

mod process;
mod python;
mod script;

pub use process::Process;
pub use python::python_with_pyzmq;
pub use script::{Commands, say};

use std::path::Path;
use tempfile::TempDir;

/// A runtime folder of its own for one test, with a path short enough for any socket.
pub struct Place {
    folder: TempDir,
    transport: &'static str,
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
        let environment =
            [("SCL_RUNTIME_DIR", self.folder.path().as_os_str()), ("SCL_TRANSPORT", self.transport.as_ref())];
        Process::start(program, arguments, &environment)
    }
}
