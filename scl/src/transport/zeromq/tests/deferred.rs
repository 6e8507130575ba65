//! Acknowledgements that the caller of a receiving end gives.

use super::stage::{Outgoing, Stage, endpoint, next, number, numbered, once};
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::credit::ReceiveCredit;
use crate::transport::{Endpoint, Receiver, Transport, Window};
use std::future::poll_fn;
use std::task::{Context, Poll};

fn deferred() -> Endpoint {
    Endpoint { deferred: Some(Window { messages: 4, bytes: 1 << 20 }), ..endpoint() }
}

fn receiver(stage: &Stage, publishes: bool) -> Box<dyn Receiver> {
    if publishes { stage.transport.subscribe(&deferred()).unwrap() } else { stage.transport.pull(&deferred()).unwrap() }
}

fn sender(stage: &Stage, publishes: bool) -> Outgoing {
    if publishes { stage.publisher() } else { stage.pusher() }
}

/// Polls until the sender has these numbers of messages unacknowledged and waiting. The receiver has nothing to return.
async fn until(sender: &mut Outgoing, receiver: &mut dyn Receiver, unacknowledged: u64, waiting: usize) {
    poll_fn(|cx| {
        sender.drive(cx);
        assert!(receiver.poll_recv(cx).is_pending());
        let found = (sender.link().unacknowledged(), sender.peers[0].queue.len());
        if found == (unacknowledged, waiting) { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

#[tokio::test]
async fn only_what_the_caller_acknowledges_is_acknowledged() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut receiver, mut sender) = (receiver(&stage, publishes), sender(&stage, publishes));
        sender.until_peers(1, &mut *receiver).await;
        sender.queue(numbered(0..10));
        for expected in 0..4 {
            assert_eq!(number(&sender.during(next(&mut *receiver)).await), expected);
        }
        until(&mut sender, &mut *receiver, 4, 6).await;
        receiver.acknowledge(3);
        for expected in 4..7 {
            assert_eq!(number(&sender.during(next(&mut *receiver)).await), expected);
        }
        until(&mut sender, &mut *receiver, 4, 3).await;
        receiver.acknowledge(4);
        for expected in 7..10 {
            assert_eq!(number(&sender.during(next(&mut *receiver)).await), expected);
        }
        receiver.acknowledge(2);
        until(&mut sender, &mut *receiver, 1, 0).await;
        // One that does not exist is not acknowledged.
        receiver.acknowledge(7);
        until(&mut sender, &mut *receiver, 0, 0).await;
    }
}

#[tokio::test]
async fn a_flush_reaches_the_caller() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut receiver, mut sender) = (receiver(&stage, publishes), sender(&stage, publishes));
        sender.until_peers(1, &mut *receiver).await;
        sender.queue(numbered(0..3));
        for _ in 0..3 {
            sender.during(next(&mut *receiver)).await;
        }
        assert!(!receiver.take_acknowledgement_request(), "nobody has asked yet");
        once(|cx| sender.link().request_acknowledgement(cx)).await;
        poll_fn(|cx| {
            sender.drive(cx);
            assert!(receiver.poll_recv(cx).is_pending());
            if receiver.take_acknowledgement_request() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert!(!receiver.take_acknowledgement_request(), "it was asked once");
        assert_eq!(sender.link().unacknowledged(), 3, "the caller has acknowledged nothing");
        receiver.acknowledge(3);
        until(&mut sender, &mut *receiver, 0, 0).await;
    }
}

#[tokio::test]
async fn what_a_finished_end_did_not_take_stays_with_the_sender() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut receiver, mut sender) = (receiver(&stage, publishes), sender(&stage, publishes));
        sender.until_peers(1, &mut *receiver).await;
        sender.queue(numbered(0..10));
        for _ in 0..2 {
            sender.during(next(&mut *receiver)).await;
        }
        receiver.acknowledge(1);
        receiver.finish();
        let mut taken = 2;
        poll_fn(|cx| {
            sender.drive(cx);
            while let Poll::Ready(message) = receiver.poll_recv(cx) {
                assert_eq!(number(&message), taken);
                taken += 1;
            }
            if receiver.is_finished() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        receiver.acknowledge(9);
        // With room for more, nothing more is sent.
        until(&mut sender, &mut *receiver, 0, 10 - taken as usize).await;
        drop(receiver);
        poll_fn(|cx| {
            let left = std::mem::take(&mut sender.peers[0].queue);
            assert_eq!(left.len(), 10 - taken as usize);
            sender.peers[0].queue = left;
            if sender.peers[0].link.drive(cx).is_err() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert_eq!(sender.link().unacknowledged(), 0);
    }
}

#[tokio::test]
async fn each_pusher_gets_the_acknowledgements_of_its_messages() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut puller = receiver(&stage, false);
    let mut pushers = [stage.pusher(), stage.pusher(), stage.pusher()];
    let mut order = Vec::new();
    for pusher in &mut pushers {
        pusher.until_peers(1, &mut *puller).await;
    }
    for (index, count) in [(0, 2), (1, 1), (2, 1), (0, 1), (1, 2)] {
        pushers[index].queue(numbered(0..count));
        for _ in 0..count {
            pushers[index].during(next(&mut *puller)).await;
            order.push(index);
        }
    }
    let mut expected = [3, 3, 1];
    let drive = |pushers: &mut [Outgoing; 3], puller: &mut dyn Receiver, expected: [u64; 3], cx: &mut Context<'_>| {
        assert!(puller.poll_recv(cx).is_pending());
        pushers.iter_mut().for_each(|pusher| pusher.drive(cx));
        let found = [0, 1, 2].map(|index: usize| pushers[index].link().unacknowledged());
        if found == expected { Poll::Ready(()) } else { Poll::Pending }
    };
    for index in order {
        puller.acknowledge(1);
        expected[index] -= 1;
        poll_fn(|cx| drive(&mut pushers, &mut *puller, expected, cx)).await;
    }
}

#[tokio::test]
async fn the_next_publisher_is_not_acknowledged_what_the_last_one_sent() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut subscriber, mut publisher) = (receiver(&stage, true), stage.publisher());
    publisher.until_peers(1, &mut *subscriber).await;
    publisher.queue(numbered(0..3));
    for _ in 0..3 {
        publisher.during(next(&mut *subscriber)).await;
    }
    drop(publisher);
    let mut publisher = stage.publisher();
    publisher.until_peers(1, &mut *subscriber).await;
    publisher.queue(numbered(3..5));
    for _ in 0..2 {
        publisher.during(next(&mut *subscriber)).await;
    }
    subscriber.acknowledge(4);
    until(&mut publisher, &mut *subscriber, 1, 0).await;
}

#[test]
fn messages_that_the_caller_never_saw_are_acknowledged_in_order() {
    let mut credit = ReceiveCredit::new(&deferred());
    let taken = |credit: &mut ReceiveCredit, count| (0..count).for_each(|_| assert!(!credit.count_taken(1)));
    taken(&mut credit, 1);
    assert_eq!(credit.skip_last(), Some((1, 1)), "nothing is before it");
    taken(&mut credit, 2);
    assert_eq!(credit.skip_last(), None, "message 2 is before it");
    taken(&mut credit, 2);
    assert_eq!(credit.skip_last(), None);
    assert_eq!(credit.acknowledge_deferred(1), Some((3, 3)), "message 2, and the malformed one after it");
    assert_eq!(credit.acknowledge_deferred(1), Some((5, 5)));
}
