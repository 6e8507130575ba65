//! Plain ZeroMQ programs, byte by byte: they get ZMTP 3.0 and nothing else.

use super::ends::{answer, ask, echo};
use super::stage::{Stage, next, numbered, once, pattern};
use crate::runtime_dir::bind_ipc;
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::zmtp::{ConnectionId, SclReady, ShmReady, SocketType, hello, sent};
use crate::transport::{PeerKind, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};

use super::stage::{ENDPOINT, endpoint};

/// What a plain program says first.
pub(super) fn plain_hello(socket_type: &str) -> Vec<u8> {
    let greeting = &hello(SocketType::Pull, SclReady::default())[..64];
    let ready = [b"\x05READY\x0bSocket-Type\0\0\0", &[socket_type.len() as u8][..], socket_type.as_bytes()].concat();
    [greeting, &[4, ready.len() as u8], &ready].concat()
}

impl Stage {
    /// Connects a plain program to a listening end, and introduces it.
    pub(super) async fn connect(&self, socket_type: &str) -> UnixStream {
        let mut stream = self.connect_silently().await;
        stream.write_all(&plain_hello(socket_type)).await.unwrap();
        stream
    }

    pub(super) async fn connect_silently(&self) -> UnixStream {
        UnixStream::connect(self.dir.path(ENDPOINT).unwrap()).await.unwrap()
    }
}

/// Reads what an end says first, and exactly as many bytes after it.
async fn read_after_hello(
    stream: &mut UnixStream,
    connection: ConnectionId,
    socket: SocketType,
    scl: SclReady,
    bytes: usize,
) -> Vec<u8> {
    let expected = hello(socket, SclReady { connection: Some(connection), ..scl });
    let mut heard = vec![0; expected.len() + bytes];
    stream.read_exact(&mut heard).await.unwrap();
    assert!(heard.starts_with(&expected));
    heard.split_off(expected.len())
}

#[tokio::test]
async fn a_plain_subscriber_gets_what_it_subscribed_to() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut publisher = stage.publisher();
    let mut subscriber = stage.connect("SUB").await;
    // Both dialects, and a subscription that is cancelled again.
    subscriber
        .write_all(b"\0\x02\x01a\x04\x0b\x09SUBSCRIBEb\0\x02\x01c\x04\x08\x06CANCELc\x04\x09\x04PING\0\0hi")
        .await
        .unwrap();
    let scl = SclReady::default();
    let pong = publisher.during(read_after_hello(&mut subscriber, stage.connection(), SocketType::XPub, scl, 9)).await;
    assert_eq!(pong, b"\x04\x07\x04PONGhi");
    assert_eq!(publisher.peers[0].kind, PeerKind::Foreign);
    publisher.queue(["a1", "b2", "c3", "", "a4"].map(Bytes::from));
    // More than any window, none of it acknowledged.
    publisher.queue((0..2000).map(|_| Bytes::from_static(b"b")));
    publisher.queue([Bytes::from([&b"a"[..], &pattern(300)].concat())]);
    let expected =
        [&b"\0\x02a1\0\x02b2\0\x02a4"[..], &b"\0\x01b".repeat(2000), b"\x02\0\0\0\0\0\0\x01\x2da", &pattern(300)]
            .concat();
    let mut heard = vec![0; expected.len()];
    publisher.during(subscriber.read_exact(&mut heard)).await.unwrap();
    assert_eq!(heard, expected);
    assert_eq!(publisher.link().unacknowledged(), 0);
    once(|cx| publisher.link().request_acknowledgement(cx)).await;
    publisher.queue([Bytes::from_static(b"a")]);
    let mut heard = [0; 3];
    publisher.during(subscriber.read_exact(&mut heard)).await.unwrap();
    assert_eq!(&heard, b"\0\x01a");
}

#[tokio::test]
async fn a_plain_publisher_is_subscribed_to_after_its_ready() {
    let stage = Stage::new(TransportKind::Ipc);
    let bound = bind_ipc(&stage.dir, ENDPOINT).unwrap();
    let listener = UnixListener::from_std(bound.listener).unwrap();
    let mut subscriber = stage.subscriber();
    let receiving = tokio::spawn(async move {
        let mut messages = Vec::new();
        while messages.len() < 600 {
            subscriber.catch_up(Duration::ZERO);
            messages.push(next(&mut *subscriber).await);
            assert_eq!(subscriber.take_sent(), None, "a plain publisher does not tell");
        }
        // A newer message cannot be asked for.
        assert!(once(|cx| subscriber.poll_caught_up(cx)).await.is_ready());
        (messages, subscriber.malformed(), subscriber)
    });
    let (mut stream, _) = listener.accept().await.unwrap();
    let shm = ShmReady::of_dialling(SocketType::Sub);
    let scl = SclReady { shm, ..super::super::credit::receiving(&super::stage::endpoint()) };
    read_after_hello(&mut stream, stage.connection(), SocketType::Sub, scl, 0).await;
    let mut early = [0];
    assert!(stream.try_read(&mut early).is_err(), "sent something before READY arrived");
    stream.write_all(&plain_hello("PUB")).await.unwrap();
    let mut subscription = [0; 3];
    stream.read_exact(&mut subscription).await.unwrap();
    assert_eq!(&subscription, b"\0\x01\x01");
    stream.write_all(b"\x01\x05topic\0\x04data\0\x03one\x04\x07\x04PING\0\0").await.unwrap();
    // What only SCL's ends say counts for nothing.
    stream.write_all(&sent(7)).await.unwrap();
    for message in numbered(1..600) {
        stream.write_all(&[b"\0\x04", &message[..]].concat()).await.unwrap();
    }
    let (messages, malformed, subscriber) = receiving.await.unwrap();
    assert_eq!((&messages[0][..], malformed), (&b"one"[..], 1));
    assert!(messages[1..].iter().eq(numbered(1..600).collect::<Vec<_>>().iter()));
    // Exactly one PONG and no acknowledgement, although more than half a window was taken.
    drop(subscriber);
    let mut heard = Vec::new();
    stream.read_to_end(&mut heard).await.unwrap();
    assert_eq!(heard, b"\x04\x05\x04PONG");
}

#[tokio::test]
async fn a_plain_requester_is_answered_through_its_envelope() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut replier = stage.replier();
    let cases: [(&str, &[u8], &[u8]); 3] = [
        ("REQ", b"\x01\0\0\x03abc", b"\x01\0\0\x03cba"),
        ("DEALER", b"\x01\x02id\x01\x03via\x01\0\0\x03abc", b"\x01\x02id\x01\x03via\x01\0\0\x03cba"),
        // Without delimiter, without body, with two bodies: skipped.
        (
            "DEALER",
            b"\0\x01a\x01\x01a\0\x01b\x01\0\0\0\x01\0\x01\x01a\0\x01b\x01\0\x01\0\0\x01c\x01\0\0\x01x",
            b"\x01\0\0\0\x01\0\0\x01x",
        ),
    ];
    for (socket_type, request, expected) in cases {
        let mut requester = stage.connect(socket_type).await;
        requester.write_all(request).await.unwrap();
        let reading = read_after_hello(
            &mut requester,
            stage.connection(),
            SocketType::Router,
            SclReady::default(),
            expected.len(),
        );
        let mut reading = std::pin::pin!(reading);
        let heard = poll_fn(|cx| {
            echo(&mut *replier, cx);
            reading.as_mut().poll(cx)
        });
        assert_eq!(heard.await, expected, "{socket_type}");
    }
    assert_eq!(replier.malformed(), 4);
}

#[tokio::test]
async fn a_plain_replier_gets_an_envelope_and_returns_it() {
    let stage = Stage::new(TransportKind::Ipc);
    let bound = bind_ipc(&stage.dir, ENDPOINT).unwrap();
    let listener = UnixListener::from_std(bound.listener).unwrap();
    let mut requester = stage.requester();
    let replying = tokio::spawn(async move {
        let (mut stream, _) = listener.accept().await.unwrap();
        stream.write_all(&plain_hello("REP")).await.unwrap();
        let request =
            read_after_hello(&mut stream, stage.connection(), SocketType::Dealer, SclReady::default(), 17).await;
        assert_eq!(request, b"\x01\x08\0\0\0\0\0\0\x01\x02\x01\0\0\x03abc");
        // Replies to nobody are ignored.
        stream.write_all(b"\x01\x01?\x01\0\0\x01x\0\x01x\x01\0\0\x01x").await.unwrap();
        stream.write_all(b"\x01\x08\0\0\0\0\0\0\x01\x02\x01\0\0\x02ok").await.unwrap();
        stream
    });
    poll_fn(|cx| requester.poll_connected(cx)).await;
    ask(&mut *requester, 258, Bytes::from_static(b"abc")).await;
    let mut bystander = Stage::new(TransportKind::Ipc).replier();
    assert_eq!(answer(&mut *requester, &mut *bystander).await, Some((258, Bytes::from_static(b"ok"))));
    drop(replying.await.unwrap());
}

#[tokio::test]
async fn a_tap_sends_two_frames_and_drops_the_oldest() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut tap = stage.transport.tap(&endpoint()).unwrap().unwrap();
    let payload = Bytes::from(vec![b'p'; 100_000]);
    assert!(!once(|cx| tap.drive(cx)).await);
    once(|cx| tap.observe(cx, &payload, b"for nobody")).await;
    let mut observer = stage.connect("SUB").await;
    observer.write_all(b"\0\x02\x01p").await.unwrap();
    poll_fn(|cx| if tap.drive(cx) { Poll::Ready(()) } else { Poll::Pending }).await;
    for number in 0..500_u32 {
        once(|cx| tap.observe(cx, &payload, &number.to_be_bytes())).await;
        once(|cx| tap.observe(cx, &Bytes::from_static(b"another topic"), b"")).await;
    }
    let dropped = tap.dropped();
    assert!((300..=400).contains(&dropped), "{dropped}");
    let message = 9 + payload.len() + 2 + 4;
    let left = 500 - dropped as usize;
    let heard = {
        let reading =
            read_after_hello(&mut observer, stage.connection(), SocketType::XPub, SclReady::default(), left * message);
        let mut reading = std::pin::pin!(reading);
        poll_fn(|cx| {
            assert!(tap.drive(cx));
            reading.as_mut().poll(cx)
        })
        .await
    };
    let numbers: Vec<_> = heard
        .chunks(message)
        .map(|message| {
            assert_eq!(message[..9], *b"\x03\0\0\0\0\0\x01\x86\xa0");
            assert_eq!(message[message.len() - 6..][..2], *b"\0\x04");
            u32::from_be_bytes(*message.last_chunk().unwrap())
        })
        .collect();
    assert!(numbers.is_sorted() && numbers.ends_with(&[498, 499]), "{numbers:?}");
    drop(observer);
    poll_fn(|cx| if tap.drive(cx) { Poll::Pending } else { Poll::Ready(()) }).await;
}
