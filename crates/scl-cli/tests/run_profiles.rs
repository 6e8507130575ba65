//! `--profile`, `--only`, `--without` and `topology:`: which programs of a launch file are started.

use crate::system::System;

const TOPOLOGY: &str = "\
components:
  - name: sensor
    gates:
      - measurements: pub
  - name: controller
    gates:
      - sensor: sub
connections:
  - [sensor.measurements, controller.sensor]
";
const LAUNCH: &str = "\
topology: wiring/rover.yaml
components:
  sensor: {command: echo rust}
  controller: {command: echo rust $GAIN, environment: {GAIN: 1}}
profiles:
  python:
    sensor: {command: echo python}
    controller: {command: echo python $GAIN}
  sim:
    sensor: {command: echo simulated}
  loud:
    controller: {environment: {GAIN: 9}}
";

fn system() -> System {
    System::of_files(&[("launch.yaml", LAUNCH), ("wiring/rover.yaml", TOPOLOGY)])
}

fn started(arguments: &[&str]) -> Vec<String> {
    let output = system().run(arguments);
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{err}");
    assert!(!err.contains("note:"), "{err}");
    let mut lines: Vec<String> = String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect();
    lines.sort_unstable();
    lines
}

#[track_caller]
fn check_error(arguments: &[&str], expected: &str) {
    let output = system().run(arguments);
    assert_eq!(String::from_utf8(output.stderr).unwrap(), expected);
    assert_eq!((output.status.code(), output.stdout), (Some(2), Vec::new()));
}

#[test]
fn profiles_and_choices_decide_what_starts() {
    let cases: [(&[&str], &[&str]); 7] = [
        (&[], &["controller | rust 1", "sensor     | rust"]),
        (&["--profile", "python"], &["controller | python 1", "sensor     | python"]),
        (&["--profile", "python", "--profile", "sim"], &["controller | python 1", "sensor     | simulated"]),
        (&["--profile", "sim", "--profile", "python"], &["controller | python 1", "sensor     | python"]),
        (&["--profile", "loud", "--only", "controller"], &["controller | rust 9"]),
        (&["--without", "sensor"], &["controller | rust 1"]),
        (&["--only", "sensor,controller"], &["controller | rust 1", "sensor     | rust"]),
    ];
    for (arguments, expected) in cases {
        assert_eq!(started(arguments), expected, "{arguments:?}");
    }
}

#[test]
fn unknown_names_on_the_command_line_get_a_suggestion() {
    check_error(
        &["--profile", "pyton", "--profile", "x"],
        "\
error: unknown profile `pyton`
  = help: did you mean `python`?
  = note: the launch file has the profiles `python`, `sim`, `loud`

error: unknown profile `x`
  = note: the launch file has the profiles `python`, `sim`, `loud`

",
    );
    check_error(
        &["--only", "sensr,controller"],
        "\
error: unknown component `sensr` in `--only`
  = help: did you mean `sensor`?
  = note: `./launch.yaml` has the components `sensor`, `controller`

",
    );
    check_error(&["--without", "sensor,controller"], "error: `--without` leaves no component to start\n\n");
}

#[test]
fn a_profile_needs_a_launch_file() {
    let system = System::of_files(&[("topology.yaml", TOPOLOGY)]);
    let output = system.run(&["--profile", "python"]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(
        err.starts_with("error: unknown profile `python`\n  = note: profiles are in a `launch.yaml`, and "),
        "{err}"
    );
    assert_eq!(output.status.code(), Some(2));
}
