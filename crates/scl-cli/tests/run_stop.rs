//! How `scl run` stops: by itself, on request, when a component fails, and when it is killed.

use crate::system::{FOREVER, SpawnGuarded, Started, System, kill, wait_for_writers_to_end, without_times};
use scl_needs::needs;
use std::process::Command;

/// Ignores what asks it to stop; says so each time.
const STUBBORN: &str = "trap 'echo caught' INT TERM; echo ready; while :; do tail -f /dev/null >/dev/null & wait; done";
/// Says that it closes its valves when it is asked to stop, and ends in order as soon as the pipe `go` is written to.
const VALVES: &str =
    "trap 'echo closing; read line < go; exit 0' INT TERM HUP; echo ready; tail -f /dev/null >/dev/null & wait";
/// Long enough that only another reason can end the test.
const NO_END_OF_GRACE: [&str; 2] = ["--grace", "1h"];

#[test]
fn all_stop_after_the_time_and_that_is_success() {
    let system = System::of(&[("sensor", FOREVER), ("controller", FOREVER)]);
    let output = system.run(&["--for", "100ms"]);
    let err = without_times(&output.stderr);
    for name in ["sensor    ", "controller"] {
        assert!(err.contains(&format!("{name}  killed by signal 15 (SIGTERM) after N s\n")), "{err}");
    }
    assert_eq!(output.status.code(), Some(0), "{err}");
}

#[test]
fn the_end_of_all_is_the_end_before_the_time() {
    let output = System::of(&[("sensor", "echo one"), ("controller", "echo two")]).run(&["--for", "1h"]);
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_component_that_ends_in_order_leaves_the_others_running() {
    let system = System::of(&[("sensor", "echo one"), ("controller", "read line < go; echo $line; exit 0")]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&[]);
    run.wait_for_line("sensor     | one");
    std::fs::write(pipe, "two\n").unwrap();
    run.wait_for_line("controller | two");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn a_failed_component_stops_the_others() {
    let output = System::of(&[("sensor", FOREVER), ("controller", "exit 3")]).run(&NO_END_OF_GRACE);
    let err = without_times(&output.stderr);
    assert!(err.contains("controller  ended with exit code 3 after N s\n"), "{err}");
    assert!(err.contains("sensor      killed by signal 15 (SIGTERM) after N s\n"), "{err}");
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn a_signal_is_passed_on_and_a_clean_stop_is_success() {
    for (signal, word) in [("-INT", "INT"), ("-TERM", "TERM"), ("-HUP", "HUP")] {
        let stopping =
            format!("trap 'echo got {word}; exit 0' {word}; echo ready; tail -f /dev/null >/dev/null & wait");
        let system = System::of(&[("sensor", &stopping)]);
        // A shell that starts it in the background ignores SIGINT, and `nohup` SIGHUP.
        for mut run in [system.start(&NO_END_OF_GRACE), system.start_ignoring_signals(&NO_END_OF_GRACE)] {
            run.wait_for_line("sensor | ready");
            run.signal(signal);
            run.wait_for_line(&format!("sensor | got {word}"));
            let (status, _, err) = run.finish();
            assert!(
                err.contains(&format!("scl: received SIG{word}, stopping; a second signal kills at once\n")),
                "{err}"
            );
            assert_eq!(status.code(), Some(0), "{err}");
        }
    }
}

#[needs("python3")]
#[test]
fn signals_that_were_blocked_where_it_was_started_are_heard() {
    let blocking = "import os, signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
os.execv(sys.argv[1], sys.argv[1:])";
    let system = System::of(&[("sensor", "trap 'exit 0' TERM; echo ready; tail -f /dev/null >/dev/null & wait")]);
    let mut run = system.start_by("python3", &["-c", blocking], &NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn a_failure_while_stopping_is_a_failure() {
    let system = System::of(&[("sensor", "trap 'exit 9' TERM; echo ready; tail -f /dev/null >/dev/null & wait")]);
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert!(err.contains("ended with exit code 9"), "{err}");
    assert_eq!(status.code(), Some(1));
}

#[test]
fn a_second_request_kills_at_once() {
    let system = System::of(&[("sensor", STUBBORN)]);
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    run.signal("-INT");
    run.wait_for_line("sensor | caught");
    // Signals that follow at once belong to the first one.
    while run.is_running() {
        run.signal("-INT");
    }
    let (status, _, err) = run.finish();
    assert!(err.contains("sensor  killed by signal 9 (SIGKILL)"), "{err}");
    assert_eq!(status.code(), Some(1));
}

/// As `timeout` and wrappers send them.
#[test]
fn signals_that_follow_at_once_are_one_request() {
    let system = System::of(&[("sensor", VALVES)]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    let process = run.process_id();
    // Whichever of them the kernel delivers first is the one that is passed on.
    let script = format!("kill -TERM {process} && kill -INT {process} && kill -HUP {process}");
    assert!(Command::new("/bin/sh").args(["-c", &script]).status().unwrap().success());
    run.wait_for_line("sensor | closing");
    std::fs::write(pipe, "valves are closed\n").unwrap();
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
    assert_eq!(err.matches("a second signal kills at once").count(), 1, "{err}");
}

#[test]
fn the_first_request_kills_nobody_while_all_stop_after_a_failure() {
    let system = System::of(&[("sensor", VALVES), ("controller", "read line < fail; exit 3")]);
    let (pipe, fail) = (system.make_pipe("go"), system.make_pipe("fail"));
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor     | ready");
    std::fs::write(fail, "\n").unwrap();
    run.wait_for_line("sensor     | closing");
    run.signal("-TERM");
    run.wait_for_error("scl: received SIGTERM, already stopping; a second signal kills at once");
    std::fs::write(pipe, "valves are closed\n").unwrap();
    let (status, _, err) = run.finish();
    assert!(without_times(&err).contains("sensor      ended with exit code 0 after N s\n"), "{err}");
    assert_eq!(status.code(), Some(1), "{err}");
}

#[test]
fn who_does_not_stop_in_time_is_named_and_killed() {
    let system = System::of(&[("sensor", STUBBORN), ("controller", FOREVER)]);
    let mut run = system.start(&["--grace", "500ms"]);
    run.wait_for_line("sensor     | ready");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    assert!(err.contains("sensor      not stopped within 500ms, killed\n"), "{err}");
    assert!(err.contains("sensor      killed by signal 9 (SIGKILL)"), "{err}");
    assert!(err.ends_with("scl: component `sensor` failed: not stopped within 500ms\n"), "{err}");
    assert_eq!(status.code(), Some(1));
}

#[test]
fn what_a_program_leaves_behind_ends_with_it() {
    let leaving = |trap: &str| {
        // The trap is inherited: one that the child sets itself may come too late.
        let script = format!("{trap}exec 3>alive; (exec tail -f /dev/null >/dev/null) & echo started");
        let launch = format!("components: {{sensor: {{command: [sh, -c, {script:?}]}}}}");
        System::of_files(&[("launch.yaml", &launch)])
    };
    let polite = leaving("");
    let pipe = polite.make_pipe("alive");
    let run = polite.start(&NO_END_OF_GRACE);
    assert_eq!(wait_for_writers_to_end(&pipe), "");
    assert_eq!(run.finish().0.code(), Some(0));
    let stubborn = leaving("trap '' TERM; ");
    let pipe = stubborn.make_pipe("alive");
    let run = stubborn.start(&["--grace", "100ms"]);
    assert_eq!(wait_for_writers_to_end(&pipe), "");
    let (status, _, err) = run.finish();
    assert!(err.contains("sensor  not stopped within 100ms, killed\n"), "{err}");
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn nobody_reading_stops_the_run() {
    let system = System::of(&[("sensor", "while :; do echo line; done")]);
    let mut command = system.scl(&["run"]);
    let mut process = command.stdout(std::process::Stdio::piped()).spawn_guarded();
    drop(process.stdout.take());
    // The component ends by SIGPIPE or by the SIGTERM that the runner sends it; what counts is that it all ends.
    assert!(process.wait().unwrap().code().is_some());
}

#[test]
fn a_reader_that_takes_nothing_does_not_keep_the_run_from_stopping() {
    let system = System::of(&[("sensor", "exec yes")]);
    let mut run = system.start(&["--grace", "1s"]);
    // From here on nobody reads, so the pipes fill and every writer waits.
    run.wait_for_line("sensor | y");
    run.signal("-TERM");
    assert_eq!(run.wait_unread().code(), Some(0));
}

/// It would take no signal but SIGKILL.
#[test]
fn a_stopped_component_is_continued_when_it_has_to_end() {
    let system = System::of(&[("sensor", "trap 'exit 0' TERM; echo $$; kill -STOP $$; exit 3")]);
    let mut run = system.start(&NO_END_OF_GRACE);
    let line = run.next_line().unwrap();
    let process = line.strip_prefix("sensor | ").unwrap();
    while !std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap().contains(") T ") {}
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    let expected = format!("sensor  process {process} was stopped, as by SIGSTOP; sent SIGCONT so that it can end\n");
    assert!(err.contains(&expected), "{err}");
    assert_eq!(status.code(), Some(0), "{err}");
}

/// Starts a component that holds the pipe `alive` open, with a child that holds it too.
fn start_family(system: &System) -> Started {
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    run
}

const FAMILY: &str = "exec 3>alive; tail -f /dev/null >/dev/null & echo ready; tail -f /dev/null >/dev/null & wait";

#[test]
fn no_orphan_survives_a_killed_runner() {
    let system = System::of(&[("sensor", FAMILY)]);
    let pipe = system.make_pipe("alive");
    let reader = std::thread::spawn(move || wait_for_writers_to_end(&pipe));
    let run = start_family(&system);
    run.signal("-KILL");
    // The reader ends when the shell and both of its children have ended.
    assert_eq!(reader.join().unwrap(), "");
}

#[test]
fn the_programs_end_even_if_the_guard_was_killed_before_the_runner() {
    let system = System::of(&[("sensor", "exec 3>alive; echo ready; exec tail -f /dev/null >/dev/null")]);
    let pipe = system.make_pipe("alive");
    let reader = std::thread::spawn(move || wait_for_writers_to_end(&pipe));
    let run = start_family(&system);
    kill("-KILL", guard_of(run.process_id()));
    run.signal("-KILL");
    assert_eq!(reader.join().unwrap(), "");
}

#[test]
fn a_program_is_not_started_for_a_parent_that_has_gone() {
    let system = System::of(&[]);
    let output = system.scl(&["__start", "1", "--", "echo", "alive"]).output().unwrap();
    assert_eq!((output.status.code(), output.stdout), (Some(126), Vec::new()));
}

/// The process that keeps watch for this runner.
fn guard_of(runner: u32) -> u32 {
    let children = std::fs::read_to_string(format!("/proc/{runner}/task/{runner}/children")).unwrap();
    let is_guard =
        |process: &u32| std::fs::read_to_string(format!("/proc/{process}/cmdline")).unwrap().contains("\0__guard\0");
    children.split_whitespace().map(|word| word.parse().unwrap()).find(is_guard).unwrap()
}
