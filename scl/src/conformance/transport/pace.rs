//! Peers of different speed, acknowledgements, and idle ends.

use super::ends::TestLink;
use super::{OTHER_ENDPOINT, PATTERNS, Pattern, content, numbered, requests};
use crate::transport::{Endpoint, Frame, Transport};
use bytes::Bytes;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::task::{Context, Poll};

/// A number of polls without progress after which an end counts as blocked.
const WITHOUT_PROGRESS: usize = 200;

/// A link refuses messages of a receiver that stops reading before 64 MiB are on their way. When the receiver reads
/// again, the sender is woken, and everything that was accepted arrives.
pub async fn stops_and_resumes(transport: &dyn Transport) {
    const MESSAGES: usize = 1024;
    let message = content(64 << 10);
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        sender.queue(vec![message.clone(); MESSAGES]);
        until_blocked(|cx| {
            sender.poll(cx);
            sender.waiting()
        })
        .await;
        assert!(sender.waiting() > 0, "{pattern:?}: {MESSAGES} messages were sent to a receiver that does not read");
        assert!(sender.waiting() < MESSAGES, "{pattern:?}: nothing was sent");
        for index in 0..MESSAGES {
            let received = receiver.next(&mut [&mut sender]).await;
            assert!(received == message, "{pattern:?}: message {index} of {MESSAGES} is damaged");
        }
    }
}

/// Each subscriber of an endpoint has a link of its own, and one that stops reading does not delay the other.
pub async fn keeps_subscribers_independent(transport: &dyn Transport) {
    const MESSAGES: usize = 1024;
    let message = content(64 << 10);
    let mut publisher = Pattern::PubSub.sender(transport);
    let mut stalled = Pattern::PubSub.receiver(transport);
    let mut to_stalled = poll_fn(|cx| {
        assert!(stalled.poll(cx).is_pending());
        publisher.poll_link(cx)
    })
    .await;
    let mut waiting: VecDeque<Frame> = (0..MESSAGES).map(|_| message.clone().into()).collect();
    until_blocked(|cx| {
        assert!(to_stalled.poll(cx, &mut waiting), "a subscriber that stops reading was disconnected");
        waiting.len()
    })
    .await;
    let blocked_at = waiting.len();
    assert!(blocked_at > 0, "{MESSAGES} messages were sent to a subscriber that does not read");

    let mut reading = Pattern::PubSub.receiver(transport);
    let mut to_reading = poll_fn(|cx| {
        assert!(reading.poll(cx).is_pending());
        publisher.poll_link(cx)
    })
    .await;
    let mut queue: VecDeque<Frame> = numbered(3000).into_iter().map(Frame::from).collect();
    for expected in numbered(3000) {
        let received = poll_fn(|cx| {
            assert!(to_stalled.poll(cx, &mut waiting) && to_reading.poll(cx, &mut queue), "a link is broken");
            reading.poll(cx)
        });
        assert_eq!(received.await, expected, "received a wrong message while another subscriber does not read");
    }
    assert_eq!(waiting.len(), blocked_at, "messages were sent to a subscriber that does not read");
    assert_eq!(publisher.peers(), 2, "number of links for two subscribers");

    for index in 0..MESSAGES {
        let received = poll_fn(|cx| {
            to_stalled.poll(cx, &mut waiting);
            stalled.poll(cx)
        });
        assert!(received.await == message, "message {index} of {MESSAGES} is damaged");
    }
}

/// A link that is asked for an acknowledgement is woken, and counts no unacknowledged messages, once the receiver has
/// taken everything. A transport without acknowledgements always counts none.
pub async fn acknowledges_what_was_taken(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        for count in [1, 7, 30] {
            sender.queue(numbered(count));
            sender.until_written().await;
            let link = sender.link.as_mut().unwrap_or_else(|| panic!("{pattern:?}: disconnected"));
            let sent = link.watched.end.unacknowledged();
            assert!(sent <= u64::from(count), "{pattern:?}: more is unacknowledged than was sent");
            link.request_acknowledgement();
            let asked = link.watched.wakes();
            for expected in numbered(count) {
                assert_eq!(receiver.next(&mut [&mut sender]).await, expected);
            }
            let is_acknowledged =
                |link: &TestLink| link.watched.end.unacknowledged() == 0 && (sent == 0 || link.watched.wakes() > asked);
            poll_fn(|cx| {
                assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received a message that was not sent");
                assert!(sender.poll(cx), "{pattern:?}: disconnected");
                if sender.link.as_ref().is_some_and(is_acknowledged) { Poll::Ready(()) } else { Poll::Pending }
            })
            .await;
        }
    }
}

/// Ends that have nothing to do are not woken while other ends are busy: connected ends, and listening ones without
/// peers. (An end without a listener to connect to may be woken to try again.)
pub async fn stays_quiet_when_idle(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        sender.queue([Bytes::from_static(b"the last message")]);
        receiver.next(&mut [&mut sender]).await;
        let mut lonely = Pattern::PubSub.sender_at(transport, &Endpoint::new("lonely.out--nobody.in.1a2b3c4d"));
        let (mut requester, mut replier) = requests::pair(transport).await;
        let mut wakes = Vec::new();
        for _ in 0..3 {
            be_busy(pattern, transport).await;
            poll_fn(|cx| {
                sender.poll(cx);
                lonely.poll(cx);
                assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received a message that was not sent");
                assert!(replier.poll(cx).is_pending(), "received a request that was not sent");
                assert!(requester.poll_answer(cx).is_pending(), "received a reply that was not sent");
                Poll::Ready(())
            })
            .await;
            wakes.push((sender.wakes(), receiver.watched.wakes(), lonely.wakes(), requester.wakes(), replier.wakes()));
        }
        // The first round may still complete earlier work, so only the later rounds are compared.
        let what = "wake-ups of an idle sender and its link, receiver, lonely publisher, requester, replier";
        assert_eq!(wakes[1], wakes[2], "{pattern:?}: {what}");
    }
}

async fn be_busy(pattern: Pattern, transport: &dyn Transport) {
    let (mut sender, mut receiver) = pattern.connected_to(transport, &Endpoint::new(OTHER_ENDPOINT)).await;
    sender.queue(numbered(1000));
    for _ in 0..1000 {
        receiver.next(&mut [&mut sender]).await;
    }
}

/// Polls until the returned number of waiting messages no longer changes.
async fn until_blocked(mut poll: impl FnMut(&Context<'_>) -> usize) {
    let (mut waiting, mut without_progress) = (usize::MAX, 0);
    poll_fn(|cx| {
        let before = std::mem::replace(&mut waiting, poll(cx));
        without_progress = if waiting == before { without_progress + 1 } else { 0 };
        cx.waker().wake_by_ref();
        if without_progress > WITHOUT_PROGRESS { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}
