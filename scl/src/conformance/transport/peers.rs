//! Ends that connect in any order, and reconnect.

use super::ends::{TestReceiver, TestSender};
use super::request_ends::TestReplier;
use super::requests::{self, check_call};
use super::{ENDPOINT, PATTERNS, Pattern, check_carried, connect, numbered, turns};
use crate::transport::{Endpoint, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll};

/// An end waits for a peer that is opened later, and is woken by it; either end may be first.
pub async fn waits_for_a_late_peer(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut sender = pattern.sender(transport);
        turns(20, |cx| assert!(!sender.poll(cx), "{pattern:?}: connected without a receiver")).await;
        let mut receiver = pattern.receiver(transport);
        connect(&mut sender, &mut receiver).await;
        check_carried(pattern, &mut sender, &mut receiver, &numbered(3)).await;
        drop((sender, receiver));
        let mut sender = pattern.sender(transport);
        turns(20, |cx| assert!(!sender.poll(cx), "{pattern:?}: connected to a receiver that was dropped")).await;
        drop(sender);

        let mut receiver = pattern.receiver(transport);
        turns(20, |cx| assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received without a sender")).await;
        let mut sender = pattern.sender(transport);
        check_carried(pattern, &mut sender, &mut receiver, &numbered(3)).await;
    }
}

/// An end connects although it has no room for messages; either end may be first.
pub async fn connects_without_room(transport: &dyn Transport) {
    for pattern in PATTERNS {
        for sender_is_first in [true, false] {
            let sender = || pattern.sender(transport);
            let mut first = sender_is_first.then(sender);
            let mut receiver = pattern.receiver(transport);
            turns(20, |cx| receiver.connect(cx)).await;
            let mut sender = first.take().unwrap_or_else(sender);
            poll_fn(|cx| {
                receiver.connect(cx);
                if sender.poll(cx) && receiver.watched.end.peers() == 1 { Poll::Ready(()) } else { Poll::Pending }
            })
            .await;
            // Messages sent while the receiver has no room arrive as soon as it has.
            sender.queue(numbered(3));
            turns(20, |cx| {
                sender.poll(cx);
                receiver.connect(cx);
            })
            .await;
            receiver.watched.renew_waker();
            for expected in numbered(3) {
                assert_eq!(receiver.next(&mut [&mut sender]).await, expected, "{pattern:?}");
            }
        }
    }
}

/// A sending end returns each peer once.
pub async fn yields_each_peer_once(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut sender = pattern.sender(transport);
        for count in 1..=5 {
            let mut receiver = pattern.receiver(transport);
            connect(&mut sender, &mut receiver).await;
            check_carried(pattern, &mut sender, &mut receiver, &numbered(3)).await;
            turns(50, |cx| drop((sender.poll(cx), receiver.poll(cx)))).await;
            assert_eq!(sender.peers(), count, "{pattern:?}: number of peers after {count} receivers");
            drop(receiver);
            sender.until_connected(false).await;
        }
    }
}

/// A sender notices that its receiver was dropped, and messages sent afterwards reach the next one.
pub async fn serves_the_next_receiver(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut sender = pattern.sender(transport);
        for _ in 0..5 {
            let mut receiver = pattern.receiver(transport);
            check_carried(pattern, &mut sender, &mut receiver, &numbered(20)).await;
            drop(receiver);
            sender.until_connected(false).await;
        }
    }
}

/// A receiver outlives its sender and receives from the next one at the same endpoint.
pub async fn serves_the_next_sender(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut receiver = pattern.receiver(transport);
        for _ in 0..5 {
            let mut sender = pattern.sender(transport);
            check_carried(pattern, &mut sender, &mut receiver, &numbered(20)).await;
        }
    }
}

/// A pushing end whose link is dropped connects again to the puller that is still there.
pub async fn reconnects_after_a_dropped_link(transport: &dyn Transport) {
    let (mut pusher, mut puller) = Pattern::PushPull.connected(transport).await;
    for count in 1..=5 {
        check_carried(Pattern::PushPull, &mut pusher, &mut puller, &numbered(20)).await;
        assert_eq!(pusher.peers(), count, "number of connections so far");
        pusher.drop_link();
    }
}

/// An endpoint can be opened again as soon as its end is dropped.
pub async fn frees_its_endpoint(transport: &dyn Transport) {
    for pattern in PATTERNS {
        for _ in 0..20 {
            let (mut sender, mut receiver) = (pattern.sender(transport), pattern.receiver(transport));
            check_carried(pattern, &mut sender, &mut receiver, &numbered(2)).await;
        }
    }
}

/// A sender and a receiver find each other, at whatever stage of its connection an earlier peer was dropped.
pub async fn finds_the_peer_that_stays(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut sender = pattern.sender(transport);
        for count in 0..30 {
            let mut brief = pattern.receiver(transport);
            turns(count, |cx| drop((sender.poll(cx), brief.poll(cx)))).await;
            drop(brief);
            until_one_arrives(&mut sender, &mut pattern.receiver(transport)).await;
        }
        drop(sender);
        let mut receiver = pattern.receiver(transport);
        for count in 0..30 {
            let mut brief = pattern.sender(transport);
            turns(count, |cx| drop((brief.poll(cx), receiver.poll(cx)))).await;
            drop(brief);
            until_one_arrives(&mut pattern.sender(transport), &mut receiver).await;
        }
    }
}

/// A sender that is dropped releases its receiver, even one that connected before the sender was first polled.
pub async fn releases_an_idle_connection(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut receiver = pattern.receiver(transport);
        let mut idle = pattern.sender(transport);
        turns(200, |cx| assert!(receiver.poll(cx).is_pending(), "{pattern:?}: an idle sender has sent something"))
            .await;
        connect(&mut idle, &mut receiver).await;
        drop(idle);
        let mut sender = pattern.sender(transport);
        check_carried(pattern, &mut sender, &mut receiver, &numbered(3)).await;
    }
}

/// Receivers know how many peers are connected, and are woken when that changes.
pub async fn counts_peers(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let mut receiver = pattern.receiver(transport);
        assert_eq!(receiver.watched.end.peers(), 0, "{pattern:?}: peers of a receiver without sender");
        let mut sender = pattern.sender(transport);
        connect(&mut sender, &mut receiver).await;
        let has_peers = |receiver: &mut TestReceiver, count: usize, cx: &Context<'_>| {
            assert!(receiver.poll(cx).is_pending(), "{pattern:?}: received a message that was not sent");
            if receiver.watched.end.peers() == count { Poll::Ready(()) } else { Poll::Pending }
        };
        poll_fn(|cx| {
            assert!(sender.poll(cx), "{pattern:?}: disconnected");
            has_peers(&mut receiver, 1, cx)
        })
        .await;
        let woken = receiver.watched.wakes();
        drop(sender);
        poll_fn(|cx| has_peers(&mut receiver, 0, cx)).await;
        poll_fn(|_| if receiver.watched.wakes() > woken { Poll::Ready(()) } else { Poll::Pending }).await;
    }
}

/// Repliers know how many peers are connected, and are woken when that changes.
pub async fn counts_requesters(transport: &dyn Transport) {
    let mut replier = requests::replier(transport, &Endpoint::new(ENDPOINT));
    assert_eq!(replier.end.peers(), 0, "peers of a replier without requesters");
    let mut first = requests::requester(transport, &Endpoint::new(ENDPOINT));
    requests::connect(&mut first, &mut replier).await;
    let mut second = requests::requester(transport, &Endpoint::new(ENDPOINT));
    requests::connect(&mut second, &mut replier).await;
    let has_peers = |replier: &mut TestReplier, count: usize, cx: &Context<'_>| {
        assert!(replier.poll(cx).is_pending(), "received a request that was not sent");
        if replier.end.peers() == count { Poll::Ready(()) } else { Poll::Pending }
    };
    poll_fn(|cx| has_peers(&mut replier, 2, cx)).await;
    let woken = replier.wakes();
    drop(first);
    poll_fn(|cx| has_peers(&mut replier, 1, cx)).await;
    poll_fn(|_| if replier.wakes() > woken { Poll::Ready(()) } else { Poll::Pending }).await;
}

/// A connecting end does not connect to a listener that [`Endpoint::check`] refuses, and says why. It connects to the
/// next one if that is accepted.
pub async fn connects_only_if_the_check_passes(transport: &dyn Transport) {
    let (checked, accepts) = with_check();
    let mut subscriber = Pattern::PubSub.receiver_at(transport, &checked);
    let mut publisher = Pattern::PubSub.sender(transport);
    until(|cx| {
        assert!(!publisher.poll(cx), "a subscriber connected although its check refused");
        assert!(subscriber.poll(cx).is_pending());
        subscriber.watched.end.refusal()
    })
    .await;
    drop(publisher);
    accepts.store(true, Ordering::SeqCst);
    let mut publisher = Pattern::PubSub.sender(transport);
    check_carried(Pattern::PubSub, &mut publisher, &mut subscriber, &numbered(3)).await;
    assert_eq!(subscriber.watched.end.refusal(), None, "the reason of a refusal remains after it");

    let (checked, accepts) = with_check();
    let mut pusher = Pattern::PushPull.sender_at(transport, &checked);
    let mut puller = Pattern::PushPull.receiver(transport);
    until(|cx| {
        assert!(!pusher.poll(cx), "a pusher connected although its check refused");
        assert!(puller.poll(cx).is_pending() && puller.watched.end.peers() == 0);
        pusher.watched.end.refusal()
    })
    .await;
    drop(puller);
    accepts.store(true, Ordering::SeqCst);
    let mut puller = Pattern::PushPull.receiver(transport);
    check_carried(Pattern::PushPull, &mut pusher, &mut puller, &numbered(3)).await;
    assert_eq!(pusher.watched.end.refusal(), None, "the reason of a refusal remains after it");
}

/// A requester does not connect to a replier that its [`Endpoint::check`] refuses, and says why.
pub async fn requests_only_if_the_check_passes(transport: &dyn Transport) {
    let (checked, accepts) = with_check();
    let mut requester = requests::requester(transport, &checked);
    let mut replier = requests::replier(transport, &Endpoint::new(ENDPOINT));
    until(|cx| {
        assert!(requester.poll_connected(cx).is_pending(), "a requester connected although its check refused");
        assert!(replier.poll(cx).is_pending() && replier.end.peers() == 0);
        requester.end.refusal()
    })
    .await;
    drop(replier);
    accepts.store(true, Ordering::SeqCst);
    let mut replier = requests::replier(transport, &Endpoint::new(ENDPOINT));
    requests::connect(&mut requester, &mut replier).await;
    assert_eq!(requester.end.refusal(), None, "the reason of a refusal remains after it");
    check_call(&mut requester, &mut replier, 1).await;
}

/// Returns an endpoint with a check that refuses until the returned flag is set.
fn with_check() -> (Endpoint, Arc<AtomicBool>) {
    let accepts = Arc::new(AtomicBool::new(false));
    let decision = Arc::clone(&accepts);
    let check = move || if decision.load(Ordering::SeqCst) { Ok(()) } else { Err("another shape".to_owned()) };
    (Endpoint { check: Some(Arc::new(check)), ..Endpoint::new(ENDPOINT) }, accepts)
}

/// Polls again and again until there is a result, for state that an end reports without waking the task.
async fn until<R>(mut poll: impl FnMut(&Context<'_>) -> Option<R>) -> R {
    poll_fn(|cx| {
        cx.waker().wake_by_ref();
        poll(cx).map_or(Poll::Pending, Poll::Ready)
    })
    .await
}

/// Sends repeatedly, since a message for a peer that is being dropped may be lost with it.
async fn until_one_arrives(sender: &mut TestSender, receiver: &mut TestReceiver) {
    until(|cx| {
        if sender.waiting() == 0 {
            sender.queue([Bytes::from_static(b"again")]);
        }
        sender.poll(cx);
        receiver.poll(cx).is_ready().then_some(())
    })
    .await;
}
