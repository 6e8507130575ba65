//! SIGTERM and SIGINT: calls that wait end with `SCL_STOPPED`, unless the program handles the request itself.

use crate::programs::{Build, Program, expect_success, on_each_build};
use rustix::process::Signal;
use scl_tests::{Process, System};

const SIGNALS: [Signal; 2] = [Signal::TERM, Signal::INT];

/// The promise: whatever a program waits for, a signal ends it, and the program then ends by itself.
#[test]
fn a_signal_ends_every_call_that_waits() {
    for build in [Build::Plain, Build::Address] {
        let calls = [
            "recv values -1",
            "recv values 600000000000",
            "into values -1 9",
            "call question -1 x",
            "take answer -1",
            "wait -1 values work",
            "ready -1",
        ];
        for (index, call) in calls.iter().enumerate() {
            let program = Program::new(System::new(), build);
            let mut c = program.commands();
            c.tell(call);
            c.signal(SIGNALS[index % 2]);
            let stopped = c.next_line();
            assert!(stopped.starts_with("SCL_STOPPED: ") && stopped.ends_with("stop requested"), "{call}: {stopped}");
            c.ask("stopping", "yes");
            // Later calls fail, too, so that a loop ends wherever the signal met it.
            for call in ["send out 0 x", "recv values 0", "latest values"] {
                c.tell(call);
                c.expect_containing("SCL_STOPPED");
            }
            expect_success(c);
        }
    }
}

/// The promise: a program that handles the request can still send, and is asked to close.
#[test]
fn motors_off_arrives() {
    on_each_build(|program| {
        let (mut peer, mut c) = (program.peer(), program.commands());
        let mut out = peer.subscriber("out").unwrap();
        c.ask("ready 60000000000", "");
        c.ask("handle_stop", "");
        c.ask("stopping", "no");
        c.signal(Signal::TERM);
        wait_for_stop(&mut c);
        c.ask("send out -1 motors off", "");
        c.ask("close 60000000000", "");
        assert_eq!(out.recv_blocking().unwrap(), "motors off");
        expect_success(c);
    });
}

/// The promise: a program that ignores the request is ended with 128 + the signal's number.
#[test]
fn the_grace_period_ends() {
    for (signal, code) in [(Signal::TERM, 143), (Signal::INT, 130)] {
        let program = Program::new(System::new(), Build::Plain);
        let mut c = program.start_with("commands", &["program", ""], &[("SCL_STOP_WITHIN", "100ms")]);
        c.expect("open");
        c.signal(signal);
        // It waits for its next command, with its input open.
        while c.is_running() {}
        assert_eq!(c.wait_for_exit().code(), code);
    }
}

/// The promise: with `"signals": false`, signals are the program's own business.
#[test]
fn signals_can_be_left_alone() {
    let program = Program::new(System::new(), Build::Plain);
    let mut c = program.start("commands", &["program", r#"{"signals": false}"#]);
    c.expect("open");
    c.ask("stopping", "no");
    c.signal(Signal::TERM);
    let exit = c.wait_for_exit();
    assert_eq!((exit.status.code(), exit.code()), (None, 143), "ended by the signal itself");
}

/// The signal is handled by another thread, at some time.
fn wait_for_stop(c: &mut Process) {
    loop {
        c.tell("stopping");
        if c.next_line() == "yes" {
            return;
        }
    }
}
