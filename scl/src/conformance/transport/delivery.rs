//! Messages arrive complete, in order, once.

use super::ends::TestSender;
use super::{ENDPOINT, PATTERNS, Pattern, SIZES, check_carried, content, numbered};
use crate::transport::{Endpoint, Transport};
use bytes::Bytes;
use std::future::poll_fn;

/// The messages of one connection arrive complete, in order, and once each.
pub async fn keeps_order(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = (pattern.sender(transport), pattern.receiver(transport));
        check_carried(pattern, &mut sender, &mut receiver, &numbered(3000)).await;
    }
}

/// Messages of 0 bytes, of 1 byte, and of up to 1 MiB arrive unchanged.
pub async fn carries_every_size(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = (pattern.sender(transport), pattern.receiver(transport));
        let messages: Vec<Bytes> = SIZES.into_iter().map(content).collect();
        check_carried(pattern, &mut sender, &mut receiver, &messages).await;
    }
}

/// A message longer than the receiver's limit is never received. Shorter ones arrive afterwards, if need be over a new
/// connection; those sent in between may be lost with the old one.
pub async fn never_delivers_an_oversized_message(transport: &dyn Transport) {
    const LIMIT: usize = 1000;
    for pattern in PATTERNS {
        let limited = Endpoint { max_size: LIMIT, ..Endpoint::new(ENDPOINT) };
        let (mut sender, mut receiver) = pattern.connected_to(transport, &limited).await;
        check_carried(pattern, &mut sender, &mut receiver, &[content(LIMIT)]).await;
        for (round, size) in [LIMIT + 1, 70_000, 1 << 20].into_iter().enumerate() {
            sender.queue([content(size)]);
            let accepted = Bytes::from(format!("message {round}"));
            let arrives = poll_fn(|cx| {
                if sender.waiting() == 0 {
                    sender.queue([accepted.clone()]);
                }
                sender.poll(cx);
                cx.waker().wake_by_ref();
                receiver.poll(cx)
            });
            let message = arrives.await;
            assert!(message == accepted, "{pattern:?}: {} bytes arrived after {size} were sent", message.len());
            until_silent(&mut sender, &mut receiver, &accepted).await;
        }
    }

    /// Receives the repeated messages that are still on their way.
    async fn until_silent(sender: &mut TestSender, receiver: &mut super::TestReceiver, accepted: &Bytes) {
        let end = Bytes::from_static(b"end");
        sender.queue([end.clone()]);
        loop {
            let message = receiver.next(&mut [sender]).await;
            if message == end {
                return;
            }
            assert_eq!(message, *accepted, "received a message that was not sent");
        }
    }
}

/// What a link reports as written arrives, even if the sending end is dropped before the receiver looks.
pub async fn delivers_what_was_written(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        sender.queue(numbered(10));
        sender.until_written().await;
        drop(sender);
        for expected in numbered(10) {
            assert_eq!(receiver.next(&mut []).await, expected, "{pattern:?}: lost with its sender");
        }
    }
}

/// Several pushers share a puller: everything arrives, the messages of each pusher in order.
pub async fn serves_every_pusher(transport: &dyn Transport) {
    const PUSHERS: u8 = 5;
    const EACH: u32 = 400;
    let mut puller = Pattern::PushPull.receiver(transport);
    let mut pushers: Vec<TestSender> = (0..PUSHERS).map(|_| Pattern::PushPull.sender(transport)).collect();
    for (pusher, name) in pushers.iter_mut().zip(0..) {
        pusher.queue(numbered(EACH).into_iter().map(|number| [&[name], &number[..]].concat().into()));
    }
    let mut next = [0; PUSHERS as usize];
    for _ in 0..u32::from(PUSHERS) * EACH {
        let message = puller.next(&mut pushers.iter_mut().collect::<Vec<_>>()).await;
        let pusher = usize::from(message[0]);
        let number = message[1..].iter().fold(0, |number, byte| number << 8 | u32::from(*byte));
        assert_eq!(number, next[pusher], "a message of pusher {pusher} is out of order");
        next[pusher] += 1;
    }
}
