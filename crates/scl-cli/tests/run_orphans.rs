//! Processes that leave the group of their program, lose their parents, or both: they end with their component.

use crate::system::{FOREVER, Started, System, wait_for_writers_to_end};
use std::path::Path;
use std::thread::JoinHandle;

/// Holds a pipe open.
const STRAY: &str = "exec 3>$(cat pipe); echo ready; exec tail -f /dev/null >/dev/null";
/// Long enough that only another reason can end the test.
const NO_END_OF_GRACE: [&str; 2] = ["--grace", "1h"];

/// Each starts a stray that keeps its mark.
const STARTS: [&str; 3] = [
    "setsid sh stray & wait",
    // Its parent ends at once.
    "(setsid sh stray &); exec tail -f /dev/null >/dev/null",
    "(setsid setsid sh stray &); exec tail -f /dev/null >/dev/null",
];

fn system(entry: &str) -> (System, JoinHandle<String>) {
    let launch = format!("components: {{sensor: {{{entry}}}}}");
    let topology = "system: rover\ncomponents:\n  - name: sensor\nconnections: []\n";
    let files = [("launch.yaml", launch.as_str()), ("topology.yaml", topology), ("stray", STRAY), ("pipe", "alive")];
    let system = System::of_files(&files);
    let pipe = system.make_pipe("alive");
    // Ends when the stray has ended.
    (system, std::thread::spawn(move || wait_for_writers_to_end(&pipe)))
}

fn start(command: &str) -> (System, Started, JoinHandle<String>) {
    let (system, reader) = system(&format!("command: {command:?}"));
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    (system, run, reader)
}

#[test]
fn they_end_with_all_components() {
    // One whose environment says nothing is seen as long as it has its parent.
    for command in STARTS.into_iter().chain(["env -i setsid sh stray & wait"]) {
        let (_system, run, reader) = start(command);
        run.signal("-TERM");
        let (status, _, err) = run.finish();
        reader.join().unwrap();
        assert_eq!(status.code(), Some(0), "{command}: {err}");
    }
}

#[test]
fn they_end_when_the_run_is_killed() {
    for command in STARTS {
        let (_system, run, reader) = start(command);
        run.signal("-KILL");
        reader.join().unwrap();
    }
}

#[test]
fn they_end_before_their_component_is_started_again() {
    for command in STARTS {
        let (system, mut run, reader) = start(command);
        let pipe = system.make_pipe("next");
        system.write("pipe", "next");
        let restart = system.scl(&["restart", "sensor"]).output();
        reader.join().unwrap();
        let reader = std::thread::spawn(move || wait_for_writers_to_end(&pipe));
        run.wait_for_line("sensor | ready");
        run.signal("-TERM");
        assert_eq!(run.finish().0.code(), Some(0), "{command}");
        reader.join().unwrap();
        assert_eq!(restart.unwrap().status.code(), Some(0), "{command}");
    }
}

#[test]
fn they_end_after_a_crash() {
    let (system, reader) = system(
        "restart: on_failure, restart_delay: 1ms, \
         command: 'if [ -e again ]; then echo again; exit 0; fi; touch again; setsid sh stray & read line < go; exit 3'",
    );
    let go = system.make_pipe("go");
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    std::fs::write(go, "\n").unwrap();
    reader.join().unwrap();
    run.wait_for_line("sensor | again");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn what_has_left_every_trace_ends_with_the_run() {
    let (system, reader) = system("command: 'env -i setsid sh stray & read line < go; exit 3'");
    let go = system.make_pipe("go");
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | ready");
    std::fs::write(go, "\n").unwrap();
    assert_eq!(run.finish().0.code(), Some(1));
    reader.join().unwrap();
}

#[test]
fn what_does_not_end_is_killed() {
    let (system, reader) = system("command: 'setsid env sh -c \"trap : TERM; . ./stray\" & wait', stop_within: 100ms");
    // `tail` would take the signal.
    system.write("stray", "exec 3>alive; echo ready; while :; do sleep 1000 & wait; done");
    let mut run = system.start(&[]);
    run.wait_for_line("sensor | ready");
    run.signal("-TERM");
    let (status, _, err) = run.finish();
    reader.join().unwrap();
    assert!(err.contains("sensor  not stopped within 100ms, killed\n"), "{err}");
    assert_eq!(status.code(), Some(1), "{err}");
}

#[test]
fn what_a_build_leaves_behind_goes_on() {
    let (system, reader) = system("build: 'setsid sh server >/dev/null 2>&1 & read line < built', command: 'echo'");
    system.write("server", "exec 3>alive; echo > built; read line < go");
    system.make_pipe("built");
    let go = system.make_pipe("go");
    let output = system.run(&[]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    // Waits for its reader.
    std::fs::write(go, "\n").unwrap();
    reader.join().unwrap();
}

/// The guard of the inner one is killed, too.
#[test]
fn those_of_a_run_in_a_run_end_when_the_outer_one_is_killed() {
    let scl = env!("CARGO_BIN_EXE_scl");
    let (system, reader) = system(&format!("command: [env, SCL_SYSTEM=inner, {scl:?}, run, inner.yaml]"));
    system.write("inner.yaml", &format!("components: {{sensor: {{command: {:?}}}}}", STARTS[0]));
    let mut run = system.start(&NO_END_OF_GRACE);
    run.wait_for_line("sensor | sensor | ready");
    run.signal("-KILL");
    reader.join().unwrap();
}

/// `scl run` may be the first process of a container.
#[test]
fn orphans_are_reaped() {
    let system = System::of(&[("sensor", &format!("for i in 1 2 3; do (sh -c 'echo $$' &); done; {FOREVER}"))]);
    let mut run = system.start(&NO_END_OF_GRACE);
    for _ in 0..3 {
        let line = run.next_line().unwrap();
        let process = Path::new("/proc").join(line.strip_prefix("sensor | ").unwrap());
        while process.exists() {}
    }
    run.signal("-TERM");
    assert_eq!(run.finish().0.code(), Some(0));
}
