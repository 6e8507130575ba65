//! Requesting and replying ends, as the tests use them.

use super::watched::Watched;
use crate::transport::{Answer, IncomingRequest, Replier, Requester};
use bytes::Bytes;
use std::task::{Context, Poll, Waker};

/// A requesting end.
pub(super) type TestRequester = Watched<Box<dyn Requester>>;

impl TestRequester {
    pub(super) fn request(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        self.end.request(&mut Context::from_waker(&self.waker), id, body)
    }

    pub(super) fn poll_connected(&mut self, test: &Context<'_>) -> Poll<()> {
        self.poll_with(test, |end, cx| end.poll_connected(cx))
    }

    pub(super) fn poll_answer(&mut self, test: &Context<'_>) -> Poll<Answer> {
        self.poll_with(test, |end, cx| end.poll_answer(cx))
    }
}

/// A replying end.
pub(super) type TestReplier = Watched<Box<dyn Replier>>;

impl TestReplier {
    pub(super) fn poll(&mut self, test: &Context<'_>) -> Poll<IncomingRequest> {
        self.poll_with(test, |end, cx| end.poll_request(cx))
    }

    /// Ready when all replies are written.
    pub(super) fn poll_written(&mut self, test: &Context<'_>) -> Poll<()> {
        self.poll_with(test, |end, cx| if end.drive(cx) { Poll::Ready(()) } else { Poll::Pending })
    }

    /// Writes replies without a waker; returns true if all are written.
    pub(super) fn turn_detached(&mut self) -> bool {
        self.end.drive(&mut Context::from_waker(Waker::noop()))
    }
}
