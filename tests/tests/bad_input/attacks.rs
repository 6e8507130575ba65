//! The attacks. Each gets connections to one end and returns those that are to stay open.

use super::end::End;
use scl_tests::RawPeer;
use scl_tests::zmtp::{
    COMMAND, MORE, announcement, command, frame, greeting, greeting_with, message, property, ready, subscribe,
};
use std::time::{Duration, Instant};

const MAX_SIZE: u64 = 64 << 20;
const PING: &[u8] = b"\x04\x0e\x04PING\x00\x01context";
const PONG: &[u8] = b"\x04PONGcontext";

pub(crate) fn random_bytes(end: &End) -> Vec<RawPeer> {
    let mut random = Random(1);
    end.each(0..10, |_| {
        let mut peer = end.connection();
        // It may be disconnected before it has said everything.
        let _sent = peer.send(&random.bytes(2000));
        peer
    })
}

pub(crate) fn random_bytes_after_a_handshake(end: &End) -> Vec<RawPeer> {
    let mut random = Random(2);
    end.each(0..10, |_| {
        let mut peer = end.joined();
        let _sent = peer.send(&random.bytes(20_000));
        peer
    })
}

/// Valid frames with random flags and contents, so that more than the first frame is looked at.
pub(crate) fn random_small_frames(end: &End) -> Vec<RawPeer> {
    let mut random = Random(3);
    end.each(0..10, |_| {
        let mut peer = end.joined();
        for _ in 0..200 {
            let [flags, length] = random.bytes(2)[..] else { unreachable!("two bytes") };
            let body = random.bytes(length.into());
            // Commands are rare, because random ones are malformed and end the connection.
            let flags = if flags < 8 { COMMAND } else { flags & MORE };
            if peer.send(&frame(flags, &body)).is_err() {
                break;
            }
        }
        peer
    })
}

pub(crate) fn slow_greeting(end: &End) -> Vec<RawPeer> {
    let mut peer = end.connection();
    for byte in greeting() {
        peer.send(&[byte]).expect("the greeting is accepted");
    }
    peer.read_greeting().expect("a greeting");
    for byte in ready(end.peer_type) {
        peer.send(&[byte]).expect("READY is accepted");
    }
    peer.frame().expect("a READY command");
    assert_answers_pings(&mut peer, end);
    vec![peer]
}

pub(crate) fn half_a_greeting(end: &End) -> Vec<RawPeer> {
    let whole = [greeting(), ready(end.peer_type)].concat();
    end.each([1, 9, 10, 11, 12, 32, 63, 64, 65, 66, 80], |length| {
        let mut peer = end.connection();
        peer.send(&whole[..length]).expect("the beginning of a greeting is accepted");
        peer
    })
}

/// libzmq closes such a connection; nothing forbids it.
pub(crate) fn everything_at_once(end: &End) -> Vec<RawPeer> {
    let mut peer = end.connection();
    peer.send(&[&greeting()[..], &ready(end.peer_type), PING].concat()).expect("sent");
    peer.read_greeting().expect("a greeting");
    assert!(peer.frame().expect("a frame").body.starts_with(b"\x05READY"));
    wait_for_pong(&mut peer, end);
    vec![peer]
}

/// Whatever is announced, nothing is reserved for it, and the connection is closed.
pub(crate) fn enormous_frames(end: &End) -> Vec<RawPeer> {
    for length in [16 << 30, 64 << 30, 1 << 40, 1 << 63, u64::MAX] {
        for flags in [0, MORE, COMMAND] {
            let mut peer = end.joined();
            let _closed = peer.send(&[announcement(flags, length), vec![7; 1000]].concat());
            peer.wait_until_closed();
        }
    }
    Vec::new()
}

pub(crate) fn enormous_ready(end: &End) -> Vec<RawPeer> {
    for length in [1 << 20, 16 << 30, u64::MAX] {
        let mut peer = end.connection();
        peer.send(&greeting()).expect("the greeting is accepted");
        peer.read_greeting().expect("a greeting");
        let _closed = peer.send(&[announcement(COMMAND, length), vec![7; 1000]].concat());
        peer.wait_until_closed();
    }
    Vec::new()
}

/// Receiving ends refuse it because of the gate's limit, sending ends because their peers never say much.
pub(crate) fn one_byte_too_long(end: &End) -> Vec<RawPeer> {
    let mut peer = end.joined();
    let _closed = peer.send(&announcement(0, MAX_SIZE + 1));
    peer.wait_until_closed();
    let mut peer = end.joined();
    let _closed = peer.send(&[frame(MORE, b""), announcement(0, MAX_SIZE + 1)].concat());
    peer.wait_until_closed();
    Vec::new()
}

pub(crate) fn unfinished_frame(end: &End) -> Vec<RawPeer> {
    end.each([200, 60_000, 1 << 20, MAX_SIZE], |length| {
        let mut peer = end.joined();
        let _sent = peer.send(&[announcement(0, length), vec![7; 100]].concat());
        peer
    })
}

/// The number of frames of a message is limited, empty ones included; a peer that sends more is disconnected.
pub(crate) fn endless_message(end: &End) -> Vec<RawPeer> {
    for body in [&b""[..], b"\x01", &[1; 300]] {
        let mut peer = end.joined();
        let piece = frame(MORE, body).repeat(100);
        let (sent, connected) = peer.flood(std::iter::repeat_n(piece, 100_000));
        assert!(!connected, "`{}` took {sent} bytes of one message", end.name);
    }
    Vec::new()
}

pub(crate) fn malformed_ready(end: &End) -> Vec<RawPeer> {
    let socket_type = property("Socket-Type", end.peer_type.as_bytes());
    let huge_value = [&b"\x04Name"[..], &u32::MAX.to_be_bytes(), b"value"].concat();
    let malformed = [
        // Without a socket type, with a name or a value that ends too early, without a name, as a message.
        command("READY", b""),
        command("READY", &socket_type[..5]),
        command("READY", &socket_type[..socket_type.len() - 1]),
        command("READY", &[&socket_type[..], &huge_value].concat()),
        command("READY", &[&socket_type[..], b"\xff"].concat()),
        frame(COMMAND, b""),
        frame(COMMAND, b"\xff"),
        frame(0, &ready(end.peer_type)[2..]),
        command("HELLO", &socket_type),
        frame(COMMAND | MORE, &ready(end.peer_type)[2..]),
    ];
    for bytes in malformed {
        let mut peer = end.connection();
        peer.send(&greeting()).expect("the greeting is accepted");
        peer.read_greeting().expect("a greeting");
        let _closed = peer.send(&bytes);
        peer.wait_until_closed();
    }
    Vec::new()
}

pub(crate) fn odd_commands(end: &End) -> Vec<RawPeer> {
    let closes = [
        frame(COMMAND | MORE, b"\x04PING\0\0"),
        frame(COMMAND, b""),
        frame(COMMAND, b"\x20PING"),
        command("ERROR", b"\x05wrong"),
        command("ERROR", b""),
    ];
    for bytes in closes {
        let mut peer = end.joined();
        let _closed = peer.send(&bytes);
        peer.wait_until_closed();
    }
    // These are ignored.
    let mut peer = end.joined();
    for bytes in [command("NONSENSE", b"anything"), command("", b""), command("PONG", b""), command("PING", b"")] {
        peer.send(&bytes).expect("an unknown command is accepted");
    }
    assert_answers_pings(&mut peer, end);
    vec![peer]
}

/// An end that connects retries at a constant pace, however the peer behaves.
pub(crate) fn breaking_off(end: &End) -> Vec<RawPeer> {
    if end.listens() {
        (0..3000).for_each(|_| drop(end.joined()));
        return Vec::new();
    }
    const TIMES: u32 = 30;
    const PACE: Duration = Duration::from_millis(10);
    let started = Instant::now();
    (0..TIMES).for_each(|_| drop(end.joined()));
    let elapsed = started.elapsed();
    assert!(elapsed >= PACE * (TIMES - 1), "`{}` connected {TIMES} times in {elapsed:?}", end.name);
    Vec::new()
}

pub(crate) fn heartbeats(end: &End) -> Vec<RawPeer> {
    let mut peer = end.joined();
    (0..1000).for_each(|_| assert_answers_pings(&mut peer, end));
    vec![peer]
}

pub(crate) fn heartbeats_without_reading(end: &End) -> Vec<RawPeer> {
    let mut peer = end.joined();
    peer.flood(std::iter::repeat_n(PING.repeat(1000), 3000));
    vec![peer]
}

pub(crate) fn other_protocols_and_versions(end: &End) -> Vec<RawPeer> {
    let zmtp_1 = b"\x01\x00\x05\x00hello".to_vec();
    let zmtp_2 = b"\xff\0\0\0\0\0\0\0\x01\x7f\x01\x02\0\0".to_vec();
    let http = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n".to_vec();
    let tls = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03".to_vec();
    for bytes in [zmtp_1, zmtp_2, http, tls, vec![0; 200], vec![0xff; 200]] {
        let mut peer = end.connection();
        let _closed = peer.send(&bytes);
        peer.wait_until_closed();
    }
    Vec::new()
}

pub(crate) fn wrong_mechanisms_and_types(end: &End) -> Vec<RawPeer> {
    for mechanism in [&b"PLAIN"[..], b"CURVE", b"", b"NULLNULL", &[0xff; 20]] {
        let mut peer = end.connection();
        let _closed = peer.send(&greeting_with(mechanism));
        let _closed = peer.send(&ready(end.peer_type));
        peer.wait_until_closed();
    }
    let own = match end.peer_type {
        "SUB" => "XPUB",
        "PUB" => "SUB",
        "PUSH" => "PULL",
        "PULL" => "PUSH",
        "REQ" => "ROUTER",
        _ => "DEALER",
    };
    for socket_type in ["PAIR", "NONSENSE", "", "sub", own] {
        let mut peer = end.connection();
        peer.send(&greeting()).expect("the greeting is accepted");
        peer.read_greeting().expect("a greeting");
        let _closed = peer.send(&ready(socket_type));
        peer.wait_until_closed();
    }
    Vec::new()
}

/// For an end that has no subscribers these are messages.
pub(crate) fn a_million_subscriptions(end: &End) -> Vec<RawPeer> {
    let short = |batch: u32| (0..1000).flat_map(|index| subscribe(&(batch * 1000 + index).to_be_bytes())).collect();
    let long = |index: u32| message(&[&[&[1], &index.to_be_bytes()[..], &[7; 8000]].concat()]);
    end.each([true, false], |is_short| {
        let mut peer = end.joined();
        if is_short {
            peer.flood((0..1000).map(short))
        } else {
            peer.flood((0..1000).map(long))
        };
        peer
    })
}

/// A peer that claims to be an SCL program, and acknowledges what it never got.
pub(crate) fn misused_extension(end: &End) -> Vec<RawPeer> {
    let windows =
        ["1 window=1,1", "1 window=18446744073709551615,18446744073709551615 newest", "1 window=0,0", "\u{fe}"];
    let acknowledge = |count: u64| command("X-SCL-ACK", &count.to_be_bytes());
    let speeches = [
        acknowledge(u64::MAX),
        [acknowledge(5), acknowledge(1), acknowledge(0)].concat(),
        command("X-SCL-ACK", b"\0\0"),
        command("X-SCL-BEHIND", b"").repeat(1000),
        [command("X-SCL-CAUGHT-UP", b""), command("X-SCL-FLUSH", b"")].concat().repeat(1000),
    ];
    end.each(
        windows.iter().flat_map(|window| speeches.iter().map(move |speech| (window, speech))),
        |(window, speech)| {
            let mut peer = end.connection();
            let properties = [property("Socket-Type", end.peer_type.as_bytes()), property("X-SCL", window.as_bytes())];
            peer.send(&greeting()).expect("the greeting is accepted");
            peer.read_greeting().expect("a greeting");
            let _closed = peer.send(&command("READY", &properties.concat()));
            let _closed = peer.send(speech);
            peer
        },
    )
}

pub(crate) fn silent_connections(end: &End, count: usize) -> Vec<RawPeer> {
    // An end that connects has one connection at a time.
    (0..if end.listens() { count } else { 1 }).map(|_| end.connection()).collect()
}

pub(crate) fn silent_connections_after_a_handshake(end: &End, count: usize) -> Vec<RawPeer> {
    if !end.listens() {
        return vec![end.joined()];
    }
    let speak = |_| {
        let mut peer = end.connection();
        // Without waiting for the answers: some of them are disconnected at once.
        let _closed = peer.send(&[greeting(), ready(end.peer_type)].concat());
        peer
    };
    (0..count).map(speak).collect()
}

/// One after the other, so that the last of them takes the last descriptor.
pub(crate) fn all_descriptors(end: &End) -> Vec<RawPeer> {
    let join = || {
        let mut peer = end.connection();
        peer.handshake(end.peer_type).ok().map(|_ready| peer)
    };
    match end.listens() {
        true if end.name == End::CROWDED => std::iter::from_fn(join).collect(),
        true => Vec::new(),
        false => vec![end.joined()],
    }
}

fn assert_answers_pings(peer: &mut RawPeer, end: &End) {
    peer.send(PING).expect("a heartbeat is accepted");
    wait_for_pong(peer, end);
}

/// Skips what else the end may have to say, such as a subscription.
fn wait_for_pong(peer: &mut RawPeer, end: &End) {
    loop {
        let frame = peer.frame().unwrap_or_else(|error| panic!("no PONG from `{}`: {error}", end.name));
        if frame.flags & COMMAND != 0 && frame.body == PONG {
            return;
        }
    }
}

/// Numbers that only look random, the same in every run.
struct Random(u64);

impl Random {
    fn bytes(&mut self, count: usize) -> Vec<u8> {
        let next = |_| {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 56) as u8
        };
        (0..count).map(next).collect()
    }
}
