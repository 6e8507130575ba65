//! What the transport declares, and what gates conclude from it.

use super::{PATTERNS, numbered};
use crate::transport::{Endpoint, Guarantee, Guarantees, Transport};
use std::future::poll_fn;
use std::task::Poll;

/// The transport declares the guarantees that are tested, and no others.
pub fn declares(transport: &dyn Transport, tested: &[Guarantee]) {
    let tested: Guarantees = tested.iter().copied().collect();
    assert_eq!(
        transport.guarantees(),
        tested,
        "the transport declares the left set, and the tests are for the right one"
    );
}

/// What the receiver has not taken is counted as unacknowledged: at least the messages that it would need to acknowledge
/// one by one if it took them now.
pub async fn counts_what_was_not_taken(transport: &dyn Transport) {
    for pattern in PATTERNS {
        let (mut sender, _receiver) = pattern.connected(transport).await;
        sender.queue(numbered(5));
        poll_fn(|cx| {
            sender.poll(cx);
            if sender.is_written() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
        let unacknowledged = sender.link.as_ref().map(|link| link.unacknowledged());
        assert_eq!(unacknowledged, Some(5), "{pattern:?}: nothing was taken of 5 messages");
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
            assert_eq!(receiver.is_lossless(), lossless, "{pattern:?}");
        }
    }
}
