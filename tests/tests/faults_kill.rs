//! `kill -9` of each kind of peer while messages flow: the others get everything, and the next program goes on.

use scl_tests::{Place, Process, on_each_transport};

const PEER: &str = env!("CARGO_BIN_EXE_peer");

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

#[test]
fn a_subscriber_that_is_killed_costs_the_others_nothing() {
    on_each_transport(|place| {
        let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
        for round in 0..5 {
            let watcher = open(&place, "watcher");
            source.does("peers 3", "peers");
            let (from, to) = (round * 500, (round + 1) * 500);
            source.tell(&format!("publish {from} {to} 2000"));
            watcher.kill();
            source.says("published");
            sink.does("receive 500", &format!("{from}..{to}"));
            source.does("peers 2", "peers");
        }
        let mut watcher = open(&place, "watcher");
        source.does("publish 9000 9010", "published");
        watcher.tell("receive_up_to 9009");
        assert!(watcher.line().ends_with("9000..9010"));
    });
}

#[test]
fn a_publisher_that_is_killed_is_followed_by_the_next() {
    on_each_transport(|place| {
        let mut sink = open(&place, "sink");
        let mut watcher = open(&place, "watcher");
        for round in 1..5 {
            let mut source = open(&place, "source");
            source.tell("publish 0 1000000 2000");
            // It is in the midst of it as soon as the first message is here.
            sink.tell("receive 1");
            sink.line();
            source.kill();
            let mut source = open(&place, "source");
            let last = round * 10_000_000;
            source.does(&format!("publish {last} {}", last + 1), "published");
            for receiver in [&mut sink, &mut watcher] {
                receiver.tell(&format!("receive_up_to {last}"));
                let received = receiver.line();
                assert!(received.ends_with(&format!("{last}..{}", last + 1)), "{received}");
            }
            source.kill();
        }
    });
}

#[test]
fn a_pusher_that_is_killed_is_followed_by_the_next() {
    on_each_transport(|place| {
        for _ in 0..5 {
            let mut sink = open(&place, "sink");
            let mut source = open(&place, "source");
            source.tell("push 0 1000000 2000");
            sink.tell("pull 10");
            sink.says("0..10");
            source.kill();
            let mut source = open(&place, "source");
            source.does("push 5000000 5000001", "pushed");
            sink.tell("pull_up_to 5000000");
            let pulled = sink.line();
            // What the old one had sent may be overtaken by the new one's, on a connection of its own.
            let old = pulled.strip_suffix("5000000..5000001").expect("the new one's message comes").trim_end();
            let whole = old.is_empty() || old.starts_with("10..") && !old.contains(' ');
            assert!(whole, "what came is without gaps: {pulled}");
            source.kill();
            sink.kill();
        }
    });
}

#[test]
fn a_puller_that_is_killed_takes_only_what_was_on_its_way() {
    on_each_transport(|place| {
        let mut source = open(&place, "source");
        let mut sink = open(&place, "sink");
        source.tell("push 0 20000 2000");
        sink.does("pull 100", "0..100");
        sink.kill();
        let mut sink = open(&place, "sink");
        sink.tell("pull_up_to 19999");
        let pulled = sink.line();
        assert!(pulled.ends_with("..20000") && !pulled.contains(' '), "the rest comes without gaps: {pulled}");
        source.says("pushed");
    });
}

#[test]
fn a_requester_that_is_killed_leaves_the_replier_free_for_the_next() {
    on_each_transport(|place| {
        let mut sink = open(&place, "sink");
        for _ in 0..5 {
            let mut source = open(&place, "source");
            sink.tell("hear");
            source.tell("call 1");
            sink.says("heard");
            source.kill();
            let mut source = open(&place, "source");
            sink.tell("serve 1");
            source.does("call 4", "8");
            sink.says("served");
            // The answer for the one that is gone goes nowhere, and says so or not, but never blocks.
            sink.tell("answer_heard");
            sink.line();
            source.kill();
        }
    });
}

#[test]
fn a_replier_that_is_killed_is_followed_by_the_next() {
    on_each_transport(|place| {
        let mut source = open(&place, "source");
        for _ in 0..5 {
            let mut sink = open(&place, "sink");
            sink.tell("hear");
            source.tell("call 1");
            sink.says("heard");
            sink.kill();
            let said = source.line();
            assert!(said.contains("`sink.answer` went away"), "{said}");
            let mut sink = open(&place, "sink");
            sink.tell("serve 1");
            source.does("call 4", "8");
            sink.says("served");
            sink.kill();
        }
    });
}

#[test]
fn a_silent_connection_does_not_make_a_dead_subscriber_look_alive() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    let socket = place.socket("six", "source.readings--sink.readings.");
    // The first is there before the subscriber, the second comes after it.
    let before = std::os::unix::net::UnixStream::connect(&socket).expect("connected");
    let sink = open(&place, "sink");
    source.does("ready 30000", "ready");
    let after = std::os::unix::net::UnixStream::connect(&socket).expect("connected");
    sink.kill();
    source.does("disconnected", "disconnected");
    source.does("publish 0 50", "published");
    let mut sink = open(&place, "sink");
    sink.does("receive 50", "0..50");
    drop(before);
    source.does("publish 50 60", "published");
    sink.does("receive 10", "50..60");
    drop(after);
    source.does("publish 60 70", "published");
    sink.does("receive 10", "60..70");
}
