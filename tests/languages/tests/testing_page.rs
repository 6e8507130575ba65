//! The unit tests that `docs/testing.md` shows in other languages pass.

use crate::cpp::build::{self, Build};
use scl_generate::{System, Target, generate, write};
use scl_tests::{Compile, python_with_scl};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository")
}

fn topology() -> PathBuf {
    repository().join("examples/quickstart/topology.yaml")
}

/// The only example in a language, in a file of this name.
fn example(language: &str, file: &str) -> (TempDir, PathBuf) {
    let page = fs::read_to_string(repository().join("docs/testing.md")).expect("the page");
    let (_, section) = page.split_once("## In other languages").expect("the section");
    let begin = format!("\n```{language}\n");
    let mut parts = section.split(&begin).skip(1);
    let (block, _) = parts.next().and_then(|part| part.split_once("```")).expect("an example");
    assert!(parts.next().is_none(), "one example in `{language}`");
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join(file);
    fs::write(&path, block).expect("a source");
    (folder, path)
}

fn generate_into(folder: &Path, target: Target) {
    let mut system = System::of(&scl_loader::load(&scl_loader::Request::new(topology()))).expect("a system");
    system.make_testable();
    for file in generate(&system, target).expect("no clashes") {
        write(folder, &file).expect("a generated file");
    }
}

#[test]
fn the_tests_in_python_pass() {
    let (folder, test) = example("python", "test_controller.py");
    generate_into(folder.path(), Target::Python);
    let text = build::run(Command::new(python_with_scl()).args(["-m", "pytest", "-q"]).arg(test));
    assert!(text.contains("2 passed"), "{text}");
}

#[test]
fn the_test_in_cpp_passes() {
    let (_folder, test) = example("cpp", "controller_test.cpp");
    build::run(&mut Command::new(build::program(&test, &topology(), Build::Plain)));
}

#[test]
fn the_test_in_c_passes() {
    let (folder, test) = example("c", "controller_test.c");
    generate_into(folder.path(), Target::C);
    let mut messages = Command::new("protoc-c");
    messages.arg(format!("--c_out={}", folder.path().display()));
    build::run(messages.arg("-I").arg(repository().join("examples/quickstart")).arg("rover.proto"));
    let program = folder.path().join("controller_test");
    let compile = Compile::c(test).option(format!("-I{}", folder.path().display()));
    let compile =
        ["rover_scl.c", "rover.pb-c.c"].map(|name| folder.path().join(name)).into_iter().fold(compile, Compile::source);
    compile.option("-lprotobuf-c").program(&program);
    build::run(&mut Command::new(program));
}
