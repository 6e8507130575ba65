//! Plain ZeroMQ peers that do what ZeroMQ allows and SCL does not use: heartbeats, subscriptions to some messages.
//! Hostile peers are in `bad_input`.

use crate::programs::open;
use scl_tests::zmtp::{COMMAND, command, message, subscribe};
use scl_tests::{Address, RawListener, RawPeer, System, on_each_transport};

const READINGS: &str = "source.readings--sink.readings.";
/// The message with the number 5.
const NUMBER: &[u8] = b"\x08\x05";

#[test]
fn a_pong_carries_the_context_of_its_ping() {
    on_each_transport(|system| {
        let (_source, _sink) = (open(&system, "source"), open(&system, "sink"));
        let ends = [(READINGS, "SUB"), ("source.readings.tap", "SUB"), ("sink.jobs.", "PUSH"), ("sink.answer.", "REQ")];
        for (endpoint, socket_type) in ends {
            ping(&mut RawPeer::join(&system.address("six", endpoint), socket_type));
        }
    });
}

/// The promise: a connection stays while the program handles what came over it, for as long as that takes.
#[test]
fn heartbeats_are_answered_after_each_call_of_the_program() {
    on_each_transport(|system| {
        let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
        let join = |endpoint, socket_type| RawPeer::join(&system.address("six", endpoint), socket_type);

        let mut requesters = [join("sink.answer.", "REQ"), join("sink.answer.", "REQ")];
        for _ in 0..3 {
            sink.tell("take_request");
            requesters[0].send(&message(&[b"", NUMBER])).expect("sent");
            sink.expect("taken");
            requesters.iter_mut().for_each(ping);
            sink.ask("answer_taken", "answered");
            requesters[0].message().expect("an answer");
            requesters.iter_mut().for_each(ping);
        }

        let mut pushers = [join("sink.jobs.", "PUSH"), join("sink.jobs.", "PUSH")];
        for _ in 0..3 {
            sink.tell("pull 1");
            pushers[0].send(&message(&[NUMBER])).expect("sent");
            sink.expect("5..6");
            pushers.iter_mut().for_each(ping);
        }

        let mut subscriber = join(READINGS, "SUB");
        subscriber.send(&subscribe(b"")).expect("sent");
        // Its answer tells that the subscription is in force.
        ping(&mut subscriber);
        for _ in 0..3 {
            source.ask("publish 5 6", "published");
            subscriber.message().expect("a message");
            ping(&mut subscriber);
        }
    });
}

#[test]
fn heartbeats_are_answered_after_each_call_to_a_plain_program() {
    let system = System::new();
    let sink = open(&system, "sink");
    let Address::Unix(path) = system.address("six", "sink.answer.") else { panic!("no path") };
    // It leaves its address to a plain program.
    sink.kill();
    std::fs::remove_file(&path).expect("an address");
    let listener = RawListener::unix(&path);
    let mut source = open(&system, "source");
    let mut replier = listener.accept();
    replier.handshake("REP").expect("a requester");
    for _ in 0..3 {
        source.tell("call 5");
        let request = replier.message().expect("a request");
        let envelope = &request[..request.len() - 1];
        let reply: Vec<&[u8]> = envelope.iter().map(Vec::as_slice).chain([NUMBER]).collect();
        replier.send(&message(&reply)).expect("sent");
        source.expect("5");
        ping(&mut replier);
    }
}

/// Sends a heartbeat, and reads its answer.
#[track_caller]
fn ping(peer: &mut RawPeer) {
    peer.send(&command("PING", b"\x00\x01context")).expect("sent");
    let pong = peer.frame();
    let pong = pong.unwrap_or_else(|error| panic!("no answer from {peer:?}: {error}"));
    assert_eq!((pong.flags, &*pong.body), (COMMAND, &b"\x04PONGcontext"[..]), "from {peer:?}");
}

#[test]
fn a_subscriber_gets_only_messages_that_start_with_its_prefix() {
    let system = System::new();
    let mut source = open(&system, "source");
    let mut subscriber = RawPeer::join(&system.address("six", READINGS), "SUB");
    subscriber.send(&subscribe(NUMBER)).expect("sent");
    source.ask("peers 1", "peers");
    source.ask("publish 1 10", "published");
    source.ask("publish 5 6", "published");
    for _ in 0..2 {
        assert_eq!(subscriber.message().expect("a message"), [NUMBER]);
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
        source.get_ready();
    });
}
