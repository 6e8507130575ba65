//! Every kind of gate between separate processes, over Unix sockets and over TCP, whichever starts first.

use crate::programs::open;
use scl_tests::{System, on_each_transport};

#[test]
fn every_kind_of_gate_carries_messages() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        source.ask("publish 0 100", "published");
        sink.ask("receive 100", "0..100");
        source.ask("lossless 0 5", "published");
        sink.ask("receive_lossless 5", "0..5");
        source.ask("push 0 100", "pushed");
        sink.ask("pull 100", "0..100");
        sink.tell("serve 1");
        source.ask("call 21", "42");
        sink.expect("served");
    });
}

#[test]
fn the_first_messages_wait_for_a_peer_that_starts_later() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        source.ask("publish 0 50", "published");
        source.ask("push 0 50", "pushed");
        let mut sink = open(&system, "sink");
        sink.ask("receive 50", "0..50");
        sink.ask("newest", "49");
        sink.ask("pull 50", "0..50");
    });
}

#[test]
fn peers_reconnect_after_either_was_killed() {
    on_each_transport(|system| {
        let (mut source, sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        sink.kill();
        source.ask("disconnected", "disconnected");
        source.ask("publish 0 50", "published");
        let mut sink = open(&system, "sink");
        sink.ask("receive 50", "0..50");
        sink.tell("serve 1");
        source.ask("call 4", "8");
        sink.expect("served");
        source.ask("push 7 9", "pushed");
        sink.ask("pull 2", "7..9");

        source.kill();
        sink.tell("receive 3");
        let mut source = open(&system, "source");
        source.ask("publish 5 8", "published");
        sink.expect("5..8");
        source.ask("push 1 3", "pushed");
        sink.ask("pull 2", "1..3");
    });
}

#[test]
fn a_paused_subscriber_affects_only_itself() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        let mut watcher = open(&system, "watcher");
        source.ask("peers 3", "peers");
        source.ask("publish 0 1", "published");
        watcher.ask("receive 1", "0..1");
        sink.ask("receive 1", "0..1");
        watcher.pause();
        // 20 MiB for a process that reads nothing: what its queue cannot hold is dropped, for this process alone.
        for round in 0..20 {
            let (from, to) = (1 + round * 100, 1 + (round + 1) * 100);
            source.ask(&format!("publish {from} {to} 10000"), "published");
            sink.ask("receive 100", &format!("{from}..{to}"));
        }
        watcher.resume();
        // The watcher gets what its queue and the publisher's for it held, up to the newest.
        watcher.tell("receive_up_to 2000");
        let received = watcher.next_line();
        assert!(received.ends_with("1001..2001"), "{received}");
        source.tell("stats");
        let stats = source.next_line();
        assert!(!stats.contains("dropped 0"), "every drop is counted: {stats}");
    });
}

#[test]
fn a_sender_with_backpressure_waits_and_loses_nothing() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        // 40 MiB are more than all buffers hold, so this ends only as the sink receives them.
        source.tell("lossless 0 4000 10000");
        sink.ask("receive_lossless 4000", "0..4000");
        source.expect("published");
    });
}

#[test]
fn try_send_names_the_peer_whose_queue_is_full() {
    let system = System::new();
    let mut source = open(&system, "source");
    for value in 0..10 {
        source.ask(&format!("try_lossless {value}"), "published");
    }
    source.tell("try_lossless 10");
    let error = source.next_line();
    for word in ["error: ", "`source.lossless`", "`sink.lossless`", "full"] {
        assert!(error.contains(word), "{error}");
    }
    let mut sink = open(&system, "sink");
    sink.ask("receive_lossless 10", "0..10");
    source.ask("try_lossless 10", "published");
    sink.ask("receive_lossless 1", "10..11");
}

#[test]
fn a_call_fails_when_its_replier_is_killed() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    sink.tell("take_request");
    source.tell("call 1");
    sink.expect("taken");
    sink.kill();
    let error = source.next_line();
    for word in ["error: ", "`source.question`", "`sink.answer`"] {
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn ready_names_the_peers_that_are_missing() {
    let system = System::new();
    let mut source = open(&system, "source");
    source.tell("ready 1");
    let error = source.next_line();
    for word in ["error: ", "component `source`", "not ready", "`sink.readings`", "not running"] {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
    assert!(!error.contains("watcher"), "an optional component is not waited for: {error}");
}

#[test]
fn closing_hands_over_what_was_published() {
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.get_ready();
    sink.tell("receive_lossless 1000");
    source.ask("lossless 0 1000 1000", "published");
    let exit = source.wait_for_exit();
    assert!(exit.status.success(), "{exit:?}");
    sink.expect("0..1000");
}

#[test]
fn messages_published_between_computations_are_written_at_once() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        source.get_ready();
        source.tell("publish_and_compute 0 100");
        // The source stops itself after the last one, so nothing can be written later.
        source.wait_until_stopped();
        sink.ask("receive 100", "0..100");
    });
}
