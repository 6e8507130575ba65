//! The Python package: its own tests, which use the programs of these tests as peers, and its checks.

use scl_tests::python_with_scl;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The promise: the package does what its pages say, also with Rust programs as peers.
#[test]
fn the_package_passes_its_tests() {
    run(&["-m", "pytest", "-q", "-p", "no:cacheprovider", "bindings/python/tests"]);
}

/// The promise: the stub of the native module is what the module has.
#[test]
fn the_stub_of_the_native_module_is_current() {
    run(&["-m", "mypy.stubtest", "scl._native", "--mypy-config-file", "bindings/python/pyproject.toml"]);
}

/// The promise: the package passes a type checker, and is formatted.
#[test]
fn the_package_is_typed_and_formatted() {
    run(&["-m", "mypy", "--strict", "--config-file", "bindings/python/pyproject.toml", "bindings/python/python/scl"]);
    run(&["-m", "ruff", "format", "--check", "--no-cache", "bindings/python"]);
    run(&["-m", "ruff", "check", "--no-cache", "bindings/python"]);
}

fn run(arguments: &[&str]) {
    let mut command = Command::new(python_with_scl());
    command.args(arguments).current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    command.env("SCL_TEST_PROGRAMS", programs()).env("PYTHONDONTWRITEBYTECODE", "1");
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}\n{text}", arguments.join(" "));
}

/// The folder of the programs of these tests.
fn programs() -> PathBuf {
    let peer = Path::new(env!("CARGO_BIN_EXE_peer"));
    peer.parent().expect("the folder of a program").to_owned()
}
