//! Peers that speak nonsense, stay silent, announce too much, or send what plain ZeroMQ allows and SCL does not: they get
//! nothing, and a good peer beside them gets everything.

use scl_tests::{Place, Process, python_with_pyzmq};
use std::io::{ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::Duration;

const PEER: &str = env!("CARGO_BIN_EXE_peer");
/// What a PUSH socket says first (ZMTP 3.0, RFC 23).
const HELLO: &[u8] = b"\xff\0\0\0\0\0\0\0\0\x7f\x03\0NULL\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\
    \0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\
    \x04\x1a\x05READY\x0bSocket-Type\0\0\0\x04PUSH";
/// When nothing has come by then, it never will: the test fails instead of hanging.
const HANGS: Duration = Duration::from_secs(60);
/// What a SUB socket says after the greeting.
const SUBSCRIBER: &[u8] = b"\x04\x19\x05READY\x0bSocket-Type\0\0\0\x03SUB";
const ENDPOINTS: [&str; 3] = ["source.readings--sink.readings.", "sink.jobs.", "sink.answer."];

fn open(place: &Place, component: &str) -> Process {
    let mut process = place.start(PEER, &[component]);
    process.says("open");
    process
}

/// Everything still works between two good peers.
fn assert_good(source: &mut Process, sink: &mut Process, from: u64) {
    let to = from + 10;
    source.does(&format!("publish {from} {to}"), "published");
    sink.does("receive 10", &format!("{from}..{to}"));
    source.does(&format!("push {from} {to}"), "pushed");
    sink.does("pull 10", &format!("{from}..{to}"));
    sink.tell("serve 1");
    source.does(&format!("call {from}"), &(2 * from).to_string());
    sink.says("served");
}

#[test]
fn a_peer_that_speaks_garbage_is_ignored() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    let mut word = 0x2545_f491_4f6c_dd1d_u64;
    for round in 0..20 {
        for endpoint in ENDPOINTS {
            let mut stranger = UnixStream::connect(place.socket("six", endpoint)).expect("connected");
            let mut garbage = Vec::new();
            // Every other one is polite first, so that the nonsense reaches what comes after the greeting.
            if round % 2 == 1 {
                garbage.extend_from_slice(HELLO);
            }
            for _ in 0..200 {
                word ^= word << 13;
                word ^= word >> 7;
                word ^= word << 17;
                // No long frames here: what those do is another test.
                garbage.extend(word.to_le_bytes().map(|byte| byte & !0x02));
            }
            // It may be thrown out before it has said everything.
            let _thrown_out = stranger.write_all(&garbage);
        }
        source.tell(&format!("publish {round} {}", round + 1));
        source.says("published");
        sink.does("receive 1", &format!("{round}..{}", round + 1));
    }
    // What happened to be a frame was handed to the gate, which said that it is no message; none is waiting any more.
    source.does("publish 100 110", "published");
    sink.does("receive 10", "100..110");
}

#[test]
fn a_peer_that_connects_and_stays_silent_is_ignored() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    let silent = UnixStream::connect(place.socket("six", ENDPOINTS[0])).expect("connected");
    let mut sink = open(&place, "sink");
    let others = ENDPOINTS[1..].iter().map(|endpoint| UnixStream::connect(place.socket("six", endpoint)));
    let others: Vec<UnixStream> = others.map(|stream| stream.expect("connected")).collect();
    source.does("ready 30000", "ready");
    assert_good(&mut source, &mut sink, 0);
    drop((silent, others));
    assert_good(&mut source, &mut sink, 10);
}

#[test]
fn a_frame_that_is_announced_with_8_gib_costs_no_memory_until_it_comes() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    let mut stranger = UnixStream::connect(place.socket("six", "sink.jobs.")).expect("connected");
    stranger.write_all(HELLO).expect("said");
    stranger.write_all(&[2, 0, 0, 0, 2, 0, 0, 0, 0]).expect("announced");
    stranger.write_all(&[7; 1000]).expect("a beginning");
    assert_good(&mut source, &mut sink, 0);
    let resident = sink.status("VmRSS");
    let kib: u64 = resident.trim_end_matches(" kB").parse().expect("a number");
    assert!(kib < 200_000, "{resident}");
    drop(stranger);
    assert_good(&mut source, &mut sink, 10);
}

#[test]
fn a_message_of_several_frames_is_passed_over_and_counted() {
    let place = Place::new("ipc");
    let mut sink = open(&place, "sink");
    let mut plain = strange(&place, "multipart");
    plain.says("sent");
    // The good one was sent after the other, so that one has been passed over by now.
    sink.does("pull 1", "5..6");
    sink.does("rejected", "1");
    sink.tell("serve 1");
    let mut plain = strange(&place, "two_bodies");
    sink.says("served");
    plain.says(r"b'\x08\n'");
}

#[test]
fn a_subscriber_with_heartbeats_stays_connected() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    let mut plain = strange(&place, "heartbeats");
    source.does("peers 1", "peers");
    // It sends one each millisecond.
    for value in 0..200 {
        source.does(&format!("publish {value} {}", value + 1), "published");
        plain.says(&value.to_string());
    }
    plain.does("still connected?", "yes");
}

#[test]
fn a_heartbeat_comes_back_with_what_it_carried() {
    let place = Place::new("ipc");
    let _source = open(&place, "source");
    let mut subscriber = UnixStream::connect(place.socket("six", ENDPOINTS[0])).expect("connected");
    subscriber.write_all(&[&HELLO[..64], SUBSCRIBER, b"\x04\x0b\x04PING\0\x01tick"].concat()).expect("said");
    subscriber.set_read_timeout(Some(HANGS)).expect("a limit");
    let mut heard = Vec::new();
    let mut byte = [0];
    while !heard.ends_with(b"\x04\x09\x04PONGtick") {
        subscriber.read_exact(&mut byte).expect("an answer");
        heard.extend(byte);
    }
}

#[test]
fn a_peer_that_announces_more_than_a_subscriber_says_is_disconnected() {
    let place = Place::new("ipc");
    let (mut source, mut sink) = (open(&place, "source"), open(&place, "sink"));
    source.does("ready 30000", "ready");
    let mut stranger = UnixStream::connect(place.socket("six", ENDPOINTS[0])).expect("connected");
    // 32 GiB, which ends a program that makes room for them.
    stranger.write_all(&[&HELLO[..64], SUBSCRIBER, b"\x02\0\0\0\x08\0\0\0\0"].concat()).expect("announced");
    stranger.set_read_timeout(Some(HANGS)).expect("a limit");
    let ended = stranger.read_to_end(&mut Vec::new());
    assert!(!ended.is_err_and(|error| error.kind() == ErrorKind::WouldBlock), "it is still connected");
    assert_good(&mut source, &mut sink, 0);
}

#[test]
fn a_subscriber_of_some_messages_gets_no_others() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    let mut subscriber = UnixStream::connect(place.socket("six", ENDPOINTS[0])).expect("connected");
    subscriber.set_read_timeout(Some(HANGS)).expect("a limit");
    // What begins like the message of the number 5.
    subscriber.write_all(&[&HELLO[..64], SUBSCRIBER, b"\0\x03\x01\x08\x05"].concat()).expect("said");
    source.does("peers 1", "peers");
    source.does("publish 1 10", "published");
    source.does("publish 5 6", "published");
    let mut heard = [0; 64 + 28 + 8];
    subscriber.read_exact(&mut heard).expect("the greeting and two messages");
    assert_eq!(heard[64 + 28..], *b"\0\x02\x08\x05\0\x02\x08\x05");
}

#[test]
fn the_oldest_of_many_silent_connections_give_way() {
    let place = Place::new("ipc");
    let mut source = open(&place, "source");
    let endpoint = place.socket("six", ENDPOINTS[0]);
    let mut silent: Vec<UnixStream> = (0..70).map(|_| UnixStream::connect(&endpoint).expect("connected")).collect();
    silent[0].set_read_timeout(Some(HANGS)).expect("a limit");
    let mut greeting = Vec::new();
    silent[0].read_to_end(&mut greeting).expect("an end of the connection");
    let mut sink = open(&place, "sink");
    source.does("ready 30000", "ready");
    assert_good(&mut source, &mut sink, 0);
}

fn strange(place: &Place, what: &str) -> Process {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/strange_sender.py");
    let folder = place.runtime_dir().join("six");
    Process::start(python_with_pyzmq(), &[script, folder.to_str().expect("a path in UTF-8"), what], &[])
}
