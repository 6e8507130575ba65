//! A system that runs already, a `scl run` that does not answer, and what a stop leaves running.

use crate::system::{FOREVER, SpawnGuarded, Started, System};
use std::os::unix::net::UnixStream;

const TOPOLOGY: &str = "\
system: rover
components:
  - name: sensor
  - name: controller
connections: []
";

/// A system whose build leaves a file behind.
fn system() -> System {
    let launch = format!(
        "build: 'echo x >> built'\ncomponents:\n  sensor: {{command: {FOREVER:?}}}\n  controller: {{command: {FOREVER:?}}}\n"
    );
    System::of_files(&[("launch.yaml", &launch), ("topology.yaml", TOPOLOGY)])
}

fn start(system: &System, arguments: &[&str]) -> Started {
    let before = system.run_sockets("rover", "control").len();
    let run = system.start(arguments);
    while system.run_sockets("rover", "control").len() == before {}
    run
}

fn builds(system: &System) -> usize {
    std::fs::read_to_string(system.path("built")).unwrap().lines().count()
}

/// The exit code and the error of a command.
fn scl(system: &System, arguments: &[&str]) -> (Option<i32>, String) {
    let output = system.scl(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

const HELP: &str = "  = help: stop it with `scl stop`, or choose other components with `--only` or `--without`\n\n";

#[test]
fn a_second_run_is_refused_before_it_builds() {
    let system = system();
    let run = start(&system, &[]);
    let pid = run.process_id();
    let expected = format!("error: system `rover` is already running: `scl run` is process {pid}\n{HELP}");
    assert_eq!(scl(&system, &["run"]), (Some(2), expected));
    let expected = format!("error: component `sensor` is already running: `scl run` is process {pid}\n{HELP}");
    assert_eq!(scl(&system, &["stop", "controller"]).0, Some(0));
    assert_eq!(scl(&system, &["run"]), (Some(2), expected));
    assert_eq!(builds(&system), 1);
    // What runs nowhere may be started elsewhere.
    let other = start(&system, &["--only", "controller"]);
    assert_eq!(scl(&system, &["stop"]).0, Some(0));
    assert_eq!((run.finish().0.code(), other.finish().0.code()), (Some(0), Some(0)));
    assert_eq!(system.run(&["--for", "1ms"]).status.code(), Some(0));
}

#[test]
fn a_run_that_is_stopped_by_a_signal_is_named_and_nobody_waits_for_it() {
    let system = system();
    let run = start(&system, &[]);
    let pid = run.process_id();
    run.signal("-STOP");
    let expected = format!(
        "\
error: `scl run`, process {pid}, does not answer: it is stopped
  = help: resume it: `kill -CONT {pid}`
  = help: end it and its programs: `kill -KILL {pid}`

"
    );
    for command in [&["stop"][..], &["stop", "sensor"], &["restart", "sensor"], &["run"]] {
        assert_eq!(scl(&system, command), (Some(2), expected.clone()), "{command:?}");
    }
    run.signal("-CONT");
    assert_eq!(scl(&system, &["stop"]), (Some(0), String::new()));
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn a_run_that_is_stopped_during_a_stop_is_named() {
    let stubborn = "trap 'echo asked' TERM; echo ready; while :; do tail -f /dev/null >/dev/null & wait; done";
    let launch = format!("components: {{sensor: {{command: {stubborn:?}}}}}");
    let system = System::of_files(&[("launch.yaml", &launch), ("topology.yaml", TOPOLOGY)]);
    let mut run = start(&system, &["--grace", "1h"]);
    run.wait_for_line("sensor | ready");
    let stop = system.scl(&["stop"]).stderr(std::process::Stdio::piped()).spawn_guarded();
    run.wait_for_line("sensor | asked");
    run.signal("-STOP");
    let output = stop.wait_with_output();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains(" does not answer: it is stopped\n"), "{err}");
    assert_eq!(output.status.code(), Some(2), "{err}");
    run.signal("-CONT");
    // The second one kills.
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(1));
}

#[test]
fn silent_clients_keep_nobody_out() {
    let system = system();
    let run = start(&system, &[]);
    let socket = system.run_sockets("rover", "control").remove(0);
    let silent: Vec<UnixStream> = (0..200).map(|_| UnixStream::connect(&socket).unwrap()).collect();
    let (code, err) = scl(&system, &["restart", "sensor"]);
    assert_eq!(code, Some(0), "{err}");
    let more: Vec<UnixStream> = (0..200).map(|_| UnixStream::connect(&socket).unwrap()).collect();
    assert_eq!(scl(&system, &["stop"]), (Some(0), String::new()));
    assert_eq!(run.finish().0.code(), Some(0));
    drop((silent, more));
}

#[cfg(feature = "observe")]
#[test]
fn components_without_a_run_are_not_started_twice_and_a_stop_names_them() {
    let rover = crate::rover::Rover::start();
    let entry = |name: &str| format!("{name}: {{command: {FOREVER:?}}}");
    rover.write("launch.yaml", &format!("components: {{{}, {}}}", entry("actuator"), entry("sensor")));
    let pid = rover.process_id("sensor");
    let expected = format!(
        "\
note: not in the launch file, so not started: `controller`, `logger`, `user_interface`
error: component `sensor` of system `rover` is already running as process {pid}
  = help: stop it first, or start the others with `--without sensor`

"
    );
    assert_eq!(rover.error(&["run"], 2), expected);
    let run = Started::spawn(&mut rover.scl(&["run", "--without", "sensor"]));
    let stop = || rover.scl(&["stop"]).output().unwrap();
    // Until the run can be asked.
    let output = std::iter::repeat_with(stop).find(|output| output.status.code() != Some(2)).unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    let expected = format!(
        "error: component `sensor` runs without `scl run`, as process {pid}\n  = help: stop it with `kill {pid}`\n"
    );
    assert!(err.contains(&expected), "{err}");
    assert_eq!((output.status.code(), run.finish().0.code()), (Some(1), Some(0)), "{err}");
}

/// Of two systems without a `system`, each called `topology` after its file.
#[test]
fn a_system_of_another_file_is_left_alone() {
    let topology = TOPOLOGY.strip_prefix("system: rover\n").unwrap();
    let launch = format!("components: {{sensor: {{command: {:?}}}}}", format!("echo ready; {FOREVER}"));
    let files = [("launch.yaml", launch.as_str()), ("topology.yaml", topology)];
    let (first, second) = (System::of_files(&files), System::of_files(&files));
    let runtime = first.path("runtime");
    let other = |arguments: &[&str]| {
        let output = second.scl(arguments).env("SCL_RUNTIME_DIR", &runtime).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let mut run = first.start(&[]);
    run.wait_for_line("sensor | ready");
    let [running, meant] = [&first, &second].map(|system| system.path("topology.yaml").canonicalize().unwrap());
    let expected = format!(
        "error: `scl run`, process {}, runs the system of `{}`, not that of `{}`\n",
        run.process_id(),
        running.display(),
        meant.display()
    );
    for arguments in [&["run"][..], &["stop"], &["stop", "sensor"], &["restart", "sensor"]] {
        let (code, err) = other(arguments);
        assert!(err.contains(&expected), "{arguments:?}: {err}");
        assert_eq!(code, Some(2), "{arguments:?}: {err}");
    }
    assert_eq!(other(&["stop", "--system", "topology"]), (Some(0), String::new()));
    assert_eq!(run.finish().0.code(), Some(0));
}
