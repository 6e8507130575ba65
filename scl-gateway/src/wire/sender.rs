//! The end of a route at which messages leave this host.

use std::task::{Context, Poll};

use bytes::Bytes;

/// Sends the messages of one route.
///
/// Messages are numbered 1, 2, 3, ... in the order of [`send`](Self::send), over the whole life of this value.
#[derive(Debug)]
pub struct WireSender {}

/// Event of [`WireSender::poll_event`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SenderEvent {
    /// The receiving side is open. What was unacknowledged has been sent again if it is the same one as before.
    Matched,
    /// The receiving side closed, or the link is lost. Unacknowledged messages stay here for the next match.
    Unmatched,
    /// All messages up to this number are taken by the receiving component (or were given up before).
    Acknowledged(u64),
    /// This many of the oldest messages were unacknowledged when another receiver took the place of theirs: whether they
    /// arrived is unknown, and they are not sent again. Comes after the `Matched` of the new receiver.
    GivenUp(u64),
    /// [`may_send`](WireSender::may_send) was false and could be true now.
    Credit,
}

impl WireSender {
    /// Shows or withdraws this side's presence. Closed at first. Closing keeps what is unacknowledged.
    pub fn set_open(&mut self, open: bool) {
        let _ = open;
        unimplemented!()
    }

    /// The next event. Must be polled while messages are on their way: it also sends what got lost again.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<SenderEvent> {
        let _ = cx;
        unimplemented!()
    }

    /// Returns true if the other side is matched and a message of this length fits into the window.
    pub fn may_send(&self, length: usize) -> bool {
        let _ = length;
        unimplemented!()
    }

    /// Sends a message. The caller asks [`may_send`](Self::may_send) before; a message sent without credit or match is kept
    /// and sent when there is.
    pub fn send(&mut self, message: Bytes) {
        let _ = message;
        unimplemented!()
    }

    /// Asks the other side for [`ReceiverEvent::AcknowledgementRequested`](super::ReceiverEvent), for a flush.
    pub fn request_acknowledgement(&mut self) {
        unimplemented!()
    }

    /// Number of messages sent and neither acknowledged nor given up.
    pub fn unacknowledged(&self) -> u64 {
        unimplemented!()
    }
}
