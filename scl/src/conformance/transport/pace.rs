//! What happens when a peer is slower than the other, and when nothing happens.

use super::call::pair;
use super::flow::sender_sees;
use super::{ENDPOINT, FLOWS, Flow, OTHER_ENDPOINT, numbered, pattern};
use crate::transport::Transport;
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;

/// A receiver that stops reading makes `offer` give messages back before 64 MiB are under way; when it reads again, the
/// sender is woken, and everything that was taken arrives.
pub async fn stops_and_resumes(transport: &dyn Transport) {
    const MESSAGES: usize = 1024;
    let message = pattern(64 << 10);
    for flow in FLOWS {
        let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
        sender_sees(&mut sender, &mut receiver).await;
        sender.queue(vec![message.clone(); MESSAGES]);
        let mut quiet = 0;
        poll_fn(|cx| {
            let before = sender.left();
            sender.poll(cx);
            assert!(sender.left() > 0, "{flow:?}: a receiver that does not read was sent {MESSAGES} messages");
            quiet = if sender.left() == before { quiet + 1 } else { 0 };
            cx.waker().wake_by_ref();
            if quiet > 200 { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        assert!(sender.left() < MESSAGES, "{flow:?}: nothing was sent");
        for place in 0..MESSAGES {
            let received = receiver.next(&mut [&mut sender]).await;
            assert!(received == message, "{flow:?}: message {place} of {MESSAGES} is damaged");
        }
    }
}

/// Ends that have nothing to do are not woken, connected or not, while other ends are busy.
pub async fn stays_quiet_when_idle(transport: &dyn Transport) {
    for flow in FLOWS {
        let (mut sender, mut receiver) = flow.pair(transport, ENDPOINT);
        sender_sees(&mut sender, &mut receiver).await;
        sender.queue([Bytes::from_static(b"the last")]);
        receiver.next(&mut [&mut sender]).await;
        let mut lonely = flow.sender(transport, "lonely.out--nobody.in.1a2b3c4d");
        let (mut asker, mut answerer) = pair(transport, ENDPOINT).await;
        let mut wakes = Vec::new();
        for _ in 0..3 {
            make_noise(flow, transport).await;
            poll_fn(|cx| {
                sender.poll(cx);
                lonely.poll(cx);
                assert!(receiver.poll(cx).is_pending(), "{flow:?}: received what was not sent");
                assert!(answerer.poll(cx).is_pending(), "asked what nobody asked");
                assert!(asker.poll_answer(cx).is_pending(), "answered what nobody asked");
                Poll::Ready(())
            })
            .await;
            let of_flow = [sender.wakes(), receiver.wakes(), lonely.wakes()];
            wakes.push((of_flow, [asker.wakes(), answerer.wakes()]));
        }
        // The first round is for what is still under way from before.
        assert_eq!(wakes[1], wakes[2], "{flow:?}: idle ends (sender, receiver, lonely), (asker, answerer) were woken");
    }
}

async fn make_noise(flow: Flow, transport: &dyn Transport) {
    let (mut sender, mut receiver) = flow.pair(transport, OTHER_ENDPOINT);
    sender.queue(numbered(1000));
    for _ in 0..1000 {
        receiver.next(&mut [&mut sender]).await;
    }
}
