//! Programs of several processes: what runs between `scl run` and a program, such as a shell, does not cut its end
//! short.

use crate::system::{FOREVER, SpawnGuarded, Started, System, kill, wait_for_writers_to_end};
use std::io::{Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixStream;

/// Closes its valves when it is asked to stop, which takes until the pipe `go` is written to. A second signal ends it
/// at once.
const VALVES: &str = "\
#!/usr/bin/env python3
import os, signal
both = [signal.SIGINT, signal.SIGTERM]
for number in both:
    signal.signal(number, signal.SIG_DFL)
signal.pthread_sigmask(signal.SIG_BLOCK, both)
open('started', 'w').close()
signal.sigwait(both)
signal.pthread_sigmask(signal.SIG_UNBLOCK, both)
open('closing', 'w').close()
open('go').read()
open('closed', 'a').write('closed\\n')
";

/// A wrapper as people write them: without `exec`.
const WRAPPER: &str = "#!/bin/sh\n./valves\necho the wrapper goes on\n";

/// No test passes by a limit.
const NO_LIMIT: [&str; 2] = ["--grace", "1h"];

const COMMANDS: [&str; 8] = [
    "./valves",
    "./valves --option 'two words'",
    "./valves 2>> log",
    "./valves | cat",
    "./valves & wait",
    "./wrapper",
    "[sh, -c, ./valves; echo done]",
    "[./wrapper]",
];

fn system(command: &str) -> System {
    let launch = format!("components:\n  sensor:\n    command: {command}\n");
    let topology = "system: rover\ncomponents:\n  - name: sensor\nconnections: []\n";
    let files =
        [("launch.yaml", launch.as_str()), ("topology.yaml", topology), ("valves", VALVES), ("wrapper", WRAPPER)];
    let system = System::of_files(&files);
    for program in ["valves", "wrapper"] {
        std::fs::set_permissions(system.path(program), PermissionsExt::from_mode(0o755)).unwrap();
    }
    ["started", "closing", "go"].into_iter().for_each(|pipe| drop(system.make_pipe(pipe)));
    system
}

/// Waits until the program has opened this pipe.
fn wait_for(system: &System, pipe: &str) {
    wait_for_writers_to_end(&system.path(pipe));
}

fn start(system: &System) -> Started {
    let run = system.start(&NO_LIMIT);
    wait_for(system, "started");
    run
}

/// Lets the program close its valves.
fn let_go(system: &System) {
    wait_for(system, "closing");
    std::fs::write(system.path("go"), "").unwrap();
}

fn closed(system: &System) -> usize {
    std::fs::read_to_string(system.path("closed")).unwrap_or_default().lines().count()
}

#[test]
fn a_stop_waits_for_the_program_behind_a_shell() {
    for command in COMMANDS {
        for signal in ["-TERM", "-INT"] {
            let system = system(command);
            let run = start(&system);
            run.signal(signal);
            let_go(&system);
            let (status, _, err) = run.finish();
            assert_eq!((status.code(), closed(&system)), (Some(0), 1), "{command}, {signal}:\n{err}");
        }
    }
}

#[test]
fn a_request_waits_for_the_program_behind_a_shell() {
    for command in COMMANDS {
        let system = system(command);
        let run = start(&system);
        let mut restart = system.scl(&["restart", "sensor"]).spawn_guarded();
        let_go(&system);
        wait_for(&system, "started");
        assert!(restart.wait().unwrap().success(), "{command}");
        assert_eq!(closed(&system), 1, "{command}");
        let mut stop = system.scl(&["stop", "sensor"]).stdout(std::process::Stdio::null()).spawn_guarded();
        let_go(&system);
        assert!(stop.wait().unwrap().success(), "{command}");
        assert_eq!(closed(&system), 2, "{command}");
        assert_eq!(run.finish().0.code(), Some(0), "{command}");
    }
}

#[test]
fn what_does_not_stop_behind_a_shell_is_killed() {
    let stubborn = "(trap '' TERM; exec 3>alive; echo ready; while :; do tail -f /dev/null >/dev/null; done) & wait";
    let system = System::of(&[("sensor", stubborn)]);
    let pipe = system.make_pipe("alive");
    let reader = std::thread::spawn(move || wait_for_writers_to_end(&pipe));
    let mut run = system.start(&["--grace", "500ms"]);
    run.wait_for_line("sensor | ready");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert_eq!(reader.join().unwrap(), "");
    assert!(err.contains("sensor  not stopped within 500ms, killed\n"), "{err}");
    // What the shell said counts, as long as the limit was kept.
    assert!(err.ends_with("scl: component `sensor` failed: not stopped within 500ms\n"), "{err}");
    assert_eq!(status.code(), Some(1), "{err}");
}

#[test]
fn a_text_without_syntax_of_the_shell_is_executed_as_it_is() {
    let system = system("tail -f '/dev/null'");
    let run = system.start(&NO_LIMIT);
    while system.run_sockets("rover", "control").is_empty() {}
    let mut connection = UnixStream::connect(&system.run_sockets("rover", "control")[0]).unwrap();
    connection.write_all(b"{\"version\":1,\"command\":\"list\"}\n").unwrap();
    let mut answer = String::new();
    connection.read_to_string(&mut answer).unwrap();
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    let process = &answer["components"][0]["pid"];
    // Until then it is the `scl` that becomes the program.
    while std::fs::read(format!("/proc/{process}/cmdline")).unwrap() != b"tail\0-f\0/dev/null\0" {}
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn processes_that_a_shell_leaves_running_are_the_program() {
    let system = System::of(&[("sensor", "(read line < go; echo $line) & echo started")]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&NO_LIMIT);
    run.wait_for_line("sensor | started");
    std::fs::write(pipe, "finished\n").unwrap();
    run.wait_for_line("sensor | finished");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    assert!(err.contains("sensor  ended with exit code 0 after "), "{err}");
}

#[test]
fn processes_in_the_background_that_ignore_an_interrupt_are_terminated() {
    let system = System::of(&[("sensor", &format!("({FOREVER}) & echo started"))]);
    let mut run = system.start(&NO_LIMIT);
    run.wait_for_line("sensor | started");
    run.signal("-INT");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn a_program_that_a_signal_ended_behind_a_shell_is_restarted() {
    // Without `exec`, so that the shell sees the end of the program.
    let command = "sh -c 'echo x >> starts; [ $(wc -l < starts) -gt 2 ] || kill -KILL $$'; exit $?";
    let launch = format!("components: {{sensor: {{command: {command:?}, restart: on_abnormal, restart_delay: 1ms}}}}");
    let system = System::of_files(&[("launch.yaml", &launch)]);
    let output = system.run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("sensor  ended with exit code 137 after "), "{err}");
    assert!(err.ends_with("component `sensor` was restarted twice; last reason: ended with exit code 137\n"), "{err}");
    assert_eq!(output.status.code(), Some(0), "{err}");
}

#[test]
fn a_killed_shell_takes_its_program_down_in_order_before_it_is_started_again() {
    let system = system("./valves");
    system.write(
        "launch.yaml",
        "components: {sensor: {command: 'echo $$ > shell; ./valves & wait', restart: on_abnormal, restart_delay: 1ms}}",
    );
    let run = start(&system);
    let shell = std::fs::read_to_string(system.path("shell")).unwrap();
    kill("-KILL", shell.trim().parse().unwrap());
    let_go(&system);
    wait_for(&system, "started");
    assert_eq!(closed(&system), 1);
    run.signal("-TERM");
    let_go(&system);
    let (status, _, err) = run.finish();
    assert_eq!((status.code(), closed(&system)), (Some(0), 2), "{err}");
    assert!(err.contains("sensor  killed by signal 9 (SIGKILL) after "), "{err}");
}

#[test]
fn no_process_of_a_shell_that_has_ended_survives_a_killed_run() {
    let system = System::of(&[("sensor", "exec 3>alive; (tail -f /dev/null >/dev/null) & echo started")]);
    let pipe = system.make_pipe("alive");
    let reader = std::thread::spawn(move || wait_for_writers_to_end(&pipe));
    let mut run = system.start(&NO_LIMIT);
    run.wait_for_line("sensor | started");
    run.signal("-KILL");
    assert_eq!(reader.join().unwrap(), "");
}
