//! What sending and receiving ends guarantee.

use super::watched::{Receiving, Sending};
use super::{ENDPOINT, FLOWS, Flow, SIZES, numbered, pattern};
use crate::transport::Transport;
use bytes::Bytes;
use std::future::poll_fn;
use std::task::{Context, Poll};

/// Messages of one connection arrive whole, in order, each once.
pub async fn keeps_order(transport: &dyn Transport) {
    for flow in FLOWS {
        let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
        let messages = numbered(3000);
        check_carried(flow, &mut sender, &mut receiver, &messages).await;
    }
}

/// Frames of 0 bytes, of 1 byte, and up to 1 MiB arrive as they were sent.
pub async fn carries_every_size(transport: &dyn Transport) {
    for flow in FLOWS {
        let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
        let messages: Vec<Bytes> = SIZES.into_iter().map(pattern).collect();
        check_carried(flow, &mut sender, &mut receiver, &messages).await;
    }
}

/// A message that is offered while nobody is there is given back, and is not delivered later.
pub async fn gives_back_what_nobody_takes(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut sender = flow.sender(transport, ENDPOINT);
        let lost = Bytes::from_static(b"to nobody");
        assert_eq!(sender.offer(lost.clone()), Err(lost.clone()), "{flow:?}: offered before it was driven");
        poll_fn(|cx| {
            assert!(!sender.poll(cx), "{flow:?}: a peer is reported where none is");
            Poll::Ready(())
        })
        .await;
        assert_eq!(sender.offer(lost.clone()), Err(lost), "{flow:?}: offered to nobody");
        let mut receiver = flow.receiver(transport, ENDPOINT);
        check_carried(flow, &mut sender, &mut receiver, &numbered(3)).await;
    }
}

/// A peer that appears later is reported by `drive`, after the task was woken for it; either end may be first.
pub async fn reports_a_late_peer(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut sender = flow.sender(transport, ENDPOINT);
        idle(20, |cx| assert!(!sender.poll(cx), "{flow:?}: a peer is reported where none is")).await;
        let mut receiver = flow.receiver(transport, ENDPOINT);
        sender_sees(&mut sender, &mut receiver).await;
        check_carried(flow, &mut sender, &mut receiver, &numbered(3)).await;
        drop((sender, receiver));

        let mut receiver = flow.receiver(transport, ENDPOINT);
        idle(20, |cx| assert!(receiver.poll(cx).is_pending(), "{flow:?}: received from nobody")).await;
        let mut sender = flow.sender(transport, ENDPOINT);
        check_carried(flow, &mut sender, &mut receiver, &numbered(3)).await;
    }
}

/// A receiver that goes away is noticed without a message being lost with it, and the next one is served.
pub async fn serves_the_next_receiver(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut sender = flow.sender(transport, ENDPOINT);
        for _ in 0..5 {
            let mut receiver = flow.receiver(transport, ENDPOINT);
            check_carried(flow, &mut sender, &mut receiver, &numbered(20)).await;
            drop(receiver);
            sender.until_present(false).await;
            let late = Bytes::from_static(b"too late");
            assert_eq!(sender.offer(late.clone()), Err(late), "{flow:?}: taken for a peer that is gone");
        }
    }
}

/// A receiver outlives its sender, and hears the next one at the same endpoint.
pub async fn serves_the_next_sender(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut receiver = flow.receiver(transport, ENDPOINT);
        for _ in 0..5 {
            let mut sender = flow.sender(transport, ENDPOINT);
            check_carried(flow, &mut sender, &mut receiver, &numbered(20)).await;
        }
    }
}

/// Several pushers share one puller: everything arrives, each pusher's messages in order.
pub async fn serves_every_pusher(transport: &dyn Transport) {
    const PUSHERS: u8 = 5;
    const EACH: u32 = 400;
    let mut puller = Flow::PushPull.receiver(transport, ENDPOINT);
    let mut pushers: Vec<Sending> = (0..PUSHERS).map(|_| Flow::PushPull.sender(transport, ENDPOINT)).collect();
    for (pusher, name) in pushers.iter_mut().zip(0..) {
        pusher.queue(numbered(EACH).into_iter().map(|number| [&[name], &number[..]].concat().into()));
    }
    let mut next = [0; PUSHERS as usize];
    for _ in 0..u32::from(PUSHERS) * EACH {
        let message = puller.next(&mut pushers.iter_mut().collect::<Vec<_>>()).await;
        let pusher = usize::from(message[0]);
        let number = message[1..].iter().fold(0, |number, byte| number << 8 | u32::from(*byte));
        assert_eq!(number, next[pusher], "pusher {pusher} is out of order");
        next[pusher] += 1;
    }
}

/// What a sender reports as flushed arrives, even if the sender is gone before the receiver looks.
pub async fn keeps_what_is_flushed(transport: &dyn Transport) {
    for flow in FLOWS {
        let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
        sender_sees(&mut sender, &mut receiver).await;
        sender.queue(numbered(10));
        poll_fn(|cx| {
            sender.poll(cx);
            if sender.is_flushed() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        drop(sender);
        for expected in numbered(10) {
            assert_eq!(receiver.next(&mut []).await, expected, "{flow:?}: lost with its sender");
        }
    }
}

/// An endpoint can be opened again as soon as its end is dropped, as often as one likes.
pub async fn frees_its_endpoint(transport: &dyn Transport) {
    for flow in FLOWS {
        for _ in 0..20 {
            let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
            check_carried(flow, &mut sender, &mut receiver, &numbered(2)).await;
        }
    }
}

/// A sender and a receiver that stay find each other, whatever one of them was doing with a peer that went at once.
pub async fn finds_the_peer_that_stays(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut sender = flow.sender(transport, ENDPOINT);
        for turns in 0..30 {
            let mut hasty = flow.receiver(transport, ENDPOINT);
            idle(turns, |cx| drop((sender.poll(cx), hasty.poll(cx)))).await;
            drop(hasty);
            until_one_arrives(&mut sender, &mut flow.receiver(transport, ENDPOINT)).await;
        }
        drop(sender);
        let mut receiver = flow.receiver(transport, ENDPOINT);
        for turns in 0..30 {
            let mut hasty = flow.sender(transport, ENDPOINT);
            idle(turns, |cx| drop((hasty.poll(cx), receiver.poll(cx)))).await;
            drop(hasty);
            until_one_arrives(&mut flow.sender(transport, ENDPOINT), &mut receiver).await;
        }
    }
}

/// A sender that is gone leaves its receiver to the next one, also a receiver that had found it before it was driven.
pub async fn lets_go_of_who_came_early(transport: &dyn Transport) {
    for flow in FLOWS {
        let mut receiver = flow.receiver(transport, ENDPOINT);
        let mut hasty = flow.sender(transport, ENDPOINT);
        idle(200, |cx| assert!(receiver.poll(cx).is_pending(), "{flow:?}: a sender that was never driven has sent"))
            .await;
        sender_sees(&mut hasty, &mut receiver).await;
        drop(hasty);
        let mut sender = flow.sender(transport, ENDPOINT);
        check_carried(flow, &mut sender, &mut receiver, &numbered(3)).await;
    }
}

/// Sends again and again, since what is sent to a peer that is just going may be lost with it.
async fn until_one_arrives(sender: &mut Sending, receiver: &mut Receiving) {
    poll_fn(|cx| {
        if sender.left() == 0 {
            sender.queue([Bytes::from_static(b"again")]);
        }
        sender.poll(cx);
        cx.waker().wake_by_ref();
        receiver.poll(cx).map(drop)
    })
    .await;
}

/// Sends messages and a mark, and receives exactly these.
async fn check_carried(flow: Flow, sender: &mut Sending, receiver: &mut Receiving, messages: &[Bytes]) {
    let mark = Bytes::from_static(b"the end");
    sender.queue(messages.iter().cloned().chain([mark]));
    for (place, expected) in messages.iter().enumerate() {
        let message = receiver.next(&mut [sender]).await;
        let sizes = (message.len(), expected.len());
        assert!(message == *expected, "{flow:?}: message {place} is another one, of sizes {sizes:?}: {message:.20?}");
    }
    assert_eq!(receiver.next(&mut [sender]).await, b"the end"[..], "{flow:?}: more than was sent");
}

/// Waits until the sender reports its peer, with the receiver kept going.
pub(super) async fn sender_sees(sender: &mut Sending, receiver: &mut Receiving) {
    poll_fn(|cx| {
        assert!(receiver.poll(cx).is_pending(), "received something that was not sent");
        if sender.poll(cx) { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

/// Keeps an end going while others have a chance to run.
async fn idle(turns: usize, mut poll: impl FnMut(&Context<'_>)) {
    for _ in 0..turns {
        poll_fn(|cx| {
            poll(cx);
            Poll::Ready(())
        })
        .await;
        tokio::task::yield_now().await;
    }
}
