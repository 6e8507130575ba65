//! `scl stop` and `scl restart` from another process, and what the control socket takes.

use crate::system::{FOREVER, Started, System};
use scl_needs::needs;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;

const TOPOLOGY: &str = "\
system: rover
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

/// Adds a line to `starts`, and runs on.
const COUNTED: &str = "echo started; echo x >> starts; exec tail -f /dev/null >/dev/null";

fn system(sensor: &str, controller: &str) -> System {
    let launch =
        format!("components:\n  sensor:\n    command: {sensor:?}\n  controller:\n    command: {controller:?}\n");
    System::of_files(&[("launch.yaml", &launch), ("topology.yaml", TOPOLOGY)])
}

fn start(system: &System, arguments: &[&str], lines: &[&str]) -> Started {
    let mut run = system.start(arguments);
    lines.iter().for_each(|line| run.wait_for(line));
    run
}

/// The exit code and both outputs of a command; process ids are shown as `N`.
fn scl(system: &System, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = system.scl(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| {
        let text = String::from_utf8(bytes).unwrap();
        let line = |line: &str| match line.split_once("process ") {
            Some((before, after)) => {
                let after = after.trim_start_matches(|c: char| c.is_ascii_digit());
                format!("{before}process N{after}\n")
            }
            None => format!("{line}\n"),
        };
        text.lines().map(line).collect()
    };
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[track_caller]
fn check(system: &System, arguments: &[&str], code: i32, out: &str, err: &str) {
    assert_eq!(scl(system, arguments), (Some(code), out.to_owned(), err.to_owned()));
}

fn starts(system: &System) -> usize {
    std::fs::read_to_string(system.path("starts")).unwrap().lines().count()
}

/// The control sockets of the system.
fn sockets(system: &System) -> Vec<PathBuf> {
    system.run_sockets("rover", "control")
}

#[test]
fn everything_is_stopped_and_the_run_ends() {
    let system = system(COUNTED, COUNTED);
    let run = start(&system, &[], &["", ""]);
    let stopped = "sensor  ended: killed by signal 15 (SIGTERM)\ncontroller  ended: killed by signal 15 (SIGTERM)\n";
    check(&system, &["stop"], 0, stopped, "");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    assert!(err.contains("scl: requested: `scl stop`\n"), "{err}");
    assert_eq!(sockets(&system), Vec::<PathBuf>::new());
    check(&system, &["stop"], 2, "", "error: no `scl run` is running\n  = help: start the system with `scl run`\n\n");
}

#[test]
fn one_component_is_stopped_whatever_its_policy_and_started_again() {
    let system = System::of_files(&[
        (
            "launch.yaml",
            &format!(
                "defaults: {{restart: always}}\ncomponents:\n  sensor: {{command: {COUNTED:?}}}\n  controller: {{command: {FOREVER:?}}}\n"
            ),
        ),
        ("topology.yaml", TOPOLOGY),
    ]);
    let mut run = start(&system, &[], &["sensor     | started"]);
    let stopped = "sensor  stopped: killed by signal 15 (SIGTERM)\n";
    check(&system, &["stop", "sensor"], 0, stopped, "");
    // Once more changes nothing.
    check(&system, &["stop", "sensor", "sensor"], 0, stopped, "");
    assert_eq!(starts(&system), 1);
    check(&system, &["restart", "sensor"], 0, "sensor  running as process N\n", "");
    run.wait_for_line("sensor     | started");
    assert_eq!(scl(&system, &["stop"]).0, Some(0));
    let (status, out, err) = run.finish();
    assert_eq!((status.code(), out.as_str()), (Some(0), ""), "{err}");
}

#[test]
fn a_restarted_component_has_a_new_process_and_the_others_keep_theirs() {
    let system = system(COUNTED, FOREVER);
    let mut run = start(&system, &[], &["sensor     | started"]);
    let list = || -> Value {
        let mut connection = UnixStream::connect(&sockets(&system)[0]).unwrap();
        connection.write_all(b"{\"version\":1,\"command\":\"list\"}\n").unwrap();
        let mut answer = String::new();
        connection.read_to_string(&mut answer).unwrap();
        serde_json::from_str(&answer).unwrap()
    };
    let before = list();
    let output = system.scl(&["restart", "sensor", "--format", "json"]).output().unwrap();
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    run.wait_for_line("sensor     | started");
    let after = list();
    let pid = |value: &Value, index: usize| value["components"][index]["pid"].as_i64().unwrap();
    assert_ne!(pid(&before, 0), pid(&after, 0));
    assert_eq!(pid(&before, 1), pid(&after, 1));
    let expected = json!({
        "component": "sensor", "state": "running", "done": true, "pid": pid(&after, 0), "restarts": 0,
        "detail": "killed by signal 15 (SIGTERM)"
    });
    assert_eq!(answer, json!({ "components": [expected] }));
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[needs("python3")]
#[test]
fn a_component_with_a_readiness_limit_is_restarted_when_it_is_ready() {
    let program = "\
import os, signal, socket, sys
count = len(open('starts').readlines()) if os.path.exists('starts') else 0
open('starts', 'a').write('x\\n')
if count == 2: sys.exit(3)
socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b'READY=1', os.environ['NOTIFY_SOCKET'])
while True: signal.pause()
";
    let launch = "\
components:
  sensor: {command: [python3, ready.py], ready_within: 10m, essential: false}
  controller: {command: exec tail -f /dev/null >/dev/null}
";
    let system = System::of_files(&[("launch.yaml", launch), ("topology.yaml", TOPOLOGY), ("ready.py", program)]);
    let run = start(&system, &[], &[]);
    while sockets(&system).is_empty() || !system.path("starts").exists() {}
    check(&system, &["restart", "sensor"], 0, "sensor  ready as process N\n", "");
    let failed = "sensor  failed: ended with exit code 3\n";
    check(&system, &["restart", "sensor"], 1, failed, "");
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn unknown_components_are_named_before_anything_happens() {
    let system = system(COUNTED, FOREVER);
    let run = start(&system, &[], &["sensor     | started"]);
    let expected = "\
error: no `scl run` has a component `senor`
  = help: did you mean `sensor`?
  = note: it has the components `sensor`, `controller`

error: no `scl run` has a component `gps`
  = note: it has the components `sensor`, `controller`

";
    check(&system, &["restart", "sensor", "senor", "gps"], 2, "", expected);
    let elsewhere = "error: no `scl run` is running in system `other`\n  = help: start the system with `scl run`\n\n";
    check(&system, &["stop", "--system", "other"], 2, "", elsewhere);
    assert_eq!(starts(&system), 1);
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn several_runs_of_a_system_are_asked_and_several_systems_are_told_apart() {
    let system = system(COUNTED, COUNTED);
    let sensor = start(&system, &["--only", "sensor"], &["sensor | started"]);
    let controller = start(&system, &["--without", "sensor"], &["controller | started"]);
    let running = "sensor  running as process N\ncontroller  running as process N\n";
    let (code, out, err) = scl(&system, &["restart", "controller", "sensor"]);
    let mut lines: Vec<&str> = out.lines().collect();
    lines.sort_unstable_by(|a, b| b.cmp(a));
    assert_eq!((code, lines.join("\n") + "\n"), (Some(0), running.to_owned()), "{err}");
    let other = system.start_with(&["--only", "sensor"], |command| {
        command.env("SCL_SYSTEM", "twin");
    });
    while system.run_sockets("twin", "control").is_empty() {}
    // The topology of the working folder decides.
    assert_eq!(scl(&system, &["stop"]).0, Some(0));
    assert_eq!((sensor.finish().0.code(), controller.finish().0.code()), (Some(0), Some(0)));
    assert_eq!(scl(&system, &["stop", "--system", "twin"]).0, Some(0));
    assert_eq!(other.finish().0.code(), Some(0));
}

#[test]
fn a_killed_run_leaves_nothing_in_the_way() {
    let system = system("exec 3>alive; echo started; exec tail -f /dev/null >/dev/null", FOREVER);
    let pipe = system.make_pipe("alive");
    let reader = std::thread::spawn(move || crate::system::wait_for_writers_to_end(&pipe));
    let mut run = system.start(&[]);
    run.wait_for_line("sensor     | started");
    let left = sockets(&system);
    run.signal("-KILL");
    assert_eq!(reader.join().unwrap(), "");
    assert_eq!((left.len(), sockets(&system).len()), (1, 1));
    check(&system, &["stop"], 2, "", "error: no `scl run` is running\n  = help: start the system with `scl run`\n\n");
    assert!(sockets(&system).is_empty(), "the stale socket is removed");
    // Another one, as after a kill, and a run that finds it.
    drop(UnixListener::bind(&left[0]).unwrap());
    system.write("launch.yaml", "components: {sensor: {command: 'echo again'}}");
    assert_eq!(system.run(&[]).status.code(), Some(0));
    assert!(sockets(&system).is_empty());
}

#[test]
fn hostile_input_on_the_socket_is_harmless() {
    let system = system(COUNTED, FOREVER);
    let run = start(&system, &[], &["sensor     | started"]);
    let socket = sockets(&system).remove(0);
    assert_eq!(std::fs::metadata(&socket).unwrap().permissions().mode() & 0o777, 0o600);
    let ask = |bytes: &[u8]| {
        let mut connection = UnixStream::connect(&socket).unwrap();
        // It may be closed before all has been written.
        let _ = connection.write_all(bytes).and_then(|()| connection.shutdown(std::net::Shutdown::Write));
        let mut answer = Vec::new();
        let _ = connection.read_to_end(&mut answer);
        String::from_utf8(answer).unwrap()
    };
    let cases: [(&[u8], &str); 9] = [
        (b"", ""),
        (b"stop", ""),
        (b"\xff\xfe\n", ""),
        (&[b'x'; 1 << 20], ""),
        (b"stop\n", "not a request: "),
        (b"{\"version\":1,\"command\":\"explode\"}\n", "unknown variant `explode`"),
        (b"{\"version\":1,\"command\":\"stop\",\"force\":true}\n", "unknown field `force`"),
        (b"{\"version\":2,\"command\":\"stop\"}\n", "version 2 of the protocol, not 1"),
        (b"{\"version\":1,\"command\":\"stop\",\"components\":[\"\\u001b[31m\"]}\n", "unknown: "),
    ];
    for (bytes, expected) in cases {
        let answer = ask(bytes);
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(40)]).into_owned();
        assert!(answer.contains(expected) && answer.is_empty() == expected.is_empty(), "{start}: {answer}");
    }
    // More silent clients than are served at a time; those that connect later are closed or wait.
    let silent: Vec<UnixStream> = (0..100).map(|_| UnixStream::connect(&socket).unwrap()).collect();
    drop(silent);
    while scl(&system, &["restart", "controller"]).0 != Some(0) {}
    assert_eq!(starts(&system), 1);
    assert_eq!(scl(&system, &["stop"]).0, Some(0));
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn a_run_whose_output_nobody_reads_can_be_stopped() {
    let system = system("exec yes", FOREVER);
    let run = start(&system, &[], &["sensor     | y"]);
    assert_eq!(scl(&system, &["stop"]).0, Some(0));
    assert_eq!(run.wait_unread().code(), Some(0));
}

#[cfg(feature = "observe")]
#[test]
fn a_component_that_runs_without_a_run_is_named_with_its_process() {
    let rover = crate::rover::Rover::start();
    let pid = rover.process_id("sensor");
    let error = rover.error(&["stop", "sensor"], 2);
    let expected = format!(
        "error: component `sensor` runs without `scl run`, as process {pid}\n  = help: stop it with `kill {pid}`\n\n"
    );
    assert_eq!(error, expected);
    let error = rover.error(&["restart", "sensor"], 2);
    assert_eq!(error, format!("error: component `sensor` runs without `scl run`, as process {pid}\n\n"));
    let error = rover.error(&["stop"], 2);
    let start = "error: no `scl run` is running\n  = note: components that run without it: `controller` as process ";
    assert!(error.starts_with(start) && error.contains(&format!(", `sensor` as process {pid}, ")), "{error}");
}

/// As `/run/user/UID` is at a logout.
#[test]
fn a_system_keeps_its_runtime_folder_when_it_is_removed() {
    let system = system("echo $SCL_RUNTIME_DIR; exec tail -f /dev/null >/dev/null", FOREVER);
    system.write("session/file", "");
    let session = system.path("session");
    let mut run = system.start_with(&[], |command| {
        command.env_remove("SCL_RUNTIME_DIR").env("XDG_RUNTIME_DIR", &session);
    });
    let folder = session.join("scl");
    run.wait_for_line(&format!("sensor     | {}", folder.display()));
    std::fs::remove_dir_all(&session).unwrap();
    // A socket is bound under another name, and renamed when clients can connect.
    let is_final = |entry: &std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with("run.");
    let entries = || std::fs::read_dir(folder.join("rover")).into_iter().flatten().flatten();
    while entries().filter(is_final).count() < 2 {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let ask = |arguments: &[&str]| {
        let mut command = system.scl(arguments);
        let output = command.env_remove("SCL_RUNTIME_DIR").env("XDG_RUNTIME_DIR", &session).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(ask(&["restart", "sensor"]), (Some(0), String::new()));
    run.wait_for_line(&format!("sensor     | {}", folder.display()));
    assert_eq!(ask(&["stop"]), (Some(0), String::new()));
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn a_session_folder_that_is_missing_is_named() {
    let system = system(FOREVER, FOREVER);
    let session = system.path("session");
    let mut command = system.scl(&["stop"]);
    command.env_remove("SCL_RUNTIME_DIR").env("XDG_RUNTIME_DIR", &session).env("TMPDIR", system.path(""));
    let err = String::from_utf8(command.output().unwrap().stderr).unwrap();
    assert!(err.contains(&format!("`XDG_RUNTIME_DIR` is `{}`, which does not exist", session.display())), "{err}");
}
