//! Credit between SCL's ends: windows, acknowledgements, and the newest message.

use super::stage::{Outgoing, Queued, Stage, endpoint, newest_only, next, number, numbered, once, pattern};
use crate::transport::zeromq::TransportKind;
use crate::transport::zeromq::credit::WINDOW as WINDOW_ANNOUNCED;
use crate::transport::{Endpoint, Frame, Receiver, Sent, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

const WINDOW: usize = WINDOW_ANNOUNCED.messages as usize;
const MANY: usize = 3 * WINDOW;

async fn pair(stage: &Stage, publishes: bool) -> (Outgoing, Box<dyn Receiver>) {
    pair_at(stage, publishes, &endpoint()).await
}

async fn pair_at(stage: &Stage, publishes: bool, endpoint: &Endpoint) -> (Outgoing, Box<dyn Receiver>) {
    let (mut sender, mut receiver) = match publishes {
        true => (stage.publisher(), stage.transport.subscribe(endpoint).unwrap()),
        false => (stage.pusher(), stage.transport.pull(endpoint).unwrap()),
    };
    sender.until_peers(1, &mut *receiver).await;
    (sender, receiver)
}

/// Lets the sender write what it may, without the receiver.
async fn settle(sender: &mut Outgoing) {
    for _ in 0..20 {
        once(|cx| sender.drive(cx)).await;
        tokio::task::yield_now().await;
    }
}

#[tokio::test]
async fn no_more_than_the_window_is_in_flight() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut sender, mut receiver) = pair(&stage, publishes).await;
        sender.queue(numbered(0..MANY as u32));
        settle(&mut sender).await;
        assert_eq!(sender.peers[0].queue.len(), MANY - WINDOW);
        assert_eq!(sender.link().unacknowledged(), WINDOW as u64);
        for expected in 0..WINDOW as u32 / 2 - 1 {
            assert_eq!(number(&next(&mut *receiver).await), expected);
        }
        settle(&mut sender).await;
        assert_eq!(sender.link().unacknowledged(), WINDOW as u64, "acknowledged before half of the window was taken");
        next(&mut *receiver).await;
        sender.until(|sender| sender.peers[0].queue.len() == MANY - WINDOW - WINDOW / 2).await;
        for expected in WINDOW as u32 / 2..MANY as u32 {
            assert_eq!(number(&sender.during(next(&mut *receiver)).await), expected);
        }
    }
}

#[tokio::test]
async fn long_messages_count_by_their_bytes() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair(&stage, false).await;
    let long = pattern(WINDOW_ANNOUNCED.bytes as usize * 3 / 4);
    sender.queue(vec![long.clone(); 10]);
    poll_fn(|cx| {
        sender.drive(cx);
        // Only the operating system's buffers and one read buffer take anything of these.
        if sender.peers[0].queue.len() < 10 { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
    for _ in 0..10 {
        assert!(sender.link().unacknowledged() <= 2);
        assert!(sender.during(next(&mut *receiver)).await == long);
    }
}

#[tokio::test]
async fn a_flush_is_answered_when_everything_was_taken() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut sender, mut receiver) = pair(&stage, publishes).await;
        sender.queue(numbered(0..10));
        settle(&mut sender).await;
        once(|cx| sender.link().request_acknowledgement(cx)).await;
        for _ in 0..10 {
            assert_eq!(sender.link().unacknowledged(), 10);
            next(&mut *receiver).await;
        }
        poll_fn(|cx| {
            assert!(receiver.poll_recv(cx).is_pending());
            sender.drive(cx);
            if sender.link().unacknowledged() == 0 { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert!(sender.link().is_written());
    }
}

/// Replaces what waits, as a publisher does for a subscriber with `queue: 1`.
fn publish_newest(sender: &mut Outgoing, cx: &mut Context<'_>, number: u32) {
    sender.peers[0].queue.clear();
    sender.queue(numbered(number..number + 1));
    sender.drive(cx);
}

/// Receives as a gate with `queue: 1` does; the first message that is known to be the newest.
fn poll_newest(receiver: &mut dyn Receiver, newest: &mut Option<u32>, cx: &mut Context<'_>) -> Poll<u32> {
    loop {
        while let Poll::Ready(message) = receiver.poll_recv(cx) {
            *newest = Some(number(&message));
        }
        if receiver.poll_caught_up(cx).is_pending() {
            return Poll::Pending;
        }
        match receiver.poll_recv(cx) {
            Poll::Ready(message) => *newest = Some(number(&message)),
            Poll::Pending => return newest.map_or(Poll::Pending, Poll::Ready),
        }
    }
}

#[tokio::test]
async fn after_a_pause_the_newest_message_is_received() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let (mut sender, mut receiver) = pair_at(&stage, publishes, &newest_only()).await;
        for pause in [1, 31, 32, 33, 63, 64, 65, 66, 127, 128, 1000, 1, 1, 1] {
            let first = pause * 10_000;
            for published in first..first + pause {
                once(|cx| publish_newest(&mut sender, cx, published)).await;
            }
            let mut newest = None;
            receiver.forget_answers();
            let received = poll_fn(|cx| {
                sender.drive(cx);
                poll_newest(&mut *receiver, &mut newest, cx)
            });
            assert_eq!(received.await, first + pause - 1, "after {pause} messages, published: {publishes}");
        }
    }
}

#[tokio::test]
async fn the_newest_message_is_found_without_help_from_the_runtime() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair_at(&stage, true, &newest_only()).await;
    let cx = &mut Context::from_waker(Waker::noop());
    // Nothing here waits, so the runtime never learns what has arrived.
    for published in 0..30 {
        publish_newest(&mut sender, cx, published);
        receiver.forget_answers();
        assert_eq!(poll_newest(&mut *receiver, &mut None, cx), Poll::Ready(published));
    }
    for published in 30..60 {
        publish_newest(&mut sender, cx, published);
        receiver.catch_up(Duration::ZERO);
        assert_eq!(receiver.poll_recv(cx).map(|message| number(&message)), Poll::Ready(published));
    }
}

#[tokio::test]
async fn a_stopped_publisher_does_not_stop_its_subscriber() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair_at(&stage, true, &newest_only()).await;
    for published in 0..100 {
        once(|cx| publish_newest(&mut sender, cx, published)).await;
    }
    let mut newest = None;
    let received = poll_fn(|cx| poll_newest(&mut *receiver, &mut newest, cx)).await;
    assert!(received < 99, "the last one is still in the publisher");
    // It is not waited for a second time.
    assert_eq!(once(|cx| poll_newest(&mut *receiver, &mut newest, cx)).await, Poll::Ready(received));
    poll_fn(|cx| {
        sender.drive(cx);
        poll_newest(&mut *receiver, &mut newest, cx).map(|received| assert!(received == 99 || received == 63))
    })
    .await;
}

#[tokio::test]
async fn catching_up_waits_for_a_publisher_in_another_thread() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair_at(&stage, true, &newest_only()).await;
    for published in 0..1000 {
        once(|cx| publish_newest(&mut sender, cx, published)).await;
    }
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    let publisher = std::thread::spawn(move || {
        let cx = &mut Context::from_waker(Waker::noop());
        sender.end.detach();
        sender.link().detach();
        while !stopped.load(Ordering::Relaxed) {
            sender.drive(cx);
            std::thread::yield_now();
        }
    });
    receiver.catch_up(Duration::from_secs(60));
    stop.store(true, Ordering::Relaxed);
    let mut received = Vec::new();
    while let Poll::Ready(message) = once(|cx| receiver.poll_recv(cx)).await {
        received.push(number(&message));
    }
    assert_eq!(received.last(), Some(&999), "{received:?}");
    publisher.join().unwrap();
}

#[tokio::test]
async fn a_sender_that_never_waits_sees_acknowledgements() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair(&stage, true).await;
    let receiving = std::thread::spawn(move || {
        let cx = &mut Context::from_waker(Waker::noop());
        for expected in 0..MANY as u32 {
            loop {
                receiver.catch_up(Duration::ZERO);
                if let Poll::Ready(message) = receiver.poll_recv(cx) {
                    break assert_eq!(number(&message), expected);
                }
                std::thread::yield_now();
            }
        }
    });
    let cx = &mut Context::from_waker(Waker::noop());
    let Queued { link, queue, .. } = &mut sender.peers[0];
    queue.extend(numbered(0..MANY as u32).map(Frame::from));
    // The runtime of this test gets no chance to look at the socket, and nobody drives the link.
    while !queue.is_empty() {
        link.send_all(cx, None, queue, &mut |_| {});
        std::thread::yield_now();
    }
    drop(sender);
    receiving.join().unwrap();
}

#[tokio::test]
async fn a_detached_link_does_not_wait_for_acknowledgements() {
    let stage = Stage::new(TransportKind::Ipc);
    let (mut sender, mut receiver) = pair(&stage, true).await;
    sender.end.detach();
    sender.link().detach();
    let cx = &mut Context::from_waker(Waker::noop());
    sender.queue(numbered(0..10_000));
    let mut sent = 0;
    let Queued { link, queue, .. } = &mut sender.peers[0];
    link.send_all(cx, None, queue, &mut |_| sent += 1);
    assert!(sent > WINDOW);
    // What the operating system did not take at once is written later, also without a runtime.
    let receiving = tokio::spawn(async move {
        for expected in 0..sent as u32 {
            assert_eq!(number(&next(&mut *receiver).await), expected);
        }
        receiver
    });
    while !sender.link().is_written() || sender.link().unacknowledged() > WINDOW as u64 / 2 {
        assert!(sender.link().drive(cx).is_ok());
        tokio::task::yield_now().await;
    }
    drop(receiving.await.unwrap());
    while sender.link().drive(cx).is_ok() {}
    assert!(matches!(sender.link().send(cx, Bytes::new().into()), Sent::Gone(_)));
}
