//! Every kind of gate between programs in C++ and in Rust, and between two programs in C++.

use super::build::{Build, binding, program};
use crate::programs::{PEER, open_with};
use scl_tests::{Process, System, on_each_transport};
use std::path::Path;
use std::sync::LazyLock;

static CPP: LazyLock<String> = LazyLock::new(|| cpp(Build::Plain));

fn cpp(build: Build) -> String {
    let topology = Path::new(env!("CARGO_MANIFEST_DIR")).join("topologies/six_kinds.yaml");
    let path = program(&binding().join("tests/programs/peer.cpp"), &topology, build);
    path.to_str().expect("a path of ASCII").to_owned()
}

/// The programs for `source` and `sink`; at least one is in C++.
fn pairs() -> [(&'static str, &'static str); 3] {
    [(&CPP, PEER), (PEER, &CPP), (&CPP, &CPP)]
}

fn open(system: &System, (source, sink): (&str, &str)) -> (Process, Process) {
    (open_with(system, source, "source"), open_with(system, sink, "sink"))
}

/// The promise: typed gates of all six kinds carry the same messages as in Rust.
#[test]
fn every_kind_of_gate_carries_messages() {
    on_each_transport(|system| {
        for pair in pairs() {
            let (mut source, mut sink) = open(&system, pair);
            exchange(&mut source, &mut sink);
            source.kill();
            sink.kill();
        }
    });
}

/// The promise: neither leaks nor undefined behaviour in any of the calls.
#[test]
fn the_address_sanitizer_finds_nothing() {
    let checked = cpp(Build::Address);
    for pair in [(&*checked, PEER), (PEER, &*checked)] {
        let system = System::new();
        let (mut source, mut sink) = open(&system, pair);
        exchange(&mut source, &mut sink);
        for process in [source, sink] {
            let exit = process.wait_for_exit();
            assert_eq!(exit.code(), 0, "{exit:?}");
        }
    }
}

#[test]
fn peers_reconnect_after_either_was_killed() {
    for pair in pairs() {
        let system = System::new();
        let (mut source, sink) = open(&system, pair);
        source.get_ready();
        sink.kill();
        let mut sink = open_with(&system, pair.1, "sink");
        source.get_ready();
        exchange(&mut source, &mut sink);
        source.kill();
        let mut source = open_with(&system, pair.0, "source");
        exchange(&mut source, &mut sink);
    }
}

#[test]
fn the_first_messages_wait_for_a_peer_that_starts_later() {
    for pair in pairs() {
        let system = System::new();
        let mut source = open_with(&system, pair.0, "source");
        source.ask("publish 0 50", "published");
        source.ask("push 0 50", "pushed");
        let mut sink = open_with(&system, pair.1, "sink");
        sink.ask("receive 50", "0..50");
        sink.ask("newest", "49");
        sink.ask("pull 50", "0..50");
    }
}

/// The promise: leaving `main` hands over what was sent, by the destructor alone.
#[test]
fn the_destructor_hands_over_what_was_sent() {
    let system = System::new();
    let (mut source, mut sink) = open(&system, (&CPP, PEER));
    source.get_ready();
    sink.tell("receive_lossless 1000");
    source.ask("lossless 0 1000 1000", "published");
    let exit = source.wait_for_exit();
    assert!(exit.status.success() && exit.log.is_empty(), "{exit:?}");
    sink.expect("0..1000");
}

/// The promise: what the destructor cannot hand over is noted in the log, and nothing is thrown.
#[test]
fn the_destructor_notes_what_was_not_taken() {
    let system = System::new();
    let (mut source, sink) = open(&system, (&CPP, PEER));
    source.get_ready();
    sink.pause();
    source.ask("lossless 0 10", "published");
    let exit = source.wait_for_exit();
    assert_eq!(exit.code(), 0, "{exit:?}");
    assert!(exit.text().contains("WARN") && exit.text().contains("`sink.lossless`"), "{exit:?}");
}

#[test]
fn a_full_queue_is_told_by_name() {
    let system = System::new();
    let mut source = open_with(&system, &CPP, "source");
    for value in 0..10 {
        source.ask(&format!("try_lossless {value}"), "published");
    }
    source.ask("try_lossless 10", "full");
    assert_words(&mut source, "lossless_within 10 5", &["`source.lossless`", "`sink.lossless`", "full"]);
    let mut sink = open_with(&system, PEER, "sink");
    sink.ask("receive_lossless 10", "0..10");
    source.ask("lossless_within 10 30000", "published");
    sink.ask("receive_lossless 1", "10..11");
}

#[test]
fn a_call_fails_when_its_replier_is_killed_or_late() {
    let system = System::new();
    let (mut source, mut sink) = open(&system, (&CPP, PEER));
    source.get_ready();
    assert_words(&mut source, "call_within 1 20", &["`source.question`", "`sink.answer`", "within "]);
    sink.ask("take_request", "taken");
    source.tell("call 1");
    sink.ask("take_request", "taken");
    sink.kill();
    assert_error(&source.next_line(), &["`source.question`", "`sink.answer`", "disconnected"]);
}

#[test]
fn requests_are_answered_later_and_together() {
    let system = System::new();
    let (mut source, mut sink) = open(&system, (PEER, &CPP));
    source.get_ready();
    source.tell("call 4");
    sink.ask("take_request", "taken");
    sink.ask("answer_taken", "answered");
    source.expect("8");
    source.tell("call 5");
    sink.ask("take_request", "taken");
    source.kill();
    let mut source = open_with(&system, PEER, "source");
    source.get_ready();
    assert_words(&mut sink, "answer_taken", &["`sink.answer`", "disconnected"]);
}

#[test]
fn ready_names_the_peers_that_are_missing() {
    let system = System::new();
    let mut source = open_with(&system, &CPP, "source");
    assert_words(&mut source, "ready 1", &["component `source`", "`sink.readings`", "not running"]);
}

fn exchange(source: &mut Process, sink: &mut Process) {
    source.get_ready();
    sink.get_ready();
    source.ask("publish 0 100", "published");
    sink.ask("receive 100", "0..100");
    source.ask("lossless 0 5", "published");
    sink.ask("receive_lossless 5", "0..5");
    source.ask("push 0 100", "pushed");
    sink.ask("pull 100", "0..100");
    sink.ask("newest", "99");
    sink.tell("serve 2");
    source.ask("call 21", "42");
    source.ask("call 4", "8");
    sink.expect("served");
    sink.expect("served");
}

#[track_caller]
fn assert_words(process: &mut Process, command: &str, words: &[&str]) {
    process.tell(command);
    assert_error(&process.next_line(), words);
}

#[track_caller]
fn assert_error(line: &str, words: &[&str]) {
    for word in [&["error: "], words].concat() {
        assert!(line.contains(word), "`{word}` is not in: {line}");
    }
}
