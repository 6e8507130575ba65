//! Topologies of the tests, and what is generated from them.

use scl_generate::{File, System, Target, generate};
use scl_loader::{Loaded, Request, load};
use scl_topology::diagnostic::render;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the repository.
pub(crate) fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap()
}

/// A topology file of the tests.
pub(crate) fn topology(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/topologies").join(name)
}

/// The system of a topology file without errors.
#[track_caller]
pub(crate) fn system(path: &Path) -> System {
    let loaded = load(&Request::new(path));
    System::of(&loaded).unwrap_or_else(|| panic!("{}", problems(&loaded)))
}

/// What is generated from a topology file without clashes.
#[track_caller]
pub(crate) fn generated(path: &Path, target: Target) -> Vec<File> {
    generate(&system(path), target).unwrap()
}

/// The same with counterparts for unit tests.
#[track_caller]
pub(crate) fn testable(path: &Path, target: Target) -> Vec<File> {
    let mut system = system(path);
    system.make_testable();
    generate(&system, target).unwrap()
}

/// The text of one of the files.
#[track_caller]
pub(crate) fn text(files: &[File], name: &str) -> String {
    files.iter().find(|file| file.name == name).unwrap_or_else(|| panic!("no {name} in {files:?}")).text.clone()
}

/// The clashes of names in a topology of this text, as `scl generate` shows them.
pub(crate) fn clashes(yaml: &str, schema: &str, target: Target) -> String {
    clashes_after(yaml, schema, target, |_| {})
}

/// The same with counterparts for unit tests.
pub(crate) fn clashes_of_testable(yaml: &str, schema: &str, target: Target) -> String {
    clashes_after(yaml, schema, target, System::make_testable)
}

fn clashes_after(yaml: &str, schema: &str, target: Target, change: fn(&mut System)) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("topology.yaml");
    std::fs::write(&path, yaml).unwrap();
    std::fs::write(folder.path().join("rover.proto"), schema).unwrap();
    let loaded = load(&Request { shown_as: "topology.yaml".to_owned(), ..Request::new(path) });
    let mut system = System::of(&loaded).unwrap_or_else(|| panic!("{}", problems(&loaded)));
    change(&mut system);
    let clashes = generate(&system, target).err().unwrap_or_default();
    clashes.iter().map(|clash| render(clash, &loaded.sources) + "\n").collect()
}

/// Runs a program that the tests need. Returns whether it succeeded, and what it wrote to standard error.
#[track_caller]
pub(crate) fn run(command: &mut Command, package: &str) -> (bool, String) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; Debian: apt install {package}"));
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn problems(loaded: &Loaded) -> String {
    loaded.diagnostics.iter().map(|problem| render(problem, &loaded.sources) + "\n").collect()
}
