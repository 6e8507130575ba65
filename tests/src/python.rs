//! The virtual environment of all tests: pyzmq, which brings libzmq, and protobuf as independent implementations of
//! what SCL sends, and on demand the package `scl` of this workspace.
//!
//! It is made once per build folder, and again when `tests/requirements.txt` changes. The package is built whenever it
//! is asked for, which takes a moment if nothing has changed. A lock keeps concurrent tests from making either twice.

use crate::cargo::{build, build_folder, workspace};
use crate::{Process, lock_file};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

const REQUIREMENTS: &str = include_str!("../requirements.txt");

/// Starts a script of the folder `python`.
pub fn start_python(script: &str, arguments: &[&str]) -> Process {
    let path = format!("{}/python/{script}", env!("CARGO_MANIFEST_DIR"));
    Process::start(python_with_packages(), &[&[path.as_str()], arguments].concat(), &[])
}

/// A Python interpreter with the packages of `requirements.txt`.
///
/// # Panics
/// If there is no Python 3.11 with `venv`, or no package index; the text says what to install.
pub fn python_with_packages() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let _lock = lock();
        install_packages()
    })
}

/// The same with the package `scl`, as it is in this workspace now.
///
/// # Panics
/// Also if the package does not build.
pub fn python_with_scl() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let _lock = lock();
        let python = install_packages();
        install_scl(&python);
        python
    })
}

fn lock() -> File {
    lock_file(&target_folder().join("python.lock"))
}

fn install_packages() -> PathBuf {
    let folder = target_folder().join("python");
    let python = folder.join("bin/python");
    let installed = folder.join("installed-requirements.txt");
    let is_installed = fs::read_to_string(&installed).is_ok_and(|text| text == REQUIREMENTS)
        && Command::new(&python).arg("--version").output().is_ok_and(|output| output.status.success());
    if is_installed {
        return python;
    }
    let advice = "install Python 3.11 or later with `venv` (Debian: apt-get install python3 python3-venv)";
    let is_recent = ["-c", "import sys; sys.exit(sys.version_info < (3, 11))"];
    run(Command::new("python3").args(is_recent), advice);
    run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder), advice);
    let requirements = concat!(env!("CARGO_MANIFEST_DIR"), "/requirements.txt");
    run(
        Command::new(&python)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"])
            .arg(requirements),
        "pip could not install the packages of tests/requirements.txt: is the package index reachable?",
    );
    // Written last, so that an installation that was interrupted starts again.
    fs::write(&installed, REQUIREMENTS).expect("a file in the virtual environment");
    python
}

/// Copies the package and its native module into the virtual environment.
fn install_scl(python: &Path) {
    let folder = build("scl-python");
    let packages = Command::new(python).args(["-c", "import sysconfig; print(sysconfig.get_path('platlib'))"]).output();
    let packages = String::from_utf8(packages.expect("the folder of packages").stdout).expect("a path in UTF-8");
    let package = Path::new(packages.trim()).join("scl");
    copy_new(&folder.join("libscl_native.so"), &package.join("_native.abi3.so"));
    let kept = |name: &str| name == "_native.abi3.so" || name == "__pycache__";
    mirror(&workspace().join("bindings/python/python/scl"), &package, &kept).expect("the package can be copied");
}

/// Makes a folder equal to another one, except for what is kept.
fn mirror(from: &Path, to: &Path, kept: &impl Fn(&str) -> bool) -> io::Result<()> {
    fs::create_dir_all(to)?;
    let names = |folder: &Path| -> io::Result<Vec<String>> {
        let entries = fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()));
        Ok(entries.collect::<io::Result<Vec<_>>>()?.into_iter().filter(|name| !kept(name)).collect())
    };
    let wanted = names(from)?;
    for name in names(to)?.iter().filter(|name| !wanted.contains(name)) {
        let gone = to.join(name);
        if gone.is_dir() { fs::remove_dir_all(gone)? } else { fs::remove_file(gone)? }
    }
    for name in wanted {
        let (from, to) = (from.join(&name), to.join(&name));
        if from.is_dir() { mirror(&from, &to, kept)? } else { copy_new(&from, &to) }
    }
    Ok(())
}

/// Copies a file unless that is done already. Programs that run keep the file that they have opened.
fn copy_new(from: &Path, to: &Path) {
    let content = fs::read(from).unwrap_or_else(|error| panic!("{}: {error}", from.display()));
    if fs::read(to).is_ok_and(|old| old == content) {
        return;
    }
    let temporary = to.with_extension("new");
    let copied = fs::create_dir_all(to.parent().unwrap_or(to))
        .and_then(|()| fs::write(&temporary, content))
        .and_then(|()| fs::rename(&temporary, to));
    copied.unwrap_or_else(|error| panic!("{}: {error}", to.display()));
}

fn run(command: &mut Command, advice: &str) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {advice}"));
    let text = [output.stdout, output.stderr].concat();
    assert!(output.status.success(), "{advice}\n{}", String::from_utf8_lossy(&text));
}

/// The folder of everything that is built, for example `target`.
fn target_folder() -> PathBuf {
    build_folder().parent().expect("target/debug").to_owned()
}
