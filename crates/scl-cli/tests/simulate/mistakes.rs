//! What cannot be simulated is named.

use super::{errors, of_program, simulate, text};
use crate::system::System;
use std::fs;
use std::os::unix::fs::PermissionsExt;

#[test]
fn a_program_that_never_waits_is_named() {
    let system = of_program("int main(void) { for (;;) continue; }\n", "", &[]);
    let output = simulate(&system, &["--patience", "1s"]);
    let expected = "\
error: `program` has been running for 1 s without waiting, at 0.000000 s
  = help: it computes forever, waits for something outside the simulation, or has become a program that does not take \
part; `--patience` gives it more time

";
    assert_eq!(errors(&output), expected);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_program_without_the_library_is_named() {
    let source = "#include <unistd.h>\nint main(void) { pause(); }\n";
    let output = simulate(&of_program(source, "", &["-static"]), &[]);
    let expected = "\
error: component `program` is linked statically, so it cannot take part in a simulation
  = help: link it with the C library of the system: without `-static`, and for a target without `musl`

";
    assert_eq!(errors(&output), expected);
    assert_eq!(output.status.code(), Some(2));

    // A script that it runs.
    let system = of_program(source, "", &["-static"]);
    system.write("script", &format!("#!{}\n", system.path("program").display()));
    fs::set_permissions(system.path("script"), fs::Permissions::from_mode(0o755)).unwrap();
    system.write("launch.yaml", "components:\n  program: {command: [./script]}\n");
    let output = simulate(&system, &["--patience", "1s"]);
    let expected = "\
error: `program` does not take part in the simulation 1 s after its start
  = help: a program that removes `LD_PRELOAD` cannot take part; name the program itself, not a script that starts it

";
    assert_eq!(errors(&output), expected);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn programs_that_keep_each_other_busy_are_named() {
    let system = of_program(
        "\
#include <fcntl.h>
#include <unistd.h>
int main(int count, char **names) {
    char byte = 0;
    int to = open(names[1], O_RDWR), from = open(names[count - 1], O_RDWR);
    for (;;) if (write(to, &byte, 1) != 1 || read(from, &byte, 1) != 1) return 1;
}
",
        "",
        &[],
    );
    system.make_pipe("there");
    system.make_pipe("back");
    let launch =
        "components:\n  one: {command: [./program, there, back]}\n  other: {command: [./program, back, there]}\n";
    system.write("launch.yaml", launch);
    let output = simulate(&system, &["--most-turns", "1000"]);
    let expected = "\
error: no time passes any more at 0.000000 s: the programs keep each other busy: `one` (499 times), `other` (499 times)
  = help: one of them has to wait, or to answer less than it is told; `--most-turns` lets them go on for longer

";
    assert_eq!(errors(&output), expected);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_component_in_a_child_of_its_program_is_refused() {
    let scl = env!("CARGO_BIN_EXE_scl");
    let system = System::of_files(&[
        ("topology.yaml", "system: one\ncomponents: [{name: only, gates: [{values: pub}]}]\n"),
        ("launch.yaml", &format!("components:\n  only: {{command: '{scl} pub only.values \"{{text: x}}\"; true'}}\n")),
    ]);
    let output = simulate(&system, &[]);
    assert!(errors(&output).contains("takes no part in the simulation"), "{}", text(&output.stderr));
}

#[test]
fn wrong_arguments_are_refused() {
    let system = of_program("int main(void) {}\n", "", &[]);
    for (arguments, expected) in [
        (["--speed", "0"], "expected a number above 0, for example `1` or `0.5`"),
        (["--until", "5"], "the unit is missing: write `5s` or `5ms`"),
        (["--seed", "many"], "invalid digit"),
        (["-o", "flight.mcap"], "there is no topology file, so nothing can be recorded"),
    ] {
        let output = simulate(&system, &arguments);
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
        assert_eq!(output.status.code(), Some(2));
    }
}
