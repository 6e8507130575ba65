//! SIGTERM and Ctrl-C: every C++ program ends cleanly at its next call to a gate, without a `catch` of its own.

use super::build::{Build, binding, program};
use crate::programs::TWIN;
use rustix::process::Signal;
use scl_tests::{Process, System};
use std::path::Path;

const SIGNALS: [Signal; 2] = [Signal::TERM, Signal::INT];
/// Calls that a stop request ends with an exception.
const THROWING: [&str; 10] =
    ["send", "try_send", "receive", "receive_within", "log_errors", "pull", "serve", "wait", "thread", "ready_never"];
/// Loops that end by themselves.
const LOOPS: [&str; 4] = ["for_messages", "for_requests", "poll", "call"];

/// The promise: whatever a program does, with or without a peer, a signal ends it, and that is a success.
#[test]
fn every_program_ends_cleanly() {
    for has_peer in [false, true] {
        let system = System::new();
        let _right = has_peer.then(|| start_right(&system));
        for task in THROWING.iter().chain(&LOOPS) {
            for signal in SIGNALS {
                let program = start(&system, Build::Plain, task);
                program.signal(signal);
                let exit = program.wait_for_exit();
                assert_eq!(exit.code(), 0, "{task}, {signal:?}, {has_peer}: {exit:?}");
                assert!(!exit.text().contains("error"), "{task}, {signal:?}, {has_peer}: {exit:?}");
                // Destructors run where the program ends by itself. An exception that nobody catches unwinds nothing.
                assert_eq!(exit.text().contains("unwound"), LOOPS.contains(task), "{task}: {exit:?}");
            }
        }
    }
}

/// The promise: a program that catches `scl::Stopped` is unwound.
#[test]
fn a_program_that_catches_the_stop_is_unwound() {
    let system = System::new();
    for task in THROWING.iter().filter(|task| **task != "thread") {
        let program = start(&system, Build::Plain, &format!("guarded_{task}"));
        program.signal(Signal::TERM);
        let exit = program.wait_for_exit();
        assert_eq!((exit.code(), &exit.output[..]), (0, &["unwound".to_owned(), "stopped".to_owned()][..]), "{task}");
    }
}

/// The promise: a program that handles the request itself can still send, and the message arrives.
#[test]
fn motors_off_arrives() {
    let system = System::new();
    let mut right = start_right(&system);
    for signal in SIGNALS {
        let program = start(&system, Build::Plain, "handled");
        right.tell("jobs 4242");
        program.signal(signal);
        right.expect("4242..4243");
        let exit = program.wait_for_exit();
        assert_eq!(exit.code(), 0, "{signal:?}: {exit:?}");
    }
}

/// The promise: what an uncaught stop leaves behind is no leak, also while other threads wait.
#[test]
fn sanitizers_find_nothing_in_a_stopped_program() {
    let system = System::new();
    for task in ["receive", "thread", "for_requests", "send"] {
        let program = start(&system, Build::Address, task);
        program.signal(Signal::TERM);
        let exit = program.wait_for_exit();
        assert_eq!(exit.code(), 0, "{task}: {exit:?}");
    }
}

/// The promise: an error that nobody catches ends the program with its text and exit code 1, as in Rust.
#[test]
fn an_uncaught_error_is_told() {
    let system = System::new();
    let _first = start(&system, Build::Plain, "receive");
    let exit = run(&system, Build::Plain, "receive").wait_for_exit();
    assert_eq!(exit.code(), 1, "{exit:?}");
    for word in ["error: component `left`", "already running as process"] {
        assert!(exit.text().contains(word), "{exit:?}");
    }
}

/// The promise: what was sent before an uncaught error is handed over, or noted in the log.
#[test]
fn an_uncaught_error_loses_no_message_in_silence() {
    let system = System::new();
    let mut right = start_right(&system);
    let mut left = start(&system, Build::Plain, "burst");
    left.expect("ready");
    right.pause();
    left.tell("go");
    let exit = left.wait_for_exit();
    assert_eq!(exit.code(), 1, "{exit:?}");
    for words in ["error: after a burst", "WARN", "`right.jobs_in`"] {
        assert!(exit.text().contains(words), "`{words}`: {exit:?}");
    }
    right.resume();
    right.ask("jobs 99", "0..100");
}

/// The promise: other exceptions, and the handler that the program has set, are left alone.
#[test]
fn exceptions_of_the_program_end_it_as_usual() {
    let system = System::new();
    let exit = run(&system, Build::Plain, "other_exception").wait_for_exit();
    assert_eq!(exit.code(), 128 + 6, "{exit:?}");
    assert!(exit.text().contains("not of SCL"), "{exit:?}");
    let exit = run(&system, Build::Plain, "own_handler").wait_for_exit();
    assert_eq!(exit.code(), 7, "{exit:?}");
    assert!(exit.text().contains("the handler of the program"), "{exit:?}");
}

fn start(system: &System, build: Build, task: &str) -> Process {
    let mut program = run(system, build, task);
    program.expect("running");
    program
}

fn run(system: &System, build: Build, task: &str) -> Process {
    let topology = Path::new(env!("CARGO_MANIFEST_DIR")).join("topologies/twins.yaml");
    let path = program(&binding().join("tests/programs/signalled.cpp"), &topology, build);
    system.start(path.to_str().expect("a path of ASCII"), &[task])
}

fn start_right(system: &System) -> Process {
    let mut right = system.start(TWIN, &["right", "current_thread"]);
    right.expect("open");
    right
}
