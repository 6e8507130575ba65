//! The pulling end: a PULL socket that any number of pushers connect to.

use super::Medium;
use super::frames::{poll_message, single_frame};
use super::listen::listen;
use crate::place::{Claim, SystemDir};
use crate::sync::AbortOnDrop;
use crate::transport::{Inlet, TransportError};
use bytes::Bytes;
use std::task::{Context, Poll};
use zeromq::{PullSocket, Socket};

pub(super) struct Pulling {
    socket: PullSocket,
    malformed: u64,
    _door: AbortOnDrop,
    _guard: Claim,
}

impl Pulling {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let mut listening = listen(place, medium, endpoint)?;
        let door = listening.door.watch(&mut listening.socket);
        Ok(Self { socket: listening.socket, malformed: 0, _door: door, _guard: listening.guard })
    }
}

/// The library lets go of a PULL socket's connections only when its process ends.
impl Drop for Pulling {
    fn drop(&mut self) {
        self.socket.backend().shutdown();
    }
}

impl Inlet for Pulling {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        loop {
            match poll_message(&mut self.socket, cx) {
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
