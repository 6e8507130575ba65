//! The ends of requests and replies, as the tests use them.

use super::watched::Watched;
use crate::transport::{Answer, IncomingRequest, Replier, Requester};
use bytes::Bytes;
use std::task::{Context, Poll, Waker};

/// A requesting end.
pub(super) struct TestRequester(Watched<Box<dyn Requester>>);

impl TestRequester {
    pub(super) fn new(end: Box<dyn Requester>) -> Self {
        Self(Watched::new(end))
    }

    pub(super) fn renew_waker(&mut self) {
        self.0.renew_waker();
    }

    pub(super) fn wakes(&self) -> usize {
        self.0.wakes()
    }

    pub(super) fn refusal(&self) -> Option<String> {
        self.0.end.refusal()
    }

    pub(super) fn is_connected(&self) -> bool {
        self.0.end.is_connected()
    }

    pub(super) fn request(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        self.0.end.request(&mut Context::from_waker(&self.0.waker), id, body)
    }

    pub(super) fn poll_connected(&mut self, test: &Context<'_>) -> Poll<()> {
        self.0.poll(test, |end, cx| end.poll_connected(cx))
    }

    pub(super) fn poll_answer(&mut self, test: &Context<'_>) -> Poll<Answer> {
        self.0.poll(test, |end, cx| end.poll_answer(cx))
    }
}

/// A replying end.
pub(super) struct TestReplier(Watched<Box<dyn Replier>>);

impl TestReplier {
    pub(super) fn new(end: Box<dyn Replier>) -> Self {
        Self(Watched::new(end))
    }

    pub(super) fn renew_waker(&mut self) {
        self.0.renew_waker();
    }

    pub(super) fn wakes(&self) -> usize {
        self.0.wakes()
    }

    pub(super) fn peers(&self) -> usize {
        self.0.end.peers()
    }

    pub(super) fn poll(&mut self, test: &Context<'_>) -> Poll<IncomingRequest> {
        self.0.poll(test, |end, cx| end.poll_request(cx))
    }

    /// Ready when all replies are written.
    pub(super) fn poll_written(&mut self, test: &Context<'_>) -> Poll<()> {
        self.0.poll(test, |end, cx| if end.drive(cx) { Poll::Ready(()) } else { Poll::Pending })
    }

    pub(super) fn detach(&mut self) {
        self.0.end.detach();
    }

    /// Writes replies without a waker; returns true if all are written.
    pub(super) fn turn_detached(&mut self) -> bool {
        self.0.end.drive(&mut Context::from_waker(Waker::noop()))
    }
}
