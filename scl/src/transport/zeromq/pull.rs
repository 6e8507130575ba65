//! The pulling end: a PULL socket that any number of pushers connect to.

use super::Medium;
use super::frames::{Messages, single_frame};
use super::latecomers::ClosesLatecomers;
use super::listen::{Listening, listen};
use crate::place::{Claim, SystemDir};
use crate::sync::AbortOnDrop;
use crate::transport::{Inlet, TransportError};
use bytes::Bytes;
use std::task::{Context, Poll};
use zeromq::PullSocket;

pub(super) struct Pulling {
    messages: Messages<PullSocket>,
    malformed: u64,
    _connections: ClosesLatecomers,
    _door: AbortOnDrop,
    _guard: Claim,
}

impl Pulling {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let Listening { socket, events, door, guard } = listen::<PullSocket>(place, medium, endpoint)?;
        let connections = ClosesLatecomers::of(&socket);
        let door = door.watch(events);
        Ok(Self { messages: Messages::of(socket), malformed: 0, _connections: connections, _door: door, _guard: guard })
    }
}

impl Inlet for Pulling {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        loop {
            match self.messages.poll(cx) {
                Poll::Ready(Ok(message)) => match single_frame(message) {
                    Some(frame) => return Poll::Ready(frame),
                    None => self.malformed += 1,
                },
                // One pusher spoke nonsense or broke off; the library has dropped it, the others go on.
                Poll::Ready(Err(error)) => tracing::debug!(%error, "a pusher was dropped"),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn peers(&self) -> Option<usize> {
        None
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }
}
