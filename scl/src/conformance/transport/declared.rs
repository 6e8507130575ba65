//! What the transport declares, and what gates conclude from it.

use super::{PATTERNS, numbered};
use crate::transport::{Endpoint, Guarantee, Guarantees, Transport};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::task::Poll;

/// The transport declares the guarantees that are tested, and no others.
pub fn declares(transport: &dyn Transport, tested: &[Guarantee]) {
    let tested: Guarantees = tested.iter().copied().collect();
    assert_eq!(
        transport.guarantees(),
        tested,
        "the transport declares the guarantees on the left, but is tested for those on the right"
    );
}

/// What the receiver has not taken is counted as unacknowledged: at least the messages that it would need to
/// acknowledge one by one if it took them now.
pub async fn counts_what_was_not_taken(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, _receiver) = pattern.connected(transport).await;
        sender.queue(numbered(5));
        sender.until_written().await;
        let unacknowledged = sender.link.as_ref().map(|link| link.watched.end.unacknowledged());
        assert_eq!(unacknowledged, Some(5), "{pattern:?}: nothing was taken of 5 messages");
    }
}

/// Before a receiving end is dropped, it reports which messages its program has received. The others count as not
/// received: those that wait in its gate, and those that were never taken.
pub async fn tells_what_was_received(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, mut receiver) = pattern.connected(transport).await;
        sender.queue(numbered(7));
        for expected in numbered(5) {
            assert_eq!(receiver.next(&mut [&mut sender]).await, expected);
        }
        receiver.leave(2);
        let mut link = sender.link.take().unwrap_or_else(|| panic!("{pattern:?}: disconnected"));
        let nothing = &mut VecDeque::new();
        poll_fn(|cx| if link.poll(cx, nothing) { Poll::Pending } else { Poll::Ready(()) }).await;
        assert_eq!(link.not_received_at_last(), 2 + 2, "{pattern:?}");
    }
}

/// A receiving end knows whether its sender waits for it instead of dropping messages.
pub async fn tells_who_waits(transport: &dyn Transport) {
    for pattern in PATTERNS {
        for lossless in [false, true] {
            let endpoint = Endpoint::new(super::ENDPOINT);
            let mut sender = pattern.sender_at(transport, &Endpoint { lossless, ..endpoint.clone() });
            let mut receiver = pattern.receiver_at(transport, &endpoint);
            sender.queue(numbered(1));
            receiver.next(&mut [&mut sender]).await;
            assert_eq!(receiver.watched.end.is_lossless(), lossless, "{pattern:?}");
        }
    }
}
