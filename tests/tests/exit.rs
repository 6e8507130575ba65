//! Sending and exiting at once: running peers get everything, or the program says which did not.

use crate::programs::{LEAVER, TAKER, open, open_with};
use scl_tests::{Process, System};
use std::thread::park_timeout;
use std::time::Duration;

/// A gate that is dropped waits a second for its peers.
const LONGER_THAN_A_DROPPED_GATE: Duration = Duration::from_secs(2);

/// Every way to run and to end a program.
const WAYS: [(&str, &str); 14] = [
    ("current_thread", "close"),
    ("current_thread", "drop"),
    ("current_thread", "drop_after_runtime"),
    ("multi_thread", "close"),
    ("multi_thread", "drop"),
    ("multi_thread", "drop_after_runtime"),
    ("blocking", "close"),
    ("blocking", "drop"),
    ("blocking", "thread_local_close"),
    ("blocking", "thread_local_drop"),
    ("main", "close"),
    ("main", "return"),
    ("main_blocking", "close"),
    ("main_blocking", "return"),
];

/// The promise: a connected peer that reads gets everything.
#[test]
fn a_connected_peer_gets_everything() {
    for (runtime, ending) in WAYS {
        let system = System::new();
        let mut taker = open_with(&system, TAKER, "taker");
        taker.tell("values 999");
        let leaver = system.start(LEAVER, &[runtime, ending, "ready", "1000"]);
        taker.expect("0..1000");
        taker.ask("jobs 999", "0..1000");
        assert_succeeds(leaver, runtime, ending);
    }
}

/// The promise: a peer that is running, but does not get around to read, gets as much as its queue holds.
#[test]
fn a_connected_peer_that_reads_later_gets_everything() {
    for (runtime, ending) in WAYS {
        let system = System::new();
        let mut taker = open_with(&system, TAKER, "taker");
        assert_succeeds(system.start(LEAVER, &[runtime, ending, "ready", "1000"]), runtime, ending);
        taker.ask("values 999", "0..1000");
        taker.ask("jobs 999", "0..1000");
    }
}

/// The promise: so does a peer that is running but has not connected yet. It is paused until the program is leaving.
#[test]
fn a_peer_that_is_not_connected_yet_gets_everything() {
    for (runtime, ending) in WAYS {
        let system = System::new();
        let mut taker = open_with(&system, TAKER, "taker");
        taker.pause();
        let mut leaver = system.start(LEAVER, &[runtime, ending, "send", "1000"]);
        leaver.expect("leaving");
        taker.resume();
        taker.ask("values 999", "0..1000");
        taker.ask("jobs 999", "0..1000");
        assert_succeeds(leaver, runtime, ending);
    }
}

/// The promise: `close` waits as long as it is told to, and not as long as a gate that is dropped waits.
#[test]
fn close_waits_longer_than_a_gate_that_is_dropped() {
    let closing = WAYS.iter().filter(|(_, ending)| ending.ends_with("close"));
    let waiting: Vec<_> = closing
        .map(|(runtime, ending)| {
            let system = System::new();
            let taker = open_with(&system, TAKER, "taker");
            taker.pause();
            let mut leaver = system.start(LEAVER, &[runtime, ending, "send", "1000"]);
            leaver.expect("leaving");
            (runtime, ending, taker, leaver, system)
        })
        .collect();
    park_timeout(LONGER_THAN_A_DROPPED_GATE);
    for (runtime, ending, mut taker, leaver, _system) in waiting {
        taker.resume();
        taker.ask("values 999", "0..1000");
        taker.ask("jobs 999", "0..1000");
        assert_succeeds(leaver, runtime, ending);
    }
}

/// The same for peers that are connected.
#[test]
fn close_waits_for_connected_peers_that_are_paused() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    sink.pause();
    source.ask("publish 0 10", "published");
    source.ask("lossless 0 10", "published");
    source.ask("push 0 10", "pushed");
    source.close_input();
    park_timeout(LONGER_THAN_A_DROPPED_GATE);
    sink.resume();
    sink.ask("receive 10", "0..10");
    sink.ask("receive_lossless 10", "0..10");
    sink.ask("pull 10", "0..10");
    let exit = source.wait_for_exit();
    assert_eq!((exit.code(), &*exit.log), (0, &[][..]), "{exit:?}");
}

/// The promise: the wait for a peer that never connects is bounded, and the peers are named with what they did not get.
#[test]
fn a_running_peer_that_never_connects_is_named() {
    let ways = [
        ("current_thread", "close", 1),
        ("blocking", "close", 1),
        ("main", "close", 1),
        ("main", "return", 1),
        ("main_blocking", "return", 1),
    ];
    for (runtime, ending, code) in ways {
        let system = System::new();
        let taker = open_with(&system, TAKER, "taker");
        taker.pause();
        let arguments = [runtime, ending, "send", "1000"];
        let exit = system.start_with(LEAVER, &arguments, &[("CLOSE_TIMEOUT", "200")]).wait_for_exit();
        assert_eq!(exit.code(), code, "{runtime}, {ending}: {exit:?}");
        for word in ["taker.values", "taker.jobs", "1000"] {
            assert!(exit.text().contains(word), "{runtime}, {ending}: `{word}` is not in {exit:?}");
        }
    }
}

/// The promise: a peer that is not running at all is named. That is a failure only if its connection is lossless.
#[test]
fn a_peer_that_is_not_running_is_named() {
    for (runtime, ending) in [("main", "return"), ("main_blocking", "return")] {
        for (task, code) in [("publish", 0), ("send", 1)] {
            let exit = System::new().start(LEAVER, &[runtime, ending, task, "1000"]).wait_for_exit();
            assert_eq!(exit.code(), code, "{runtime}, {task}: {exit:?}");
            for word in ["taker.values", "not running", "1000"] {
                assert!(exit.text().contains(word), "{runtime}, {task}: `{word}` is not in {exit:?}");
            }
        }
    }
}

/// The promise: no way to end hangs or panics because nobody is there.
#[test]
fn without_peers_every_program_ends() {
    for (runtime, ending) in WAYS {
        let arguments = [runtime, ending, "send", "1000"];
        let exit = System::new().start_with(LEAVER, &arguments, &[("CLOSE_TIMEOUT", "200")]).wait_for_exit();
        assert!([0, 1].contains(&exit.code()), "{runtime}, {ending}: {exit:?}");
        assert!(!exit.text().contains("panicked"), "{runtime}, {ending}: {exit:?}");
    }
}

/// The promise: a peer with `when_full: wait` that did not get everything makes the exit code 1, one that did makes it
/// 0.
#[test]
fn a_slow_peer_with_backpressure_decides_about_the_exit_code() {
    for runtime in ["main", "main_blocking"] {
        for (reads, code) in [(true, 0), (false, 1)] {
            let system = System::new();
            let mut taker = open_with(&system, TAKER, "taker");
            let mut slow = open_with(&system, TAKER, "slow");
            taker.tell("values 9");
            slow.pause();
            let mut leaver = system.start(LEAVER, &[runtime, "return", "publish", "10"]);
            leaver.expect("leaving");
            if reads {
                slow.resume();
                (0..10).for_each(|value| slow.ask("next", &value.to_string()));
            }
            let exit = leaver.wait_for_exit();
            assert_eq!(exit.code(), code, "{runtime}, {reads}: {exit:?}");
            assert_eq!(exit.text().contains("slow.values"), !reads, "{runtime}: {exit:?}");
            taker.expect("0..10");
        }
    }
}

/// The promise: a panic of `main` is exit code 101.
#[test]
fn a_panic_is_exit_code_101() {
    for runtime in ["main", "main_blocking"] {
        let exit = System::new().start(LEAVER, &[runtime, "return", "panic"]).wait_for_exit();
        assert_eq!(exit.code(), 101, "{runtime}: {exit:?}");
        assert!(exit.text().contains("on purpose"), "{runtime}: {exit:?}");
    }
}

/// The promise: the last reply of a `rep` gate arrives.
#[test]
fn the_last_reply_arrives() {
    let system = System::new();
    let mut taker = open_with(&system, TAKER, "taker");
    for round in 0..5 {
        for (runtime, ending) in WAYS {
            taker.tell(&format!("call {round}"));
            assert_succeeds(system.start(LEAVER, &[runtime, ending, "reply"]), runtime, ending);
            let reply = taker.next_line();
            assert_eq!(reply, (2 * round).to_string(), "{runtime}, {ending}");
        }
    }
}

#[track_caller]
fn assert_succeeds(leaver: Process, runtime: &str, ending: &str) {
    let exit = leaver.wait_for_exit();
    assert_eq!(exit.code(), 0, "{runtime}, {ending}: {exit:?}");
    assert!(!exit.text().contains("panicked"), "{runtime}, {ending}: {exit:?}");
}
