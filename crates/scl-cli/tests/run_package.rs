//! `scl run` without a launch file: the cargo package beside the topology is built, and its programs are started.

use crate::system::{System, without_times};
use std::process::Output;

const MANIFEST: &str = "[package]\nname = \"rover\"\nedition = \"2024\"\n[workspace]\n";
const TOPOLOGY: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: user_interface
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, user_interface.sensor]
";

fn run(files: &[(&str, &str)]) -> Output {
    let system = System::of_files(&[&[("topology.yaml", TOPOLOGY), ("Cargo.toml", MANIFEST)], files].concat());
    // The package is built in its own folder, wherever these tests are.
    system.scl(&["run"]).env("CARGO_TARGET_DIR", system.path("target")).output().unwrap()
}

fn program_that_says(word: &str) -> String {
    format!("fn main() {{ println!(\"{word}\"); }}")
}

#[test]
fn programs_named_like_components_are_built_and_started() {
    let output = run(&[
        ("src/bin/sensor.rs", &program_that_says("one")),
        ("src/bin/user-interface.rs", &program_that_says("two")),
        ("src/bin/other.rs", &program_that_says("three")),
    ]);
    let mut lines: Vec<String> = String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect();
    lines.sort_unstable();
    let err = without_times(&output.stderr);
    assert_eq!(lines, ["sensor         | one", "user_interface | two"], "{err}");
    assert!(err.contains("user_interface  ended with exit code 0 after N s\n"), "{err}");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn components_without_a_program_are_listed() {
    let output = run(&[("src/bin/sensor.rs", &program_that_says("one"))]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("error: cargo has built no program for component `user_interface`\n"), "{err}");
    assert!(err.contains("  = help: add `src/bin/user_interface.rs`, or say in `launch.yaml`"), "{err}");
    assert!(err.contains("  = note: it has built the programs `sensor`\n"), "{err}");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn what_cargo_says_is_shown() {
    let output = run(&[("src/bin/sensor.rs", "fn main() { 1 + }")]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("build          | error: expected expression, found `}`\n"), "{err}");
    assert!(err.contains("\nerror: the build of all components failed, so nothing was started\n"), "{err}");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_folder_without_a_package_needs_a_launch_file() {
    let output = System::of_files(&[("topology.yaml", TOPOLOGY)]).run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.starts_with("error: there is no cargo package in `"), "{err}");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_launch_file_is_compared_with_the_topology() {
    let launch = "components:\n  sensr: {command: echo one}\n";
    let output = System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", launch)]).run(&["launch.yaml"]);
    let expected = "\
error: [SCL1205] unknown component `sensr`
 --> launch.yaml:2:3
  |
2 |   sensr: {command: echo one}
  |   ^^^^^
  |
  = help: did you mean `sensor`?
  = note: the topology has the components `sensor`, `user_interface`

";
    assert_eq!(String::from_utf8(output.stderr).unwrap(), expected);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn components_left_to_others_are_mentioned() {
    let launch = "components:\n  sensor: {command: echo one}\n";
    let output = System::of_files(&[("topology.yaml", TOPOLOGY), ("launch.yaml", launch)]).run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.starts_with("note: not in the launch file, so not started: `user_interface`\n"), "{err}");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_topology_with_errors_starts_nothing() {
    let launch = "components:\n  sensor: {command: echo one}\n";
    let output = System::of_files(&[("topology.yaml", "componets: []\n"), ("launch.yaml", launch)]).run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("error: the topology has errors, so nothing was started\n"), "{err}");
    assert_eq!((output.status.code(), output.stdout), (Some(2), Vec::new()));
}
