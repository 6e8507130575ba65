//! The subscribing end: a SUB socket for each publisher, so that one that is lost is dialled again by itself.

use super::dial::Dials;
use super::frames::{Messages, single_frame};
use super::line::Line;
use crate::place::SystemDir;
use crate::transport::Inlet;
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll};
use zeromq::{SubSocket, ZmqResult};

pub(super) struct Subscribing {
    line: Line<SubSocket>,
    malformed: u64,
}

impl Subscribing {
    pub(super) fn open(place: &Arc<SystemDir>, endpoint: &str) -> Self {
        Self { line: Line::open(place, endpoint), malformed: 0 }
    }
}

impl Dials for SubSocket {
    type End = Messages<Self>;

    async fn prepare(&mut self) -> ZmqResult<()> {
        self.subscribe("").await
    }

    fn into_end(self) -> Messages<Self> {
        Messages::of(self)
    }
}

impl Inlet for Subscribing {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        loop {
            let Poll::Ready(dialled) = self.line.poll_dialled(cx) else { return Poll::Pending };
            match dialled.end.poll(cx) {
                Poll::Ready(Ok(message)) => match single_frame(message) {
                    Some(frame) => return Poll::Ready(frame),
                    None => self.malformed += 1,
                },
                Poll::Ready(Err(error)) => {
                    tracing::debug!(%error, "a connection broke");
                    self.line.lost();
                }
                Poll::Pending => match dialled.poll_lost(cx) {
                    Poll::Ready(()) => self.line.lost(),
                    Poll::Pending => return Poll::Pending,
                },
            }
        }
    }

    fn peers(&self) -> Option<usize> {
        Some(usize::from(self.line.is_connected()))
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }
}
