//! SIGKILL for each kind of peer while messages flow: the others get everything, and a successor takes over.

use crate::programs::open;
use scl::TransportKind;
use scl_tests::{Stream, System, on_each_transport};
use std::fs::{read, read_dir, write};
use std::path::PathBuf;

#[test]
fn a_killed_subscriber_costs_the_others_nothing() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        for round in 0..5 {
            let watcher = open(&system, "watcher");
            source.ask("peers 3", "peers");
            let (from, to) = (round * 500, (round + 1) * 500);
            source.tell(&format!("publish {from} {to} 2000"));
            watcher.kill();
            source.expect("published");
            sink.ask("receive 500", &format!("{from}..{to}"));
            source.ask("peers 2", "peers");
        }
        let mut watcher = open(&system, "watcher");
        source.ask("publish 9000 9010", "published");
        watcher.tell("receive_up_to 9009");
        let received = watcher.next_line();
        assert!(received.ends_with("9000..9010"), "{received}");
    });
}

#[test]
fn a_killed_publisher_is_replaced_by_its_successor() {
    on_each_transport(|system| {
        let mut sink = open(&system, "sink");
        let mut watcher = open(&system, "watcher");
        for round in 1..5 {
            let mut source = open(&system, "source");
            source.tell("publish 0 1000000 2000");
            // Once the first message has arrived, it is busy publishing.
            sink.tell("receive 1");
            sink.next_line();
            source.kill();
            let mut source = open(&system, "source");
            let last = round * 10_000_000;
            source.ask(&format!("publish {last} {}", last + 1), "published");
            for receiver in [&mut sink, &mut watcher] {
                receiver.tell(&format!("receive_up_to {last}"));
                let received = receiver.next_line();
                assert!(received.ends_with(&format!("{last}..{}", last + 1)), "{received}");
            }
            source.kill();
        }
    });
}

#[test]
fn a_killed_pusher_is_replaced_by_its_successor() {
    on_each_transport(|system| {
        for _ in 0..5 {
            let mut sink = open(&system, "sink");
            let mut source = open(&system, "source");
            source.tell("push 0 1000000 2000");
            sink.tell("pull 10");
            sink.expect("0..10");
            source.kill();
            let mut source = open(&system, "source");
            source.ask("push 5000000 5000001", "pushed");
            sink.tell("pull_up_to 5000000");
            let pulled = sink.next_line();
            // Each pusher has a connection of its own, so the new one's message may overtake the old one's.
            let old = pulled.strip_suffix("5000000..5000001").expect("the successor's message").trim_end();
            let without_gaps = old.is_empty() || old.starts_with("10..") && !old.contains(' ');
            assert!(without_gaps, "{pulled}");
            source.kill();
            sink.kill();
        }
    });
}

#[test]
fn a_killed_puller_takes_only_what_was_on_its_way() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let mut sink = open(&system, "sink");
        source.tell("push 0 20000 2000");
        sink.ask("pull 100", "0..100");
        sink.kill();
        let mut sink = open(&system, "sink");
        sink.tell("pull_up_to 19999");
        let pulled = sink.next_line();
        assert!(pulled.ends_with("..20000") && !pulled.contains(' '), "the rest arrives without gaps: {pulled}");
        source.expect("pushed");
    });
}

#[test]
fn a_killed_requester_leaves_the_replier_free_for_the_next() {
    on_each_transport(|system| {
        let mut sink = open(&system, "sink");
        for _ in 0..5 {
            let mut source = open(&system, "source");
            sink.tell("take_request");
            source.tell("call 1");
            sink.expect("taken");
            source.kill();
            let mut source = open(&system, "source");
            sink.tell("serve 1");
            source.ask("call 4", "8");
            sink.expect("served");
            // The reply to the dead requester succeeds or fails, but never blocks.
            sink.tell("answer_taken");
            sink.next_line();
            source.kill();
        }
    });
}

#[test]
fn a_killed_replier_is_replaced_by_its_successor() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        for _ in 0..5 {
            let mut sink = open(&system, "sink");
            sink.tell("take_request");
            source.tell("call 1");
            sink.expect("taken");
            sink.kill();
            let error = source.next_line();
            assert!(error.starts_with("error: ") && error.contains("`sink.answer`"), "{error}");
            let mut sink = open(&system, "sink");
            sink.tell("serve 1");
            source.ask("call 4", "8");
            sink.expect("served");
            sink.kill();
        }
    });
}

#[test]
fn a_silent_connection_does_not_make_a_dead_subscriber_look_alive() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let address = system.address("six", "source.readings--sink.readings.");
        let connect = || Stream::connect(&address).expect("connected");
        let before = connect();
        let sink = open(&system, "sink");
        source.get_ready();
        let after = connect();
        sink.kill();
        source.ask("disconnected", "disconnected");
        source.ask("publish 0 50", "published");
        let mut sink = open(&system, "sink");
        sink.ask("receive 50", "0..50");
        drop(before);
        source.ask("publish 50 60", "published");
        sink.ask("receive 10", "50..60");
        drop(after);
        source.ask("publish 60 70", "published");
        sink.ask("receive 10", "60..70");
    });
}

/// The promise: whoever listens at the port of a program that was killed, its peers do not take him for it.
#[test]
fn an_address_that_was_left_behind_leads_to_no_other_end() {
    let system = System::over(TransportKind::Tcp);
    let mut source = open(&system, "source");
    let address = address_file(&system, "source.readings--sink.readings.");
    let right = read(&address).expect("an address");
    let other = address_file(&system, "source.readings--watcher.readings.");
    write(&address, read(other).expect("an address")).expect("an address is left behind");
    let mut sink = open(&system, "sink");
    sink.tell("ready 1000");
    let answer = sink.next_line();
    assert!(answer.contains("source.readings"), "connected to another end: {answer}");
    write(&address, right).expect("the right address");
    sink.get_ready();
    let mut watcher = open(&system, "watcher");
    source.ask("peers 3", "peers");
    source.ask("publish 0 10", "published");
    for receiver in [&mut sink, &mut watcher] {
        receiver.ask("receive 10", "0..10");
    }
}

fn address_file(system: &System, endpoint: &str) -> PathBuf {
    let files = read_dir(system.runtime_dir().join("six")).expect("the system's folder");
    let mut paths = files.map(|file| file.expect("a file").path());
    let is_wanted = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(endpoint) && name.ends_with(".tcp")
    };
    paths.find(is_wanted).expect("an address file")
}
