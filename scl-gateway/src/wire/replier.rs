//! The end of a route at which requests arrive at this host.

use std::task::{Context, Poll};

use bytes::Bytes;

/// Answers the requests of one route.
#[derive(Debug)]
pub struct WireReplier {}

/// Event of [`WireReplier::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReplierEvent {
    /// The requesting side's gateway is connected.
    Matched,
    /// The requesting side's gateway is not connected any more. Its requests may still be answered; nobody reads it.
    Unmatched,
    /// A request. Ids are unique within this value.
    Request { id: u64, body: Bytes },
}

impl WireReplier {
    /// Opens or closes this side. Closed at first. Closing gives up all open requests.
    pub fn set_open(&mut self, open: bool) {
        let _ = open;
        unimplemented!()
    }

    /// The next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<ReplierEvent> {
        let _ = cx;
        unimplemented!()
    }

    /// Answers request `id`. Unknown ids are ignored.
    pub fn reply(&mut self, id: u64, body: Bytes) {
        let _ = (id, body);
        unimplemented!()
    }

    /// Ends request `id` without a reply: the requester gets `Gone`.
    pub fn give_up(&mut self, id: u64) {
        let _ = id;
        unimplemented!()
    }
}
