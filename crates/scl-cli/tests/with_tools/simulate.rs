//! `scl simulate` with programs in other languages.

use crate::system::System;
use std::process::Command;

/// It would ask the processor for random numbers, without any call of the C library.
#[test]
fn random_numbers_of_cpp_come_from_the_seed() {
    let source = "\
#include <cstdio>
#include <random>
int main() { std::random_device device; printf(\"%u\\n\", device()); }
";
    let system = System::of_files(&[
        ("program.cpp", source),
        ("launch.yaml", "components:\n  program: {command: [./program]}\n"),
    ]);
    let compiled = Command::new("c++").args(["-o", "program", "program.cpp"]).current_dir(system.path("")).status();
    assert!(compiled.unwrap().success());
    let number = |seed: &str| {
        let output = system.scl(&["simulate", "--seed", seed]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(number("1"), number("1"));
    assert_ne!(number("1"), number("2"));
}
