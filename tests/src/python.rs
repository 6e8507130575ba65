//! A Python with pyzmq, which brings libzmq, and protobuf: independent implementations of what SCL sends.

use crate::Process;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Starts a script of the folder `python`.
pub fn start_python(script: &str, arguments: &[&str]) -> Process {
    let path = format!("{}/python/{script}", env!("CARGO_MANIFEST_DIR"));
    Process::start(python_with_packages(), &[&[path.as_str()], arguments].concat(), &[])
}

/// A Python interpreter with the packages, installed into the build folder once.
///
/// # Panics
/// If there is no Python 3 or no package index; the text says what to install.
pub fn python_with_packages() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let folder = build_folder().join("scl-tests-python");
        let python = folder.join("bin/python");
        if !can_import_packages(&python) {
            run(Command::new("python3").args(["-m", "venv"]).arg(&folder), "install Python 3.9 or later with `venv`");
            let install =
                ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "pyzmq>=26,<28", "protobuf>=5,<8"];
            run(
                Command::new(&python).args(install),
                "pip could not install pyzmq and protobuf: is the package index reachable?",
            );
        }
        python
    })
}

fn can_import_packages(python: &Path) -> bool {
    Command::new(python)
        .args(["-c", "import zmq, google.protobuf"])
        .output()
        .is_ok_and(|output| output.status.success())
}

fn run(command: &mut Command, advice: &str) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {advice}"));
    assert!(output.status.success(), "{advice}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// The folder of the test programs themselves, for example `target/debug`.
fn build_folder() -> PathBuf {
    let program = std::env::current_exe().expect("the path of the test program");
    program.ancestors().nth(2).expect("target/debug/deps/program").to_owned()
}
