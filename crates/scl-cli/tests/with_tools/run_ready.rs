//! `ready_within` and `alive_within`: programs that say what they do with `sd_notify`, and programs that do not.

use crate::system::{System, without_times};
use std::os::unix::net::UnixDatagram;

/// What the programs of these tests use.
const NOTIFY: &str = "\
import os, signal, socket, sys
def say(text):
    if isinstance(text, str): text = text.encode()
    socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(text, os.environ['NOTIFY_SOCKET'])
def hang():
    while True: signal.pause()
";

/// A component in Python, with more keys in its entry.
fn system(program: &str, settings: &str) -> System {
    let entry = format!("components: {{sensor: {{command: [python3, -u, sensor.py], {settings}}}}}");
    let program = format!("from notify import *\n{program}");
    System::of_files(&[("launch.yaml", &entry), ("notify.py", NOTIFY), ("sensor.py", &program)])
}

#[track_caller]
fn check(program: &str, settings: &str, expected_code: i32, expected_err: &[&str]) {
    let output = system(program, settings).run(&[]);
    let err = without_times(&output.stderr);
    for line in expected_err {
        assert!(err.contains(&format!("{line}\n")), "`{line}` is not in:\n{err}");
    }
    assert_eq!(output.status.code(), Some(expected_code), "{err}");
}

#[test]
fn what_a_program_waits_for_is_named_if_it_is_not_ready_in_time() {
    check(
        "say('STATUS=waiting for \\x1b[31m`controller.commands`'); hang()",
        "ready_within: 10s",
        1,
        &[
            "sensor  not ready within 10s: waiting for \\u{1b}[31m`controller.commands`",
            "sensor  killed by signal 15 (SIGTERM) after N s",
            "scl: component `sensor` failed: not ready within 10s: waiting for \\u{1b}[31m`controller.commands`",
        ],
    );
}

#[test]
fn a_program_that_says_nothing_is_not_ready() {
    check("hang()", "ready_within: 100ms", 1, &["sensor  not ready within 100ms, and has sent no `STATUS=`"]);
}

#[test]
fn all_being_ready_is_said_once() {
    let launch = "\
components:
  sensor: {command: [python3, program.py], ready_within: 1h}
  controller: {command: [python3, program.py], ready_within: 1h}
";
    let program = "from notify import *\nsay('STATUS=up\\nREADY=1')\nopen('go').read()";
    let system = System::of_files(&[("launch.yaml", launch), ("notify.py", NOTIFY), ("program.py", program)]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&[]);
    run.wait_for_error("scl: all components are ready after ");
    std::fs::write(&pipe, "").unwrap();
    // The second one may have opened the pipe later.
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert_eq!(err.matches("are ready").count(), 1, "{err}");
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn programs_find_where_to_report_and_how_often() {
    let program = "print(os.environ['WATCHDOG_USEC'], os.environ.get('WATCHDOG_PID'))";
    let system = system(program, "alive_within: 1500ms");
    let mut command = system.scl(&["run"]);
    // What systemd sets for `scl run` itself.
    let given = [("NOTIFY_SOCKET", "/of/systemd"), ("WATCHDOG_USEC", "1"), ("WATCHDOG_PID", "1")];
    let output = command.envs(given).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "sensor | 1500000 None\n");
    let plain = System::of(&[("sensor", "echo ${WATCHDOG_USEC-none} ${NOTIFY_SOCKET##*.}")]);
    let output = plain.scl(&["run"]).envs(given).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "sensor | none notify\n");
}

#[test]
fn a_program_that_hangs_is_aborted_and_restarted() {
    check(
        "\
if os.path.exists('again'): sys.exit(0)
open('again', 'w')
say('READY=1')
say('WATCHDOG=1')
hang()",
        "alive_within: 100ms, restart: on_failure",
        0,
        &[
            "sensor  no sign of life for 100ms",
            "sensor  killed by signal 6 (SIGABRT) after N s",
            "sensor  restarting in 100ms",
            "sensor  ended with exit code 0 after N s",
            "scl: component `sensor` was restarted once; last reason: no sign of life for 100ms",
        ],
    );
}

#[test]
fn a_program_that_hangs_and_ignores_that_is_killed() {
    check(
        "signal.signal(signal.SIGABRT, signal.SIG_IGN)\nsay('WATCHDOG=1')\nhang()",
        "alive_within: 100ms, stop_within: 200ms",
        1,
        &[
            "sensor  no sign of life for 100ms",
            "sensor  not stopped within 200ms, killed",
            "sensor  killed by signal 9 (SIGKILL) after N s",
            "scl: component `sensor` failed: no sign of life for 100ms",
        ],
    );
}

#[test]
fn a_program_that_is_not_ready_yet_is_not_watched() {
    let system = system("open('go').read(); sys.exit(0)", "alive_within: 1ms");
    let pipe = system.make_pipe("go");
    let run = system.start(&[]);
    // Longer than the limit, whenever the program opens it.
    std::fs::write(pipe, "").unwrap();
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn only_processes_of_the_component_count() {
    check(
        // The stranger, which nobody else ends, ends with the component.
        "\
component_ends, _component_runs = os.pipe()
if os.fork() == 0:
    os.close(_component_runs)
    os.setsid()
    say('READY=1')
    say('STATUS=from a stranger')
    os.read(component_ends, 1)
    os._exit(0)
hang()",
        "ready_within: 2s",
        1,
        &["sensor  not ready within 2s, and has sent no `STATUS=`"],
    );
}

#[test]
fn garbage_is_ignored() {
    let program =
        "say(b'READY=1\\xff'); say('x' * 9000 + '\\nREADY=1'); say(''); say('=' * 4000); say('STATUS=last'); hang()";
    let system = system(program, "ready_within: 10s");
    let run = system.start(&[]);
    // The test is a stranger, too.
    let socket = loop {
        if let Some(socket) = system.run_sockets("", "notify").pop() {
            break socket;
        }
    };
    let stranger = UnixDatagram::unbound().unwrap();
    for text in ["READY=1", "STATUS=of a stranger", "\u{0}", ""] {
        stranger.send_to(text.as_bytes(), &socket).unwrap();
    }
    let (status, _, err) = run.finish();
    assert!(err.contains("sensor  not ready within 10s: last\n"), "{err}");
    assert_eq!(status.code(), Some(1), "{err}");
    assert!(!socket.exists());
}
