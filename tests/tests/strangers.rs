//! Plain ZeroMQ peers that do what ZeroMQ allows and SCL does not use: heartbeats, subscriptions to some messages. Hostile
//! peers are in `bad_input`.

use crate::programs::open;
use scl_tests::zmtp::{COMMAND, command, subscribe};
use scl_tests::{RawPeer, System, on_each_transport};

const READINGS: &str = "source.readings--sink.readings.";

#[test]
fn a_pong_carries_the_context_of_its_ping() {
    on_each_transport(|system| {
        let (_source, _sink) = (open(&system, "source"), open(&system, "sink"));
        let ends = [(READINGS, "SUB"), ("source.readings.tap", "SUB"), ("sink.jobs.", "PUSH"), ("sink.answer.", "REQ")];
        for (endpoint, socket_type) in ends {
            let mut peer = RawPeer::join(&system.address("six", endpoint), socket_type);
            peer.send(&command("PING", b"\x00\x01context")).expect("sent");
            let pong = peer.frame().unwrap_or_else(|error| panic!("no answer at {endpoint}: {error}"));
            assert_eq!((pong.flags, &*pong.body), (COMMAND, &b"\x04PONGcontext"[..]), "at {endpoint}");
        }
    });
}

#[test]
fn a_subscriber_gets_only_messages_that_start_with_its_prefix() {
    let system = System::new();
    let mut source = open(&system, "source");
    let mut subscriber = RawPeer::join(&system.address("six", READINGS), "SUB");
    // The beginning of a message with the number 5.
    subscriber.send(&subscribe(b"\x08\x05")).expect("sent");
    source.ask("peers 1", "peers");
    source.ask("publish 1 10", "published");
    source.ask("publish 5 6", "published");
    for _ in 0..2 {
        assert_eq!(subscriber.message().expect("a message"), [b"\x08\x05"]);
    }
}

#[test]
fn of_many_silent_connections_the_oldest_are_closed() {
    on_each_transport(|system| {
        let mut source = open(&system, "source");
        let address = system.address("six", READINGS);
        let mut silent: Vec<RawPeer> = (0..300).map(|_| RawPeer::connect(&address)).collect();
        silent[0].wait_until_closed();
        let _sink = open(&system, "sink");
        source.ask("ready 30000", "ready");
    });
}
