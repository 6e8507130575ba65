//! Peers that do everything wrong, at listening and at connecting ends: afterwards, a good peer is served.

use super::plain::plain_hello;
use super::stage::{ENDPOINT, Stage, endpoint};
use super::subject::{CONNECTING, End, LISTENING, Role, exchange};
use crate::runtime_dir::bind_ipc;
use crate::transport::Endpoint;
use crate::transport::zeromq::TransportKind;
use std::future::poll_fn;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::task::Poll;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};
use tokio::time::Instant;

fn long(flags: u8, length: u64) -> Vec<u8> {
    [&[flags | 2], &length.to_be_bytes()[..]].concat()
}

/// What a role must answer by closing the connection.
fn violations(role: Role) -> Vec<Vec<u8>> {
    let hello = plain_hello(role.plain_peer());
    let after_hello = |then: &[u8]| [&hello[..], then].concat();
    let mut curve = hello.clone();
    curve[12..17].copy_from_slice(b"CURVE");
    let mut noise: Vec<u8> = (0..5000_u32).map(|number| (number.wrapping_mul(0x9e37_79b1) >> 24) as u8).collect();
    noise[0] = 0xf7;
    let mut violations = vec![
        b"GET / HTTP/1.1\r\n\r\n".to_vec(),
        vec![0; 100],
        noise.clone(),
        after_hello(&noise),
        b"\xff\0\0\0\0\0\0\0\x01\x7f\x00\x02".to_vec(),
        b"\xff\0\0\0\0\0\0\0\x01\x7f\x01\x02\0\0".to_vec(),
        b"\x01\0".to_vec(),
        curve,
        plain_hello("PAIR"),
        plain_hello(role.socket().word()),
        [&hello[..64], b"\0\x01\x01"].concat(),
        [&hello[..64], &long(4, 1 << 20)].concat(),
        after_hello(b"\x05\x01\0"),
        after_hello(&b"\x01\x01x".repeat(20)),
        after_hello(&b"\x01\0".repeat(1000)),
        after_hello(b"\x04\x0a\x05ERROR\x03bye"),
        after_hello(&long(4, 65537)),
    ];
    for length in [16 << 30, 64 << 30, 1 << 40, 1 << 63, u64::MAX, (64 << 20) + 1] {
        violations.push(after_hello(&long(0, length)));
        violations.push(after_hello(&long(1, length)));
    }
    violations
}

/// Reads until the end closes the connection.
async fn closed(stream: &mut UnixStream) {
    let mut heard = [0; 4096];
    while matches!(stream.read(&mut heard).await, Ok(1..)) {}
}

#[tokio::test]
async fn listening_ends_disconnect_peers_that_violate_the_protocol() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        for violation in violations(role) {
            let mut stranger = stage.connect_silently().await;
            stranger.write_all(&violation).await.unwrap();
            end.during(closed(&mut stranger)).await;
        }
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn listening_ends_survive_violations_that_come_byte_by_byte_and_stop_anywhere() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let hello = plain_hello(role.plain_peer());
        for length in 0..hello.len() {
            let mut stranger = stage.connect_silently().await;
            for byte in &hello[..length] {
                end.during(stranger.write_all(&[*byte])).await.unwrap();
            }
        }
        exchange(&stage, role, &mut end).await;
    }
}

/// Answers the next connections of an end with these bytes, one after the other; returns when they were all closed.
async fn listen(stage: &Stage, end: &mut End, answers: Vec<Vec<u8>>) {
    let bound = bind_ipc(&stage.dir, ENDPOINT).unwrap();
    let listener = UnixListener::from_std(bound.listener).unwrap();
    end.during(async {
        for answer in answers {
            let (mut stream, _) = listener.accept().await.unwrap();
            stream.write_all(&answer).await.unwrap();
            closed(&mut stream).await;
        }
    })
    .await;
}

#[tokio::test]
async fn connecting_ends_leave_peers_that_violate_the_protocol() {
    for role in CONNECTING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        listen(&stage, &mut end, violations(role)).await;
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn connecting_ends_keep_their_pace_when_peers_break_off() {
    for role in CONNECTING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let bound = bind_ipc(&stage.dir, ENDPOINT).unwrap();
        let listener = UnixListener::from_std(bound.listener).unwrap();
        let hello = plain_hello(role.plain_peer());
        let started = Instant::now();
        end.during(async {
            for number in 0..12 {
                let (mut stream, _) = listener.accept().await.unwrap();
                // Before the handshake, in the middle of it, and after it.
                let said = [0, 30, hello.len()][number % 3];
                stream.write_all(&hello[..said]).await.unwrap();
            }
        })
        .await;
        assert!(started.elapsed() >= 11 * Duration::from_millis(20), "{role:?} {:?}", started.elapsed());
        drop((listener, bound.guard));
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn listening_ends_take_thousands_of_broken_connections() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let hello = plain_hello(role.plain_peer());
        for number in 0..2000 {
            let mut stranger = stage.connect_silently().await;
            stranger.write_all(&hello[..[0, 64, hello.len()][number % 3]]).await.unwrap();
            drop(stranger);
            poll_fn(|cx| Poll::Ready(end.drive(cx))).await;
            if number % 10 == 0 {
                tokio::task::yield_now().await;
            }
        }
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn only_some_silent_connections_are_kept() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let mut strangers = Vec::new();
        for number in 0..300 {
            strangers.push(stage.connect_silently().await);
            // Not later than the operating system's queue is full.
            if number % 50 == 0 {
                end.during(tokio::task::yield_now()).await;
            }
        }
        exchange(&stage, role, &mut end).await;
        for stranger in &mut strangers[..200] {
            end.during(closed(stranger)).await;
        }
        assert!(strangers[299].try_read(&mut [0; 64]).is_ok(), "the newest stranger has been heard");
    }
}

#[tokio::test(start_paused = true)]
async fn silent_peers_are_disconnected_in_time() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let started = Instant::now();
        for said in [0, 10, 64, 70] {
            let mut stranger = stage.connect_silently().await;
            stranger.write_all(&plain_hello(role.plain_peer())[..said]).await.unwrap();
            end.during(closed(&mut stranger)).await;
        }
        assert!(started.elapsed() >= Duration::from_secs(20));
        exchange(&stage, role, &mut end).await;
    }
    for role in CONNECTING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let hello = plain_hello(role.plain_peer());
        listen(&stage, &mut end, vec![vec![], hello[..10].to_vec(), hello[..70].to_vec()]).await;
        exchange(&stage, role, &mut end).await;
    }
}

/// Writes the same again and again until the end disconnects.
async fn flood(mut stream: UnixStream, flood: Vec<u8>) {
    while stream.write_all(&flood).await.is_ok() {}
}

#[tokio::test]
async fn heartbeats_whose_answers_are_not_read_end_the_connection() {
    for role in LISTENING {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let stranger = stage.connect(role.plain_peer()).await;
        let ping = b"\x04\x17\x04PING\0\0a context of 16b";
        end.during(flood(stranger, ping.repeat(1000))).await;
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn too_many_subscriptions_end_the_connection() {
    for role in [Role::Publish, Role::Tap] {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let long_topic = [&b"\x02\0\0\0\0\0\0\x80\x00\x01"[..], &[b'x'; 0x7fff]].concat();
        for subscriptions in [b"\0\x05\x01abcd".repeat(1000), b"\x04\x0a\x09SUBSCRIBE".repeat(1000), long_topic] {
            let stranger = stage.connect(role.plain_peer()).await;
            end.during(flood(stranger, subscriptions)).await;
        }
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn peers_that_never_read_delay_nobody_else() {
    for role in [Role::Publish, Role::Reply, Role::Tap] {
        let stage = Stage::new(TransportKind::Ipc);
        let mut end = role.open(&stage);
        let mut stranger = stage.connect(role.plain_peer()).await;
        if role == Role::Reply {
            // It asks, and does not read the answers.
            end.during(flood(stranger, b"\x01\0\0\xc8".iter().copied().chain([b'?'; 200]).collect())).await;
        } else {
            stranger.write_all(b"\0\x01\x01").await.unwrap();
            for _ in 0..20 {
                exchange(&stage, role, &mut end).await;
            }
        }
        exchange(&stage, role, &mut end).await;
    }
}

#[tokio::test]
async fn acknowledgements_of_what_was_never_sent_end_the_connection() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut end = Role::Publish.open(&stage);
    let mut stranger = stage.connect_silently().await;
    let hello = crate::transport::zeromq::zmtp::hello(
        crate::transport::zeromq::zmtp::SocketType::Sub,
        crate::transport::zeromq::credit::receiving(&super::stage::newest_only()),
    );
    stranger.write_all(&[&hello[..], b"\0\x01\x01\x04\x12\x09X-SCL-ACK\0\0\0\0\0\0\0\x01"].concat()).await.unwrap();
    end.during(closed(&mut stranger)).await;
    exchange(&stage, Role::Publish, &mut end).await;
}

#[tokio::test]
async fn a_refused_peer_is_not_connected_to() {
    for role in CONNECTING {
        let stage = Stage::new(TransportKind::Ipc);
        let allowed = Arc::new(AtomicBool::new(false));
        let asked = Arc::new(Mutex::new(0));
        let check = {
            let (allowed, asked) = (Arc::clone(&allowed), Arc::clone(&asked));
            move || {
                *asked.lock().unwrap() += 1;
                if allowed.load(Ordering::Relaxed) { Ok(()) } else { Err("another shape".to_owned()) }
            }
        };
        let mut end = role.open_at(&stage, &Endpoint { check: Some(Arc::new(check)), ..endpoint() });
        let bound = bind_ipc(&stage.dir, ENDPOINT).unwrap();
        let refusal = |end: &End| match end {
            End::Sender(sender) => sender.end.refusal(),
            End::Receiver(receiver) => receiver.refusal(),
            End::Requester(requester) => requester.refusal(),
            _ => None,
        };
        poll_fn(|cx| {
            end.drive(cx);
            if *asked.lock().unwrap() >= 3 { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert_eq!(refusal(&end).as_deref(), Some("another shape"));
        assert!(bound.listener.accept().is_err(), "connected in spite of the refusal");
        drop(bound);
        allowed.store(true, Ordering::Relaxed);
        exchange(&stage, role, &mut end).await;
        assert_eq!((refusal(&end), end.peers()), (None, 1));
    }
}
