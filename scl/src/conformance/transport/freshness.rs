//! Ends that want only the newest message, see [`Endpoint::newest_only`].
//!
//! The sender in these tests does what a gate with a queue of 1 does: a message that the link refuses waits, and a
//! newer one takes its place.

use super::ends::{TestReceiver, TestSender};
use super::{ENDPOINT, PATTERNS, Pattern, connect, turns};
use crate::conformance::PATIENCE;
use crate::transport::{Endpoint, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::net::UnixStream;

/// More messages than fit between two ends.
const MANY: u64 = 5000;
/// How long one of several senders is polled before the next one has its turn.
const TURN: Duration = Duration::from_millis(2);
/// Maximum number of turns: each sender answers in its first turn or two, even on a busy machine.
const MOST_TURNS: usize = 20;

/// After a pause, a receiver that has caught up has the newest message, however many were sent during the pause.
pub async fn returns_the_newest_message(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = connected(pattern, transport).await;
        let mut last = 0;
        for count in [1, 2, 50, MANY, 1, MANY] {
            send(&mut sender, &mut last, count).await;
            let newest = newest(&mut sender, &mut receiver).await;
            assert_eq!(newest, Some(last), "{pattern:?}: the newest after {count} messages");
            assert_eq!(self::newest(&mut sender, &mut receiver).await, None, "{pattern:?}: a message arrived twice");
            assert_eq!(sender.waiting(), 0, "{pattern:?}: the newest message was not sent");
        }
    }
}

/// A receiver catches up even if the sender never pauses, and returns a message that is not older than the call.
pub async fn catches_up_with_a_busy_sender(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = connected(pattern, transport).await;
        let mut last = 0;
        send(&mut sender, &mut last, MANY).await;
        for _ in 0..10 {
            let called_at = last;
            let newest = until_caught_up(|cx| {
                for _ in 0..100 {
                    last += 1;
                    sender.replace(message(last));
                    sender.poll(cx);
                }
                poll_newest(&mut receiver, cx)
            });
            let newest = newest.await;
            assert!(newest >= called_at, "{pattern:?}: {newest} is older than the call, {called_at}");
            let sent = last - called_at;
            assert!(sent <= MANY, "{pattern:?}: the sender sent {sent} messages until the receiver had caught up");
            // The sender continues between two calls.
            send(&mut sender, &mut last, 1000).await;
        }
    }
}

/// Slow senders need not answer at the same time: the answer of one counts until the other has answered.
pub async fn catches_up_with_senders_that_answer_in_turn(transport: &dyn Transport) {
    let endpoint = Endpoint { newest_only: true, ..Endpoint::new(ENDPOINT) };
    let mut puller = Pattern::PushPull.receiver_at(transport, &endpoint);
    let mut pushers = [(); 2].map(|()| Pattern::PushPull.sender(transport));
    let mut last = 0;
    for pusher in &mut pushers {
        connect(pusher, &mut puller).await;
    }
    for pusher in &mut pushers {
        send(pusher, &mut last, MANY).await;
    }
    for _ in 0..10 {
        let called_at = last;
        let (mut turn, mut turn_began) = (0, Instant::now());
        let newest = until_caught_up(|cx| {
            if turn_began.elapsed() >= TURN {
                (turn, turn_began) = (turn + 1, Instant::now());
            }
            let pusher = &mut pushers[turn % 2];
            last += 1;
            pusher.replace(message(last));
            pusher.poll(cx);
            poll_newest(&mut puller, cx)
        });
        let newest = newest.await;
        assert!(newest >= called_at, "{newest} is older than the call, {called_at}");
        assert!(turn <= MOST_TURNS, "the pushers had {turn} turns until the puller had caught up");
    }
}

/// [`Receiver::catch_up`](crate::transport::Receiver::catch_up) gets the newest message from a sender in another
/// thread, without help from a runtime. It gives up in time if that sender does nothing, and the next call does not
/// accept an answer to the one that gave up.
pub async fn catches_up_without_a_runtime(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, receiver) = connected(pattern, transport).await;
        let mut last = 0;
        send(&mut sender, &mut last, MANY).await;
        let mut receiver = give_up(pattern, receiver);
        send(&mut sender, &mut last, 2).await;
        assert_eq!(newest(&mut sender, &mut receiver).await, Some(last), "{pattern:?}: the newest after giving up");
        send(&mut sender, &mut last, MANY).await;
        let mut receiver = give_up(pattern, receiver);
        send(&mut sender, &mut last, MANY).await;
        sender.detach();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let sending = std::thread::spawn(move || {
            while !stopped.load(Ordering::SeqCst) {
                sender.turn_detached();
                std::thread::yield_now();
            }
            sender
        });
        let newest = receiver.fetch(PATIENCE).last().map(number);
        stop.store(true, Ordering::SeqCst);
        assert!(sending.join().is_ok(), "{pattern:?}: the sending thread panicked");
        assert_eq!(newest, Some(last), "{pattern:?}: the newest message");
        assert!(receiver.fetch(Duration::ZERO).is_empty(), "{pattern:?}: a message arrived twice");
    }
}

/// Lets a receiver catch up with a sender that does nothing, in a thread that is abandoned if that takes too long.
fn give_up(pattern: Pattern, mut receiver: TestReceiver) -> TestReceiver {
    let (returned, gave_up) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        receiver.fetch(Duration::from_millis(1));
        returned.send(receiver)
    });
    let receiver = gave_up.recv_timeout(PATIENCE);
    receiver.unwrap_or_else(|_| panic!("{pattern:?}: `catch_up` waits longer than `within`"))
}

async fn connected(pattern: Pattern, transport: &dyn Transport) -> (TestSender, TestReceiver) {
    let endpoint = Endpoint { newest_only: true, ..Endpoint::new(ENDPOINT) };
    pattern.connected_to(transport, &endpoint).await
}

/// Sends a number of messages while the receiver is not polled.
async fn send(sender: &mut TestSender, last: &mut u64, count: u64) {
    let mut left = count;
    while left > 0 {
        let batch = left.min(100);
        left -= batch;
        turns(1, |cx| {
            for _ in 0..batch {
                *last += 1;
                sender.replace(message(*last));
                assert!(sender.poll(cx), "disconnected");
            }
        })
        .await;
    }
}

/// Polls a sender that does not pause, and its receiver, until the receiver has caught up.
async fn until_caught_up(mut poll: impl FnMut(&Context<'_>) -> Poll<u64>) -> u64 {
    loop {
        match poll_fn(|cx| Poll::Ready(poll(cx))).await {
            Poll::Ready(newest) => return newest,
            Poll::Pending => sockets_looked_at().await,
        }
    }
}

/// Waits until the runtime has polled its sockets. The thread that polls them may be late on a busy machine, and an end
/// that is not woken for an answer cannot read it.
async fn sockets_looked_at() {
    let (end, other) = UnixStream::pair().expect("two connected sockets");
    drop(other);
    end.readable().await.expect("the other end is closed");
}

/// Returns the newest message of a sender that never pauses. Stays pending if nothing was sent since the last call,
/// which happens if the sender's link was not woken.
fn poll_newest(receiver: &mut TestReceiver, cx: &Context<'_>) -> Poll<u64> {
    match receiver.poll_newest(cx) {
        Poll::Ready(Some(newest)) => Poll::Ready(number(&newest)),
        Poll::Ready(None) | Poll::Pending => Poll::Pending,
    }
}

async fn newest(sender: &mut TestSender, receiver: &mut TestReceiver) -> Option<u64> {
    let newest = poll_fn(|cx| {
        sender.poll(cx);
        receiver.poll_newest(cx)
    });
    newest.await.map(|newest| number(&newest))
}

/// A message of 1 KiB that begins with a number.
fn message(number: u64) -> Bytes {
    let mut bytes = number.to_be_bytes().to_vec();
    bytes.resize(1024, 0);
    bytes.into()
}

fn number(message: &Bytes) -> u64 {
    message[..8].iter().fold(0, |number, byte| number << 8 | u64::from(*byte))
}
