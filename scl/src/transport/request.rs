//! Both ends of requests and their replies.

use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

/// What [`Requester::poll_answer`] returns.
#[derive(Debug)]
pub enum Answer {
    /// A reply and the number of the request it belongs to, which may be an old one.
    Reply {
        /// The number given to [`Requester::request`].
        id: u64,
        /// The reply.
        body: Bytes,
    },
    /// The replier has refused a request: it will not be answered.
    Refused {
        /// The number given to [`Requester::request`].
        id: u64,
    },
    /// The connection broke; requests sent over it will not be answered.
    Lost,
}

/// A requesting end.
pub trait Requester: Send {
    /// Ready when the replier is connected. Reconnects by itself. Discards replies to earlier requests, so it is not
    /// called while a reply is awaited.
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()>;

    /// Sends a request with a number, which its reply carries back. At most
    /// [`Endpoint::in_flight`](super::Endpoint::in_flight) requests may be without a reply.
    ///
    /// # Errors
    /// The body, if the replier is not connected, or there is no room for another request now.
    fn request(&mut self, cx: &mut Context<'_>, id: u64, body: Bytes) -> Result<(), Bytes>;

    /// Returns true if the replier is connected, as far as is known without polling.
    fn is_connected(&self) -> bool;

    /// Returns the next reply, or reports that the connection broke.
    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer>;

    /// Blocks the calling thread, without a runtime, until something has arrived or `within` is over; the next poll
    /// handles what arrived. Returns false if nothing arrived, and at once if this end cannot wait like this, which is
    /// the default.
    fn wait(&mut self, within: Duration) -> bool {
        let _cannot = within;
        false
    }

    /// Returns why [`Endpoint::check`](super::Endpoint::check) refused the peer that is listening, if it did.
    fn refusal(&self) -> Option<String> {
        None
    }
}

/// A request that has arrived, with the way back to its requester.
pub struct IncomingRequest {
    /// The request.
    pub body: Bytes,
    /// What [`ReplyPath::reply`] needs to address the requester.
    pub envelope: Bytes,
    /// The connection to the requester.
    pub path: Arc<dyn ReplyPath>,
}

/// The connection back to a requester.
pub trait ReplyPath: Send + Sync {
    /// Sends a reply.
    ///
    /// # Errors
    /// The requester has disconnected, or the replying end was dropped.
    fn reply(&self, envelope: &Bytes, body: Bytes) -> Result<(), RequesterGone>;

    /// Tells the requester, if the transport can, that its request will not be answered, for example because it could
    /// not be decoded: see [`Answer::Refused`]. The default does nothing, so the requester waits until its timeout.
    fn refuse(&self, envelope: &Bytes) {
        let _cannot = envelope;
    }
}

/// The requester disconnected before it was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RequesterGone;

/// A replying end.
pub trait Replier: Send {
    /// Returns the next request, and continues writing replies. Requests that do not consist of exactly one frame are
    /// counted and skipped.
    ///
    /// An implementation reads at most a bounded number of requests ahead.
    fn poll_request(&mut self, cx: &mut Context<'_>) -> Poll<IncomingRequest>;

    /// Accepts requesters and continues writing replies without returning a request. Returns true if everything sent
    /// has been handed to the operating system.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Number of connected requesters.
    fn peers(&self) -> usize;

    /// Number of messages skipped because they were not a request of one frame.
    fn malformed(&self) -> u64 {
        0
    }

    /// Prepares for calls without a runtime, as [`Sender::detach`](super::Sender::detach) does.
    fn detach(&mut self) {}
}
