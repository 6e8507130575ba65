//! `build:` in launch files: what runs before the start, in which order, and what stops it.

use crate::system::{System, wait_for_writers_to_end, without_times};
use std::process::Output;

fn run(launch: &str, arguments: &[&str]) -> Output {
    let system = System::of_files(&[("launch.yaml", launch), ("control/empty", "")]);
    system.run(arguments)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn builds_run_in_file_order_before_anything_starts_and_show_their_output_on_standard_error() {
    let launch = "\
build: echo all >> log; echo for all
environment: {WORD: given}
components:
  sensor:
    build: echo sensor >> log; echo $WORD; echo warned >&2; printf '#!/bin/sh\\ncat log' > made; chmod +x made
    command: [./made]
  controller:
    build: [sh, -c, echo controller >> ../log]
    command: 'true'
    working_directory: control
";
    let output = run(launch, &[]);
    let err = without_times(&output.stderr);
    assert_eq!(text(&output.stdout), "sensor     | all\nsensor     | sensor\nsensor     | controller\n", "{err}");
    let expected = [
        "scl: building all components: echo all >> log; echo for all\n",
        "build      | for all\n",
        "build       built after N s\n",
        "sensor     | given\n",
        "sensor     | warned\n",
        "sensor      built after N s\n",
        "scl: building component `controller`: sh -c echo controller >> ../log\n",
        "controller  built after N s\n",
    ];
    for line in expected {
        assert!(err.contains(line), "`{line}` is not in:\n{err}");
    }
    assert_eq!(output.status.code(), Some(0), "{err}");
}

#[test]
fn equal_commands_in_the_same_folder_run_once() {
    let launch = "\
build: echo x >> log
components:
  a: {build: &all echo a >> log, command: cat log}
  b: {build: *all, command: 'true'}
  c: {build: *all, command: 'true', working_directory: control}
  d: {build: echo x >> log, command: 'true'}
";
    let output = run(launch, &[]);
    let err = text(&output.stderr);
    assert_eq!(text(&output.stdout), "a     | x\na     | a\n", "{err}");
    assert!(err.contains("scl: building the components `a`, `b`: echo a >> log\n"), "{err}");
    assert!(err.contains("scl: building component `c`: echo a >> log\n"), "{err}");
}

#[test]
fn only_what_is_started_is_built() {
    let launch = "\
components:
  a: {build: echo base, command: echo base}
  b: {build: exit 1, command: 'true'}
profiles:
  other:
    a: {command: echo other}
";
    let base = run(launch, &["--only", "a"]);
    assert!(text(&base.stderr).contains("a | base\n"), "{}", text(&base.stderr));
    assert_eq!(text(&base.stdout), "a | base\n");
    let other = run(launch, &["--only", "a", "--profile", "other"]);
    assert_eq!(without_times(&other.stderr), "a  ended with exit code 0 after N s\n");
    assert_eq!(text(&other.stdout), "a | other\n");
}

#[test]
fn a_failed_build_starts_nothing() {
    let launch = "\
components:
  sensor: {build: 'echo no header; exit 2', command: echo sensor}
  actuator: {build: 'echo no header; exit 2', command: echo actuator}
  controller: {build: echo later, command: echo controller}
";
    let output = run(launch, &[]);
    let expected = "\
scl: building the components `sensor`, `actuator`: echo no header; exit 2
sensor     | no header
sensor      build ended with exit code 2 after N s
error: the build of the components `sensor`, `actuator` failed, so nothing was started
  = note: `echo no header; exit 2` ended with exit code 2

";
    assert_eq!(without_times(&output.stderr), expected);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(2), String::new()));
}

#[test]
fn what_is_not_installed_is_named() {
    let missing = run("components: {a: {build: [no_such_tool, all], command: echo a}}", &[]);
    let expected = "\
error: the build command `no_such_tool` of component `a` is not in the search path
  = help: install it, or write its path: `./no_such_tool` is looked up in the component's folder

";
    assert_eq!(text(&missing.stderr), expected);
    let in_shell = run("components: {a: {build: 'no_such_tool > all', command: echo a}}", &[]);
    let err = text(&in_shell.stderr);
    assert!(err.contains("\n  = help: install the command that was not found\n"), "{err}");
    assert_eq!((missing.status.code(), in_shell.status.code()), (Some(2), Some(2)));
}

#[test]
fn a_program_that_no_build_has_made_is_reported_after_the_builds() {
    let output = run("components: {a: {build: echo nothing, command: [./made]}}", &[]);
    let err = text(&output.stderr);
    assert!(err.contains("a | nothing\n"), "{err}");
    assert!(err.contains("error: the program of component `a` does not exist: `"), "{err}");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_request_to_stop_ends_a_build_with_its_children_and_starts_nothing() {
    for (signal, word) in [("-INT", "SIGINT"), ("-TERM", "SIGTERM")] {
        let launch = "\
components:
  sensor:
    build: exec 3>alive; trap 'exit 7' INT TERM; tail -f /dev/null >/dev/null & echo > building; wait
    command: echo started
";
        let system = System::of_files(&[("launch.yaml", launch)]);
        let (alive, building) = (system.make_pipe("alive"), system.make_pipe("building"));
        let run = system.start(&["--grace", "1h"]);
        let reader = std::thread::spawn(move || wait_for_writers_to_end(&alive));
        std::fs::read_to_string(building).unwrap();
        run.signal(signal);
        assert_eq!(reader.join().unwrap(), "");
        let (status, out, err) = run.finish();
        let expected = format!("error: stopped on {word} during a build, so nothing was started\n\n");
        assert!(err.ends_with(&expected), "{err}");
        assert_eq!((status.code(), out.as_str()), (Some(2), ""), "{err}");
    }
}

#[test]
fn no_build_survives_a_killed_runner() {
    let launch = "\
components:
  sensor:
    build: exec 3>alive; tail -f /dev/null >/dev/null & echo > building; tail -f /dev/null >/dev/null
    command: echo started
";
    let system = System::of_files(&[("launch.yaml", launch)]);
    let (alive, building) = (system.make_pipe("alive"), system.make_pipe("building"));
    let run = system.start(&[]);
    let reader = std::thread::spawn(move || wait_for_writers_to_end(&alive));
    std::fs::read_to_string(building).unwrap();
    run.signal("-KILL");
    assert_eq!(reader.join().unwrap(), "");
}

#[test]
fn the_time_of_the_run_begins_after_the_builds() {
    let launch = "components: {a: {build: sleep 0.1, command: exec tail -f /dev/null >/dev/null}}";
    let output = run(launch, &["--for", "50ms"]);
    let err = without_times(&output.stderr);
    assert!(err.contains("a  built after N s\na  killed by signal 15 (SIGTERM) after N s\n"), "{err}");
    assert_eq!(output.status.code(), Some(0), "{err}");
}

#[test]
fn a_build_may_replace_the_running_command() {
    let launch = "components: {a: {build: rm ./scl, command: echo started}}";
    let system = System::of_files(&[("launch.yaml", launch)]);
    // By another program: a process that this one forks meanwhile would inherit the open file, which could not be
    // executed.
    let copied = std::process::Command::new("cp").arg(env!("CARGO_BIN_EXE_scl")).arg(system.path("scl")).status();
    assert!(copied.unwrap().success());
    let mut command = std::process::Command::new(system.path("scl"));
    let output = command.arg("run").current_dir(system.path("")).output().unwrap();
    assert_eq!(text(&output.stdout), "a | started\n", "{}", text(&output.stderr));
}

#[test]
fn a_build_can_call_the_running_command() {
    let output = run("components: {a: {build: $SCL --version, command: 'true'}}", &[]);
    let err = text(&output.stderr);
    assert!(err.contains(concat!("a | scl ", env!("CARGO_PKG_VERSION"), "\n")), "{err}");
}
