//! The C++ code of `docs/cpp.md` compiles.

use super::build::{binding, generated, include_options};
use scl_tests::Compile;
use std::fs;

/// What the page takes for granted.
const BEFORE: &str = "\
#include <controls.scl.hpp>
#include <rover.scl.hpp>
#include <poll.h>
#include <algorithm>
#include <iostream>
using namespace std::chrono_literals;
double read_hardware();
struct MotorGuard { ~MotorGuard() {} };
struct Gps { scl::Pub<scl::Bytes> position; };
";

#[test]
fn the_code_of_the_page_compiles() {
    let blocks = blocks("cpp");
    assert!(blocks.len() > 12, "{} blocks", blocks.len());
    let mut text = BEFORE.to_owned();
    for (index, block) in blocks.iter().enumerate() {
        // A whole program, declarations, or statements.
        let begins = |word: &str| block.starts_with(word) || block.contains(&format!("\n{word}"));
        let program = block.replace("int main()", &format!("int main_{index}()"));
        text += &match () {
            () if begins("int main()") => program,
            () if begins("template <>") || begins("void ") => program,
            () => format!(
                "void part_{index}(rover::Controller& controller, rover::Actuator& actuator, rover::UserInterface& ui,\n\
                 Gps& gps) {{\n(void)controller, (void)actuator, (void)ui, (void)gps;\n{block}}}\n"
            ),
        };
        text.push('\n');
    }
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("page.cpp");
    fs::write(&source, &text).expect("a source");
    let topologies = ["examples/quickstart/topology.yaml", "crates/scl-generate/tests/topologies/controls.yaml"];
    let folders = topologies.map(|file| generated(&binding().join("../..").join(file)).folder);
    let options = include_options().into_iter().chain(folders.map(|folder| format!("-I{}", folder.display())));
    // Examples leave values unused.
    let options = options.chain(["-Wno-unused-but-set-variable".to_owned(), "-Wno-unused-variable".to_owned()]);
    let compiled = options.fold(Compile::cpp(&source), Compile::option).check();
    compiled.unwrap_or_else(|error| panic!("{error}\n{text}"));
}

/// The promise: the publisher is at most 9 lines long, and it is the program that the test of CMake builds and runs.
#[test]
fn the_first_program_is_the_one_that_is_tested() {
    let first = blocks("cpp").remove(0);
    assert_eq!(first.lines().count(), 9);
    let tested = fs::read_to_string(binding().join("tests/cmake_project/sensor.cpp")).expect("the tested program");
    assert_eq!(tested.replace("#include \"hardware.hpp\"\n", ""), first);
}

/// The blocks of a language.
fn blocks(language: &str) -> Vec<String> {
    let page = fs::read_to_string(binding().join("../../docs/cpp.md")).expect("the page");
    let begin = format!("\n```{language}\n");
    let parts = page.split(&begin).skip(1).filter_map(|part| part.split_once("```"));
    parts.map(|(block, _)| block.to_owned()).collect()
}
