//! The end of a route at which messages arrive at this host.

use std::task::{Context, Poll};

use bytes::Bytes;

/// Receives the messages of one route: in order, each at most once.
#[derive(Debug)]
pub struct WireReceiver {}

/// Event of [`WireReceiver::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReceiverEvent {
    /// The sending side is open.
    Matched,
    /// The sending side closed, or the link is lost.
    Unmatched,
    /// The next message. Messages are numbered 1, 2, 3, ... since the last `set_open(true)`.
    Message(Bytes),
    /// The sending component wants its messages acknowledged now, for a flush.
    AcknowledgementRequested,
}

impl WireReceiver {
    /// Opens or closes this side. Closed at first. Each opening is a new epoch: the sender gives up what the last one did
    /// not acknowledge, messages are numbered from 1 again, and what was not polled is discarded.
    pub fn set_open(&mut self, open: bool) {
        let _ = open;
        unimplemented!()
    }

    /// The next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<ReceiverEvent> {
        let _ = cx;
        unimplemented!()
    }

    /// Tells the sender that the component has taken the first `count` messages since the last `set_open(true)`.
    pub fn acknowledge(&mut self, count: u64) {
        let _ = count;
        unimplemented!()
    }
}
