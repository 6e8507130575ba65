//! Tests of the protocol: what arrives, in pieces of any size, and what it means.

use super::*;
use crate::transport::{Resumed, Window};
use bytes::Bytes;

const MAX_SIZE: usize = 1000;

/// What a decoder of a socket makes of bytes that arrive in pieces of a size.
fn decoded(socket: SocketType, arrived: &[u8], piece: usize) -> Result<Vec<Item>, ProtocolError> {
    let mut decoder = Decoder::new(socket, MAX_SIZE);
    let mut items = Vec::new();
    for piece in arrived.chunks(piece) {
        decoder.room().extend_from_slice(piece);
        while let Some(item) = decoder.next_item()? {
            items.push(item);
        }
    }
    Ok(items)
}

/// The same for every size of the pieces, which must not matter.
fn decode(socket: SocketType, arrived: &[u8]) -> Result<Vec<Item>, ProtocolError> {
    let whole = decoded(socket, arrived, arrived.len().max(1));
    for piece in [1, 2, 3, 5, 9, 64, 65, 100, 255, 256, 257] {
        assert_eq!(decoded(socket, arrived, piece), whole, "in pieces of {piece} bytes");
    }
    whole
}

fn command(name: &str, content: &[u8]) -> Vec<u8> {
    let length = 1 + name.len() + content.len();
    [Header::new(4, length).as_bytes(), &[name.len() as u8], name.as_bytes(), content].concat()
}

fn frame(flags: u8, body: &[u8]) -> Vec<u8> {
    [Header::new(flags, body.len()).as_bytes(), body].concat()
}

/// Greeting and READY of a peer, and what follows.
fn after_hello(peer: &str, then: &[u8]) -> Vec<u8> {
    let socket_type = [&b"\x0bSocket-Type\0\0\0"[..], &[peer.len() as u8], peer.as_bytes()].concat();
    let identity = b"\x08Identity\0\0\0\x02id";
    let greeting = &hello(SocketType::Pull, SclReady::default())[..64];
    [greeting, &command("READY", &[&identity[..], &socket_type].concat()), then].concat()
}

fn with_scl(value: &str) -> Option<SclReady> {
    let property = [&b"\x05x-scl\0\0\0"[..], &[value.len() as u8], value.as_bytes()].concat();
    let socket_type = b"\x0bSocket-Type\0\0\0\x03PUB";
    let greeting = &hello(SocketType::Pull, SclReady::default())[..64];
    let arrived = [greeting, &command("READY", &[&property[..], socket_type].concat())].concat();
    match decode(SocketType::Sub, &arrived).as_deref() {
        Ok([Item::Ready(PeerReady { scl, .. })]) => *scl,
        other => panic!("{other:?}"),
    }
}

fn message(envelope: &[u8], body: &[u8]) -> Item {
    Item::Message(Message { envelope: Bytes::copy_from_slice(envelope), body: Bytes::copy_from_slice(body) })
}

const PLAIN: Item = Item::Ready(PeerReady { scl: None, service: None });

#[test]
fn our_own_hello_is_understood_by_every_role() {
    use SocketType::{Dealer, Pull, Push, Router, Sub, XPub};
    let scl = SclReady {
        window: Some(Window { messages: 64, bytes: 32768 }),
        newest_only: true,
        lossless: true,
        latched: true,
        ..SclReady::default()
    };
    for (own, peer) in [(XPub, Sub), (Sub, XPub), (Push, Pull), (Pull, Push), (Dealer, Router), (Router, Dealer)] {
        assert_eq!(decode(own, &hello(peer, scl)), Ok(vec![Item::Ready(PeerReady { scl: Some(scl), service: None })]));
    }
    for (own, peer) in [(XPub, XPub), (Sub, Push), (Push, Sub), (Pull, Pull), (Dealer, Dealer), (Router, Router)] {
        let refused = Err(ProtocolError::SocketType { own, peer: peer.word().to_owned() });
        assert_eq!(decode(own, &hello(peer, scl)), refused);
    }
}

#[test]
fn all_peers_of_a_role_are_accepted() {
    let cases: [(SocketType, &[&str]); 6] = [
        (SocketType::XPub, &["SUB", "XSUB"]),
        (SocketType::Sub, &["PUB", "XPUB"]),
        (SocketType::Push, &["PULL"]),
        (SocketType::Pull, &["PUSH"]),
        (SocketType::Dealer, &["REP", "ROUTER"]),
        (SocketType::Router, &["REQ", "DEALER"]),
    ];
    for (own, peers) in cases {
        for peer in ["SUB", "XSUB", "PUB", "XPUB", "PULL", "PUSH", "REP", "ROUTER", "REQ", "DEALER", "PAIR", ""] {
            assert_eq!(decode(own, &after_hello(peer, &[])).is_ok(), peers.contains(&peer), "{own:?} {peer}");
        }
    }
}

#[test]
fn the_property_of_scl_can_grow() {
    let window = Some(Window { messages: 256, bytes: 1 << 20 });
    let cases = [
        ("1", Some(SclReady::default())),
        ("1 window=256,1048576", Some(SclReady { window, ..SclReady::default() })),
        ("1 lossless", Some(SclReady { lossless: true, ..SclReady::default() })),
        ("1 latched", Some(SclReady { latched: true, ..SclReady::default() })),
        ("1 in-flight=8", Some(SclReady { in_flight: Some(8), ..SclReady::default() })),
        ("1 in-flight=many", Some(SclReady::default())),
        ("1 newest later=7 window=256,1048576 x", Some(SclReady { window, newest_only: true, ..SclReady::default() })),
        ("1 window=0,0", Some(SclReady::default())),
        ("1 window=1", Some(SclReady::default())),
        ("1 window=-1,99999999999999999999999", Some(SclReady::default())),
        ("2 window=256,1048576", None),
        ("", None),
        ("10", None),
    ];
    for (value, expected) in cases {
        assert_eq!(with_scl(value), expected, "{value:?}");
    }
}

#[test]
fn strangers_are_told_from_peers_as_soon_as_possible() {
    use ProtocolError::{MalformedCommand, MalformedReady, Mechanism, NotReady, NotZmtp, Refused, TooLong, Version};
    let greeting = &after_hello("SUB", &[])[..64];
    let after_greeting = |then: &[u8]| [greeting, then].concat();
    let mut curve = greeting.to_vec();
    curve[12..17].copy_from_slice(b"CURVE");
    let cases: [(&[u8], ProtocolError); 16] = [
        (b"GET / HTTP/1.1\r\n", NotZmtp),
        (b"\0\0\0\0", NotZmtp),
        (b"\xff\0\0\0\0\0\0\0\x05\x04", NotZmtp),
        (b"\x01\0", NotZmtp),
        (b"\x05\0abcd", NotZmtp),
        (b"\xff\0\0\0\0\0\0\0\x01\x7f\x01\x02", Version),
        (b"\xff\0\0\0\0\0\0\0\x01\x7f\x02", Version),
        (&curve[..40], Mechanism),
        (&after_greeting(b"\0\x01\x01"), NotReady),
        (&after_greeting(&command("SUBSCRIBE", b"")), NotReady),
        (&after_greeting(&command("ERROR", b"\x06go\naway")), Refused("go\\naway".to_owned())),
        (&after_greeting(&command("READY", b"\x0bSocket-Type\0\0\0\x09SUB")), MalformedReady),
        (&after_greeting(&command("READY", b"\x08Identity\0\0\0\0")), MalformedReady),
        (&after_greeting(&command("READY", b"\x0bSocket-Type\xff\xff\xff\xffSUB")), MalformedReady),
        (&after_greeting(b"\x04\x01\x09"), MalformedCommand),
        (&after_greeting(b"\x06\0\0\0\0\0\x01\0\x01"), TooLong { announced: 65537, limit: 65536 }),
    ];
    for (arrived, expected) in cases {
        for own in [SocketType::XPub, SocketType::Dealer] {
            assert_eq!(decode(own, arrived), Err(expected.clone()), "{arrived:?}");
        }
    }
}

#[test]
fn subscriptions_come_in_both_dialects() {
    let then = [
        SUBSCRIBE_ALL,
        &frame(0, &[&b"\x01"[..], &[b'x'; 300]].concat()),
        &frame(0, b"\0ab"),
        &command("SUBSCRIBE", b"abc"),
        &command("CANCEL", b""),
        &frame(0, b""),
        &frame(0, b"\x02"),
    ];
    let wanted: Vec<_> = decode(SocketType::XPub, &after_hello("XSUB", &then.concat()))
        .unwrap()
        .into_iter()
        .filter_map(Item::into_subscription)
        .collect();
    let expected = [
        Subscription::Add(Bytes::new()),
        Subscription::Add(Bytes::from(vec![b'x'; 300])),
        Subscription::Cancel(Bytes::from_static(b"ab")),
        Subscription::Add(Bytes::from_static(b"abc")),
        Subscription::Cancel(Bytes::new()),
    ];
    assert_eq!(wanted, expected);
}

#[test]
fn commands_are_understood_or_ignored() {
    let then = [
        &command("PING", b"\0\x07tick")[..],
        &command("PING", b"\0\x07a context of more than 16 bytes"),
        &command("PING", b""),
        &command("WHATEVER", &[0; 400]),
        &acknowledgement(u64::MAX, 8),
        &command("X-SCL-ACK", b"\0\0\0\0\0\0\0\x07"),
        &command("X-SCL-ACK", b"\0\0\0\0\0\0\0\x07\0\0\0\0\0\0\0\x06and more of a later version"),
        BEHIND,
        &catch_up(8),
        &caught_up(9),
        FLUSH,
        &command("ERROR", b"\x04oops"),
    ];
    let expected = vec![
        PLAIN,
        Item::Command(Command::Ping(Bytes::from_static(b"tick"))),
        Item::Command(Command::Ping(Bytes::from_static(b"a context of mor"))),
        Item::Command(Command::Ping(Bytes::new())),
        Item::Command(Command::Unknown),
        Item::Command(Command::Acknowledged { taken: u64::MAX, received: 8 }),
        Item::Command(Command::Acknowledged { taken: 7, received: 7 }),
        Item::Command(Command::Acknowledged { taken: 7, received: 6 }),
        Item::Command(Command::Behind),
        Item::Command(Command::CatchUp(8)),
        Item::Command(Command::CaughtUp(9)),
        Item::Command(Command::Flush),
        Item::Command(Command::Error("oops".to_owned())),
    ];
    assert_eq!(decode(SocketType::Push, &after_hello("PULL", &then.concat())), Ok(expected));
    assert_eq!(pong(b"tick"), command("PONG", b"tick"));
}

#[test]
fn commands_are_laid_out_as_documented() {
    let with_numbers = |name: &str, numbers: &[u64]| {
        command(name, &numbers.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>())
    };
    let resumed = Resumed { end: 7, taken: 6 };
    let cases: &[(&[u8], Vec<u8>, Command)] = &[
        (&acknowledgement(7, 6), with_numbers("X-SCL-ACK", &[7, 6]), Command::Acknowledged { taken: 7, received: 6 }),
        (FLUSH, with_numbers("X-SCL-FLUSH", &[]), Command::Flush),
        (FINISH, with_numbers("X-SCL-FINISH", &[]), Command::Finish),
        (FINISHED, with_numbers("X-SCL-FINISHED", &[]), Command::Finished),
        (&refused(7), with_numbers("X-SCL-REFUSED", &[7]), Command::Refused(7)),
        (&resume(resumed), with_numbers("X-SCL-RESUME", &[7, 6]), Command::Resume(resumed)),
        (&latched(7), with_numbers("X-SCL-LATCHED", &[7]), Command::Latched(7)),
        (&sent(7), with_numbers("X-SCL-SENT", &[7]), Command::Sent(7)),
        (BEHIND, with_numbers("X-SCL-BEHIND", &[]), Command::Behind),
        (&catch_up(7), with_numbers("X-SCL-CATCH-UP", &[7]), Command::CatchUp(7)),
        (&caught_up(7), with_numbers("X-SCL-CAUGHT-UP", &[7]), Command::CaughtUp(7)),
        (SHM_OPEN, with_numbers("X-SCL-SHM-OPEN", &[]), Command::ShmOpen),
        #[cfg(feature = "shm")]
        (&sample(7, 6), with_numbers("X-SCL-SAMPLE", &[7, 6]), Command::Sample { sequence: 7, length: 6 }),
    ];
    for (written, expected, _) in cases {
        assert_eq!(written.escape_ascii().to_string(), expected.escape_ascii().to_string());
    }
    let then: Vec<u8> = cases.iter().flat_map(|(written, ..)| written.iter().copied()).collect();
    let items = decode(SocketType::Push, &after_hello("PULL", &then)).unwrap();
    assert_eq!(items.len(), 1 + cases.len());
    for (item, (.., meaning)) in items[1..].iter().zip(cases) {
        assert!(matches!(item, Item::Command(found) if found == meaning), "{item:?}, not {meaning:?}");
    }
}

#[test]
fn malformed_traffic_is_refused() {
    use ProtocolError::{Flags, MalformedCommand, TooLong, TooManyFrames};
    let more = frame(1, b"x");
    let announced = |length: u64| [&b"\x02"[..], &length.to_be_bytes()].concat();
    let most = |announced| TooLong { announced, limit: MAX_SIZE as u64 };
    let cases: [(Vec<u8>, ProtocolError); 11] = [
        (b"\x05\x01\0".to_vec(), MalformedCommand),
        (command("X-SCL-ACK", b"\0\0\0\0\0\0\0"), MalformedCommand),
        (b"\x08\0".to_vec(), Flags(8)),
        (b"\xff".to_vec(), Flags(0xff)),
        (announced(MAX_SIZE as u64 + 1), most(MAX_SIZE as u64 + 1)),
        (announced(1 << 40), most(1 << 40)),
        (announced(1 << 63), most(1 << 63)),
        (announced(u64::MAX), most(u64::MAX)),
        (more.repeat(16), TooManyFrames { limit: 16 }),
        ([more.repeat(15), frame(0, b"the 16th"), more.repeat(16)].concat(), TooManyFrames { limit: 16 }),
        ([&b"\x06"[..], &u64::MAX.to_be_bytes()].concat(), TooLong { announced: u64::MAX, limit: 65536 }),
    ];
    for (then, expected) in cases {
        for (own, peer) in [(SocketType::Router, "REQ"), (SocketType::Sub, "PUB")] {
            assert_eq!(decode(own, &after_hello(peer, &then)), Err(expected.clone()), "{then:?}");
        }
    }
    // Messages of several frames are limited as a whole as well.
    let mut decoder = Decoder::new(SocketType::Sub, 10_000);
    decoder.room().extend_from_slice(&after_hello("PUB", &[]));
    assert_eq!(decoder.next_item(), Ok(Some(PLAIN)));
    for _ in 0..7 {
        decoder.room().extend_from_slice(&frame(1, &[0; 10_000]));
        assert_eq!(decoder.next_item(), Ok(None));
    }
    decoder.room().extend_from_slice(&announced(10_000)[..]);
    assert!(matches!(decoder.next_item(), Err(TooLong { .. })));
}

#[test]
fn messages_of_several_frames_keep_their_envelope() {
    let long = vec![7; 300];
    let envelope = [frame(1, b"id"), frame(1, &long), frame(1, b"")].concat();
    let then = [&envelope[..], &frame(0, b"body"), &frame(1, b""), &frame(0, &long), &frame(0, b"")].concat();
    let expected = vec![PLAIN, message(&envelope, b"body"), message(b"\x01\0", &long), message(b"", b"")];
    assert_eq!(decode(SocketType::Router, &after_hello("DEALER", &then)), Ok(expected));
    assert_eq!(bodies(&envelope).collect::<Vec<_>>(), [&b"id"[..], &long, b""]);
}

#[test]
fn a_command_may_come_between_the_frames_of_a_message() {
    let ping = command("PING", b"\0\0!");
    let parts = [frame(1, b"id"), ping.clone(), ping.clone(), frame(1, b""), frame(1, b""), ping, frame(0, b"body")];
    let items = decode(SocketType::Router, &after_hello("DEALER", &parts.concat())).unwrap();
    let pong = || Item::Command(Command::Ping(Bytes::from_static(b"!")));
    let envelope = [frame(1, b"id"), frame(1, b""), frame(1, b"")].concat();
    assert_eq!(items, [PLAIN, pong(), pong(), pong(), message(&envelope, b"body")]);
}

#[test]
fn a_header_tells_the_length_of_what_follows() {
    let cases: [(usize, &[u8]); 4] = [
        (0, &[1, 0]),
        (255, &[1, 255]),
        (256, &[3, 0, 0, 0, 0, 0, 0, 1, 0]),
        (70_000, &[3, 0, 0, 0, 0, 0, 1, 0x11, 0x70]),
    ];
    for (length, expected) in cases {
        assert_eq!(Header::new(MORE, length).as_bytes(), expected);
    }
}

#[test]
fn memory_grows_with_what_arrives_and_is_used_again() {
    let mut decoder = Decoder::new(SocketType::Pull, 64 << 20);
    let hello = after_hello("PUSH", &[]);
    decoder.room().extend_from_slice(&hello);
    assert_eq!(decoder.next_item(), Ok(Some(PLAIN)));
    decoder.room().extend_from_slice(Header::new(0, 64 << 20).as_bytes());
    assert_eq!(decoder.next_item(), Ok(None));
    assert!(decoder.room().capacity() <= 2 << 20, "reserved for what was only announced");
    let mut arrived = 0;
    while arrived < 64 << 20 {
        let piece = vec![1; 100_000.min((64 << 20) - arrived)];
        decoder.room().extend_from_slice(&piece);
        arrived += piece.len();
        assert!(decoder.room().capacity() <= 2 * arrived + (2 << 20));
        assert_eq!(decoder.next_item().unwrap().is_some(), arrived == 64 << 20);
    }
    for _ in 0..100 {
        decoder.room().extend_from_slice(&frame(0, b"short"));
        assert!(decoder.next_item().unwrap().is_some());
    }
    assert!(decoder.room().capacity() <= 1 << 20, "memory of a long message is kept for short ones");
    let places = (0..100_000).map(|_| {
        decoder.room().extend_from_slice(&frame(0, b"short"));
        let place = decoder.room().as_ptr() as usize;
        assert!(decoder.next_item().unwrap().is_some());
        place
    });
    // Not the first, which may still be about to let go of memory for long messages.
    let places = places.skip(100).collect::<std::collections::BTreeSet<_>>();
    let span = places.last().unwrap() - places.first().unwrap();
    assert!(span <= 256 << 10, "memory that is free again is not used again");
}

#[test]
fn memory_for_one_read_is_small_until_the_handshake_is_done() {
    let mut decoder = Decoder::new(SocketType::Pull, 64 << 20);
    assert!(decoder.room().capacity() <= 1024);
    decoder.room().extend_from_slice(&after_hello("PUSH", &[])[..80]);
    assert_eq!(decoder.next_item(), Ok(None));
    assert!(decoder.room().capacity() <= 4096);
}

#[test]
fn the_entry_for_fuzzing_decodes_both_directions() {
    for (own, peer) in [("SUB", SocketType::XPub), ("XPUB", SocketType::Sub)] {
        let arrived = [hello(peer, SclReady::default()), frame(0, b"\x01"), frame(0, b"\x01")].concat();
        assert_eq!(decode_for_fuzzing(own, 100, arrived.chunks(7)), Ok(3));
        assert!(decode_for_fuzzing(own, 100, [&b"garbage"[..]]).unwrap_err().contains("does not speak ZMTP 2"));
    }
}
