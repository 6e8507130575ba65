//! The end of a route at which requests leave this host.

use std::task::{Context, Poll};

use bytes::Bytes;

/// Sends requests to the `rep` gate of another host. Always open.
#[derive(Debug)]
pub struct WireRequester {}

/// Event of [`WireRequester::poll_event`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum RequesterEvent {
    /// The replying side is open.
    Matched,
    /// The replying side closed, or the link is lost. Open requests end with `Gone`.
    Unmatched,
    /// The reply to request `id`.
    Reply { id: u64, body: Bytes },
    /// Request `id` gets no reply.
    Gone { id: u64 },
}

impl WireRequester {
    /// The next event.
    pub fn poll_event(&mut self, cx: &mut Context<'_>) -> Poll<RequesterEvent> {
        let _ = cx;
        unimplemented!()
    }

    /// Sends a request. `id` must be unused among the open requests. Exactly one `Reply` or `Gone` follows; without a match
    /// it is `Gone`.
    pub fn request(&mut self, id: u64, body: Bytes) {
        let _ = (id, body);
        unimplemented!()
    }
}
