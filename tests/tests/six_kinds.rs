//! All kinds of gates between separate processes, over Unix sockets and over TCP, whatever starts first.

use scl_tests::{Place, Process, on_each_transport};

const PEER: &str = env!("CARGO_BIN_EXE_peer");

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

#[test]
fn every_kind_of_gate_carries_messages() {
    on_each_transport(|place| {
        let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
        source.does("ready 30000", "ready");
        source.does("publish 0 100", "published");
        sink.does("receive 100", "0..100");
        source.does("lossless 0 5", "published");
        sink.does("receive_lossless 5", "0..5");
        source.does("push 0 100", "pushed");
        sink.does("pull 100", "0..100");
        sink.tell("serve 1");
        source.does("call 21", "42");
        sink.says("served");
    });
}

#[test]
fn the_first_messages_wait_for_a_peer_that_starts_later() {
    on_each_transport(|place| {
        let mut source = open(&place, "source");
        source.does("publish 0 50", "published");
        source.does("push 0 50", "pushed");
        let mut sink = open(&place, "sink");
        sink.does("receive 50", "0..50");
        sink.does("newest", "49");
        sink.does("pull 50", "0..50");
    });
}

#[test]
fn a_peer_that_was_killed_is_found_again() {
    on_each_transport(|place| {
        let (mut source, sink) = (open(&place, "source"), open(&place, "sink"));
        source.does("ready 30000", "ready");
        sink.kill();
        source.does("disconnected", "disconnected");
        source.does("publish 0 50", "published");
        let mut sink = open(&place, "sink");
        sink.does("receive 50", "0..50");
        sink.tell("serve 1");
        source.does("call 4", "8");
        sink.says("served");
        source.does("push 7 9", "pushed");
        sink.does("pull 2", "7..9");

        source.kill();
        sink.tell("receive 3");
        let mut source = open(&place, "source");
        source.does("publish 5 8", "published");
        sink.says("5..8");
        source.does("push 1 3", "pushed");
        sink.does("pull 2", "1..3");
    });
}

#[test]
fn a_stopped_subscriber_stops_nobody_else() {
    on_each_transport(|place| {
        let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
        let mut watcher = open(&place, "watcher");
        source.does("ready 30000", "ready");
        source.does("publish 0 1", "published");
        watcher.does("receive 1", "0..1");
        sink.does("receive 1", "0..1");
        watcher.stop();
        // 20 MiB to a process that takes nothing: what its queue does not hold is dropped, for it alone.
        for round in 0..20 {
            let (from, to) = (1 + round * 100, 1 + (round + 1) * 100);
            source.does(&format!("publish {from} {to} 10000"), "published");
            sink.does("receive 100", &format!("{from}..{to}"));
        }
        watcher.go_on();
        // The watcher goes on with what its connection and its queue held, in order, up to the newest.
        watcher.tell("receive_up_to 2000");
        let received = watcher.line();
        assert!(received.starts_with("1..") && received.ends_with("..2001"), "{received}");
        source.tell("stats");
        let stats = source.line();
        assert!(!stats.contains("dropped 0"), "every drop is counted: {stats}");
    });
}

#[test]
fn a_sender_with_backpressure_waits_and_loses_nothing() {
    on_each_transport(|place| {
        let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
        source.does("ready 30000", "ready");
        // 40 MiB are more than all buffers hold, so this ends only as the sink takes them.
        source.tell("lossless 0 4000 10000");
        sink.does("receive_lossless 4000", "0..4000");
        source.says("published");
    });
}

#[test]
fn a_full_queue_is_said_by_the_call_that_never_waits() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    for value in 0..10 {
        source.does(&format!("try_lossless {value}"), "published");
    }
    source.does(
        "try_lossless 10",
        "error: gate `source.lossless` would have to wait: the queue of `sink.lossless` is full; send later, or use `send`",
    );
    let mut sink = open(&place, "sink");
    sink.does("receive_lossless 10", "0..10");
    source.does("try_lossless 10", "published");
    sink.does("receive_lossless 1", "10..11");
}

#[test]
fn a_call_says_when_its_replier_goes_away() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    sink.tell("hear");
    source.tell("call 1");
    sink.says("heard");
    sink.kill();
    source.says(
        "error: gate `source.question` got no answer: `sink.answer` went away after it was asked; the next call waits \
         for its return",
    );
}

#[test]
fn who_is_missing_is_named() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    source.tell("ready 1");
    let said = source.line();
    assert!(said.starts_with("error: component `source` waited "), "{said}");
    assert!(said.contains("`sink.readings` (at gate `readings`)"), "{said}");
    assert!(!said.contains("watcher"), "an optional component is not waited for: {said}");
}

#[test]
fn what_was_published_is_handed_over_before_a_program_ends() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    sink.tell("receive_lossless 1000");
    source.does("lossless 0 1000 1000", "published");
    let (status, said) = source.ends();
    assert!(status.success(), "{said:?}");
    sink.says("0..1000");
}

#[test]
fn what_is_published_between_computations_is_not_kept_for_later() {
    on_each_transport(|place| {
        let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
        source.does("ready 30000", "ready");
        source.tell("compute_and_publish 0 100");
        // The source stands still by then.
        sink.does("receive 100", "0..100");
    });
}
