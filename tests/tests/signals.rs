//! SIGTERM and SIGINT end every program at its next call to a gate; a program may also end itself, within a limit.

use crate::programs::{SIGNALLED, TWIN};
use rustix::process::Signal;
use scl_tests::{Process, System};

const MODES: [&str; 2] = ["async", "blocking"];
const SIGNALS: [Signal; 2] = [Signal::TERM, Signal::INT];
const TASKS: [&str; 6] = ["send", "try_send", "receive", "pull", "call", "serve"];

/// The promise: whatever a program does, waiting or not, with or without a peer, a signal ends it, and that is a
/// success.
#[test]
fn every_program_ends_cleanly() {
    for has_peer in [false, true] {
        let system = System::new();
        let _right = has_peer.then(|| start_right(&system));
        for mode in MODES {
            for task in TASKS {
                for signal in SIGNALS {
                    let program = start(&system, &[mode, task], &[]);
                    program.signal(signal);
                    let exit = program.wait_for_exit();
                    assert_eq!(exit.code(), 0, "{mode}, {task}, {signal:?}, {has_peer}: {exit:?}");
                    assert!(!exit.text().contains("error"), "{mode}, {task}, {signal:?}, {has_peer}: {exit:?}");
                }
            }
        }
    }
}

/// The promise: a program that handles the request can still send, the message arrives, and the exit code is 0.
#[test]
fn motors_off_arrives() {
    let system = System::new();
    let mut right = start_right(&system);
    for mode in MODES {
        for task in ["motors_off", "motors_off_beside"] {
            for signal in SIGNALS {
                let program = start(&system, &[mode, task], &[]);
                right.tell("jobs 4242");
                program.signal(signal);
                assert_eq!(right.next_line(), "4242..4243", "{mode}, {task}, {signal:?}");
                let exit = program.wait_for_exit();
                assert_eq!(exit.code(), 0, "{mode}, {task}, {signal:?}: {exit:?}");
            }
        }
    }
}

/// The promise: a program that does not return in time is ended with 128 + the signal's number.
#[test]
fn a_program_that_ignores_the_request_is_ended_after_the_grace_period() {
    let system = System::new();
    for mode in MODES {
        for task in ["ignore", "ask_once", "compute"] {
            for (signal, code) in [(Signal::TERM, 143), (Signal::INT, 130)] {
                let program = start(&system, &[mode, task], &[("SCL_STOP_WITHIN", "200ms")]);
                program.signal(signal);
                assert_eq!(program.wait_for_exit().code(), code, "{mode}, {task}, {signal:?}");
            }
        }
    }
}

/// The promise: a second signal ends the program at once, long before the grace period is over.
#[test]
fn a_second_signal_ends_a_program_at_once() {
    let system = System::new();
    for mode in MODES {
        for (signal, code) in [(Signal::TERM, 143), (Signal::INT, 130)] {
            let mut program = start(&system, &[mode, "ignore"], &[("SCL_STOP_WITHIN", "1000s")]);
            program.signal(Signal::INT);
            program.expect("stop requested");
            // Signals that follow at once belong to the first one.
            while program.is_running() {
                program.signal(signal);
            }
            assert_eq!(program.wait_for_exit().code(), code, "{mode}, {signal:?}");
        }
    }
}

/// The promise: what a connected peer does not take of the last messages is a log line after a stop request, and no
/// failure.
#[test]
fn what_is_not_taken_after_a_stop_request_is_a_log_line() {
    for mode in MODES {
        let system = System::new();
        let right = start_right(&system);
        let program = start(&system, &[mode, "motors_off"], &[]);
        right.pause();
        program.signal(Signal::TERM);
        let exit = program.wait_for_exit();
        assert_eq!(exit.code(), 0, "{mode}: {exit:?}");
        for words in ["WARN", "`right.jobs_in`"] {
            assert!(exit.text().contains(words), "{mode}: `{words}` is not in {exit:?}");
        }
    }
}

/// The promise: a peer that is running and not connected is not waited for after a stop request, because all programs
/// are stopping.
#[test]
fn a_peer_that_is_not_connected_is_not_waited_for_after_a_stop_request() {
    for mode in MODES {
        let system = System::new();
        let right = start_right(&system);
        right.pause();
        let program = start(&system, &[mode, "last_words"], &[]);
        program.signal(Signal::TERM);
        let exit = program.wait_for_exit();
        assert_eq!(exit.code(), 0, "{mode}: {exit:?}");
        // It would be named if it had been waited for.
        assert!(!exit.text().contains("WARN"), "{mode}: {exit:?}");
    }
}

fn start_right(system: &System) -> Process {
    let mut right = system.start(TWIN, &["right", "current_thread"]);
    right.expect("open");
    right
}

fn start(system: &System, arguments: &[&str], environment: &[(&str, &str)]) -> Process {
    let mut program = system.start_with(SIGNALLED, arguments, environment);
    program.expect("running");
    program
}
