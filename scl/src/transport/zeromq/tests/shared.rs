//! Long messages in shared memory between SCL's ends, and through the socket to everybody else.

use super::stage::{ENDPOINT, Outgoing, Queued, Stage, next, pattern};
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::zmtp::{SclReady, SocketType, hello};
use crate::transport::{Endpoint, Frame, Receiver, Transport, TransportError};
use bytes::Bytes;
use std::task::{Context, Waker};
use tokio::io::{AsyncReadExt, AsyncWriteExt};

/// Long enough for shared memory.
pub(super) const LONG: usize = 70_000;

pub(super) fn endpoint() -> Endpoint {
    Endpoint { queue: 4, longest: 1 << 20, ..Endpoint::new(ENDPOINT) }
}

/// Both ends of a connection, in both directions.
pub(super) fn both(stage: &Stage, endpoint: &Endpoint) -> [(Outgoing, Box<dyn Receiver>); 2] {
    let other = Endpoint { name: "controller.jobs.1a2b3c4d".into(), ..endpoint.clone() };
    let transport = &stage.transport;
    [
        (Outgoing::new(transport.publish(endpoint).unwrap()), transport.subscribe(endpoint).unwrap()),
        (Outgoing::new(transport.push(&other).unwrap()), transport.pull(&other).unwrap()),
    ]
}

/// Returns true if bytes are in a file of shared memory.
fn is_shared(bytes: &[u8]) -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.lines().filter(|line| line.contains("/dev/shm/")).any(|line| {
        let (start, end) = line.split(' ').next().unwrap().split_once('-').unwrap();
        let address = |text| usize::from_str_radix(text, 16).unwrap();
        (address(start)..address(end)).contains(&bytes.as_ptr().addr())
    })
}

/// Waits until the sending end has learned that the receiving end has opened shared memory.
pub(super) async fn until_shared(sender: &mut Outgoing, receiver: &mut dyn Receiver) {
    sender.until_peers(1, receiver).await;
    sender.until(|sender| sender.link().loan(LONG).is_some()).await;
}

#[tokio::test]
async fn long_messages_are_in_shared_memory_and_short_ones_are_not() {
    let stage = Stage::new(TransportKind::Shm);
    for (mut sender, mut receiver) in both(&stage, &endpoint()) {
        until_shared(&mut sender, &mut *receiver).await;
        for size in [LONG, 3, 16 << 10, (16 << 10) + 1, 0, 3 << 20, LONG] {
            sender.queue([pattern(size), Bytes::from_static(b"next")]);
            let message = sender.during(next(&mut *receiver)).await;
            assert!(message == pattern(size), "{size} bytes");
            assert_eq!(is_shared(&message), size > 16 << 10, "{size} bytes");
            assert_eq!(sender.during(next(&mut *receiver)).await, "next");
        }
    }
}

#[tokio::test]
async fn loans_are_sent_as_they_are_and_those_of_others_as_copies() {
    let stage = Stage::new(TransportKind::Shm);
    let [(mut first, mut to_first), (mut second, mut to_second)] = both(&stage, &endpoint());
    until_shared(&mut first, &mut *to_first).await;
    until_shared(&mut second, &mut *to_second).await;
    for (sender, receiver, is_own) in [(&mut first, &mut to_first, true), (&mut second, &mut to_second, false)] {
        let mut loan = if is_own { sender.link().loan(LONG) } else { None };
        if !is_own {
            loan = Some(crate::transport::Loan::new(Elsewhere(vec![0; LONG])));
        }
        let mut loan = loan.unwrap();
        loan.as_mut_slice().copy_from_slice(&pattern(LONG));
        sender.peers[0].queue.push_back(Frame::Loan(loan));
        let message = sender.during(next(&mut **receiver)).await;
        assert!(message == pattern(LONG) && is_shared(&message));
    }
    assert!(first.link().loan(16 << 10).is_none(), "short messages are not lent memory for");
    let foreign = first.link().loan(LONG).unwrap();
    second.peers[0].queue.push_back(Frame::Loan(foreign));
    assert_eq!(second.during(next(&mut *to_second)).await.len(), LONG);
    assert!(first.link().loan(LONG).is_some(), "a loan that was copied is given back");
}

struct Elsewhere(Vec<u8>);

impl crate::transport::LoanedMemory for Elsewhere {
    fn bytes(&self) -> &[u8] {
        &self.0
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.0
    }
}

#[tokio::test]
async fn what_is_kept_stays_valid_and_no_more_is_sent_than_the_queue() {
    let stage = Stage::new(TransportKind::Shm);
    for (mut sender, mut receiver) in both(&stage, &endpoint()) {
        until_shared(&mut sender, &mut *receiver).await;
        sender.queue((0..40).map(|index| pattern(LONG + index)));
        sender.until(|sender| sender.link().unacknowledged() == 4).await;
        assert_eq!(sender.peers[0].queue.len(), 36);
        let mut kept = Vec::new();
        while kept.len() < 40 {
            kept.push(sender.during(next(&mut *receiver)).await);
        }
        for (index, message) in kept.iter().enumerate() {
            assert!(*message == pattern(LONG + index), "{index}");
            assert_eq!(is_shared(message), index < 4 + 8, "{index}: the queue and eight views are not copied");
        }
        poll_flushed(&mut sender, &mut *receiver).await;
        drop((sender, receiver));
        assert!(kept.iter().enumerate().all(|(index, message)| *message == pattern(LONG + index)));
    }
}

async fn poll_flushed(sender: &mut Outgoing, receiver: &mut dyn Receiver) {
    std::future::poll_fn(|cx| {
        sender.drive(cx);
        sender.link().request_acknowledgement(cx);
        assert!(receiver.poll_recv(cx).is_pending());
        sender.drive(cx);
        if sender.link().unacknowledged() == 0 { std::task::Poll::Ready(()) } else { std::task::Poll::Pending }
    })
    .await;
}

#[tokio::test]
async fn a_receiver_of_the_newest_gets_it() {
    let stage = Stage::new(TransportKind::Shm);
    for (mut sender, mut receiver) in both(&stage, &Endpoint { queue: 1, newest_only: true, ..endpoint() }) {
        until_shared(&mut sender, &mut *receiver).await;
        sender.queue((0..6).map(|index| pattern(LONG + index)));
        let mut newest = Bytes::new();
        while newest.len() < LONG + 5 {
            newest = sender.during(next(&mut *receiver)).await;
        }
        let caught_up = std::future::poll_fn(|cx| receiver.poll_caught_up(cx));
        sender.during(caught_up).await;
        assert!(newest == pattern(LONG + 5));
    }
}

#[tokio::test]
async fn a_detached_link_sends_beyond_the_window_through_the_socket() {
    let stage = Stage::new(TransportKind::Shm);
    for (mut sender, mut receiver) in both(&stage, &endpoint()) {
        until_shared(&mut sender, &mut *receiver).await;
        let cx = &mut Context::from_waker(Waker::noop());
        let Queued { link, queue, .. } = &mut sender.peers[0];
        link.detach();
        queue.extend((0..6).map(|index| Frame::from(pattern(LONG + index))));
        link.send_all(cx, None, queue, &mut |_| {});
        assert!(link.unacknowledged() > 4, "the window counts no longer");
        let receiving = tokio::spawn(async move {
            let mut received = Vec::new();
            while received.len() < 6 {
                received.push(next(&mut *receiver).await);
            }
            received
        });
        while !receiving.is_finished() {
            sender.drive(cx);
            tokio::task::yield_now().await;
        }
        let shared: Vec<bool> = receiving.await.unwrap().iter().map(|message| is_shared(message)).collect();
        assert_eq!(shared, [true, true, true, true, false, false]);
    }
}

#[tokio::test]
async fn plain_programs_and_ends_without_shared_memory_are_served_through_the_socket() {
    let stage = Stage::new(TransportKind::Shm);
    let other_width = b" shm=iceoryx2-0.10-16,0";
    let words: [&[u8]; 3] = [b"", b"1 window=4096,1048576", &[b"1 window=4096,1048576", &other_width[..]].concat()];
    for word in words {
        let mut publisher = Outgoing::new(stage.transport.publish(&endpoint()).unwrap());
        let mut stranger = stage.connect_silently().await;
        stranger.write_all(&[&hello_saying(word)[..], b"\0\x01\x01"].concat()).await.unwrap();
        publisher.until(|publisher| publisher.peers.len() == 1).await;
        assert!(publisher.link().loan(LONG).is_none());
        publisher.queue([pattern(LONG)]);
        let own = hello(SocketType::XPub, SclReady::default()).len();
        let mut heard = Vec::new();
        publisher
            .during(async {
                while !heard.ends_with(&pattern(LONG)) {
                    assert!(stranger.read_buf(&mut heard).await.unwrap() > 0);
                    assert!(heard.len() < own + LONG + 1000, "something else was sent");
                }
            })
            .await;
    }
}

/// What a subscriber says first whose property `X-SCL` is this.
pub(super) fn hello_saying(words: &[u8]) -> Vec<u8> {
    let greeting = &hello(SocketType::Pull, SclReady::default())[..64];
    let property = [&b"\x05X-SCL\0\0\0"[..], &[words.len() as u8], words].concat();
    let ready =
        [&b"\x05READY\x0bSocket-Type\0\0\0\x03SUB"[..], if words.is_empty() { b"" } else { &property }].concat();
    [greeting, &[4, ready.len() as u8], &ready].concat()
}

#[tokio::test]
async fn ends_that_listen_otherwise_are_sent_nothing_in_shared_memory() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let stage = Stage::new(kind);
        for (mut sender, mut receiver) in both(&stage, &endpoint()) {
            sender.until_peers(1, &mut *receiver).await;
            sender.queue([pattern(LONG)]);
            let message = sender.during(next(&mut *receiver)).await;
            assert!(message == pattern(LONG) && !is_shared(&message));
            assert!(sender.link().loan(LONG).is_none());
        }
    }
}

#[tokio::test]
async fn too_little_memory_is_refused_with_sizes_before_anything_is_sent() {
    let stage = Stage::new(TransportKind::Shm);
    let endpoint = Endpoint { queue: 100, longest: 1 << 50, ..Endpoint::new(ENDPOINT) };
    for refused in [stage.transport.publish(&endpoint).map(drop), stage.transport.pull(&endpoint).map(drop)] {
        let Err(TransportError::Refused { endpoint, reason }) = refused else { panic!("not refused") };
        assert_eq!(endpoint, ENDPOINT);
        for expected in
            ["bytes of shared memory are needed, and /dev/shm has", "`queue: 100`", "1125899906842624", "`max_size`"]
        {
            assert!(reason.contains(expected), "{reason}");
        }
    }
    // Connecting ends do not decide.
    stage.transport.subscribe(&endpoint).unwrap();
    stage.transport.push(&endpoint).unwrap();
}
