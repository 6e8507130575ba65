//! `restart`, its delay and its limit, and `essential`: programs that fail a known number of times, counted in files.

use crate::system::{System, without_times};
use std::io::Write as _;
use std::process::Output;

/// Adds a line to the file `starts`, and gives their number.
const COUNT: &str = "echo x >> starts; n=$(wc -l < starts)";

fn run(launch: &str) -> (Output, String, usize) {
    let system = System::of_files(&[("launch.yaml", launch), ("below/empty", "")]);
    let output = system.run(&[]);
    let err = without_times(&output.stderr);
    let starts = std::fs::read_to_string(system.path("starts")).unwrap_or_default();
    (output, err, starts.lines().count())
}

/// Runs one component; `settings` are added to its entry.
#[track_caller]
fn check(command: &str, settings: &str, expected_starts: usize, expected_code: i32, expected_err: &str) {
    let launch = format!("components: {{sensor: {{command: '{COUNT}; {command}', restart_delay: 1ms, {settings}}}}}");
    let (output, err, starts) = run(&launch);
    assert_eq!(starts, expected_starts, "{err}");
    assert!(err.ends_with(expected_err), "{err}");
    assert_eq!(output.status.code(), Some(expected_code), "{err}");
}

#[test]
fn nothing_is_restarted_by_default() {
    check("exit 1", "", 1, 1, "scl: component `sensor` failed: ended with exit code 1\n");
    check("exit 1", "restart: never", 1, 1, "scl: component `sensor` failed: ended with exit code 1\n");
}

#[test]
fn a_restart_by_the_policy_builds_nothing() {
    let launch = format!(
        "components: {{sensor: {{build: 'echo x >> built', command: '{COUNT}; [ $n = 2 ]', restart: on_failure, restart_delay: 1ms}}}}"
    );
    let system = System::of_files(&[("launch.yaml", &launch)]);
    let output = system.run(&[]);
    let lines = |file: &str| std::fs::read_to_string(system.path(file)).unwrap().lines().count();
    assert_eq!((lines("built"), lines("starts")), (1, 2));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_failed_program_is_restarted_until_it_ends_in_order() {
    let expected = "\
sensor  ended with exit code 0 after N s
scl: component `sensor` was restarted twice; last reason: killed by signal 9 (SIGKILL)
";
    check("[ $n -gt 2 ] || kill -KILL $$", "restart: on_failure", 3, 0, expected);
    check("exit 0", "restart: on_failure", 1, 0, "sensor  ended with exit code 0 after N s\n");
}

#[test]
fn an_exit_code_is_not_abnormal() {
    check(
        "[ $n -gt 2 ] && exit 7; kill -KILL $$",
        "restart: on_abnormal",
        3,
        1,
        "\
sensor  killed by signal 9 (SIGKILL) after N s
sensor  restarting in 1ms
sensor  ended with exit code 7 after N s
scl: component `sensor` failed: ended with exit code 7; it was restarted twice
",
    );
}

#[test]
fn always_is_also_after_an_end_in_order() {
    let expected = "\
sensor  ended with exit code 0 after N s
sensor  not restarted: the restart limit (3 in 3600s) is reached
scl: component `sensor` failed: ended too often, and the restart limit (3 in 3600s) is reached; it was restarted 3 times
";
    check("exit 0", "restart: always, restart_limit: 3 in 1h", 4, 1, expected);
}

#[test]
fn the_limit_makes_it_a_failure() {
    let expected = "\
sensor  ended with exit code 7 after N s
sensor  restarting in 1ms
sensor  ended with exit code 7 after N s
sensor  not restarted: the restart limit (1 in 3600s) is reached
scl: component `sensor` failed: ended with exit code 7, and the restart limit (1 in 3600s) is reached; it was restarted once
";
    check("exit 7", "restart: on_failure, restart_limit: 1 in 1h", 2, 1, expected);
    let (output, err, starts) = run("\
components:
  sensor: {command: 'echo x >> starts; exit 7', restart: on_failure}
  controller: {command: exec tail -f /dev/null >/dev/null}
defaults: {restart_limit: 2 in 1h, restart_delay: 1ms..2ms}
");
    assert_eq!((starts, output.status.code()), (3, Some(1)), "{err}");
    assert!(err.contains("controller  killed by signal 15 (SIGTERM)"), "{err}");
}

#[test]
fn the_rest_goes_on_without_a_component_that_is_not_essential() {
    let system = System::of_files(&[(
        "launch.yaml",
        "\
components:
  sensor: {command: 'exec < go; read line; echo $line; read line; echo $line'}
  logger: {command: 'echo started; exit 3', essential: false, restart: on_failure, restart_limit: 1 in 1h}
",
    )]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&[]);
    run.wait_for_line("logger | started");
    run.wait_for_error("logger  not restarted: the restart limit (1 in 3600s) is reached");
    // Opened once: a program that opened it again before the first writer had closed it would read its end.
    let mut go = std::fs::File::create(&pipe).unwrap();
    for word in ["one", "two"] {
        writeln!(go, "{word}").unwrap();
        run.wait_for_line(&format!("sensor | {word}"));
    }
    let (status, _, err) = run.finish();
    assert!(err.contains("scl: non-essential component `logger` failed: ended with exit code 3, and "), "{err}");
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn a_program_that_cannot_be_started_again_has_failed() {
    let (output, err, starts) = run("\
components:
  sensor:
    command: 'echo x >> ../starts; rm -r ../below; exit 1'
    working_directory: below
    restart: on_failure
    restart_limit: 2 in 1h
    restart_delay: 1ms
");
    assert_eq!(starts, 1, "{err}");
    assert!(err.contains("sensor  cannot be started: No such file or directory"), "{err}");
    assert!(err.contains("it was restarted twice\n"), "{err}");
    assert_eq!(output.status.code(), Some(1), "{err}");
}

#[test]
fn what_a_failed_program_left_behind_is_killed_before_it_starts_again() {
    let first = "(trap \"\" TERM; exec tail -f /dev/null >/dev/null 2>&1) & echo $! > child; exit 1";
    // The kernel needs a moment to end a killed process, and nobody may reap it.
    let second = "while state=$(cat /proc/$(cat child)/stat 2>/dev/null); do \
                  case $state in *\") Z \"*) break;; esac; done; echo gone";
    let command = format!("if [ -e child ]; then {second}; else {first}; fi");
    let launch = format!("components:\n  sensor:\n    command: |-\n      {command}\n    restart: on_failure\n");
    let (output, err, _) = run(&launch);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "sensor | gone\n", "{err}");
    assert_eq!(output.status.code(), Some(0), "{err}");
}

#[test]
fn output_of_each_start_is_shown_before_its_end() {
    let (output, err, _) = run(&format!(
        "components: {{sensor: {{command: '{COUNT}; echo out $n; echo err $n >&2; [ $n = 2 ]', restart: on_failure}}}}"
    ));
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "sensor | out 1\nsensor | out 2\n");
    let expected = "\
sensor | err 1
sensor  ended with exit code 1 after N s
sensor  restarting in 100ms
sensor | err 2
sensor  ended with exit code 0 after N s
scl: component `sensor` was restarted once; last reason: ended with exit code 1
";
    assert_eq!(err, expected);
}

#[test]
fn the_time_of_a_run_may_end_while_a_component_waits_for_its_restart() {
    let system = System::of_files(&[(
        "launch.yaml",
        "components: {sensor: {command: exit 1, restart: on_failure, restart_delay: 1h}}",
    )]);
    let output = system.run(&["--for", "1s"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_time_of_a_run_may_end_long_before_the_last_program() {
    let stopping = "trap 'echo asked; read line < go; exit 0' TERM; echo ready; while :; do tail -f /dev/null >/dev/null & wait; done";
    let system = System::of(&[("sensor", stopping)]);
    let pipe = system.make_pipe("go");
    let mut run = system.start(&["--for", "1s", "--grace", "1h"]);
    run.wait_for_line("sensor | asked");
    std::fs::write(pipe, "go\n").unwrap();
    let (status, _, err) = run.finish();
    assert_eq!(status.code(), Some(0), "{err}");
}

#[test]
fn a_restarted_component_can_be_stopped_with_the_others() {
    let system = System::of_files(&[(
        "launch.yaml",
        "components: {sensor: {command: 'echo started; exit 1', restart: on_failure, restart_delay: 1h}}",
    )]);
    let mut run = system.start(&[]);
    run.wait_for_error("sensor  restarting in 3600s");
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}
