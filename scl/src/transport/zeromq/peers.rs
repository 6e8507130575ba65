//! The peers of an XPUB socket, so that their connections can be closed.
//!
//! The library keeps the connections of an XPUB socket open after the socket is dropped, until the process ends: a
//! component that is closed and opened again in one process would leave its subscribers waiting at the old one. Telling
//! the library that each peer left closes its connection.

use super::door::Door;
use futures_core::Stream;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use zeromq::util::PeerIdentity;
use zeromq::{MultiPeerBackend, Socket, SocketEvent};

pub(super) struct Peers {
    backend: Arc<dyn MultiPeerBackend>,
    events: Pin<Box<dyn Stream<Item = SocketEvent> + Send>>,
    accepted: Vec<PeerIdentity>,
    door: Door,
}

impl Peers {
    pub(super) fn of(socket: &mut impl Socket, door: Door) -> Self {
        Self { backend: socket.backend(), events: Box::pin(socket.monitor()), accepted: Vec::new(), door }
    }

    /// Takes note of who has connected since.
    pub(super) fn note(&mut self, cx: &mut Context<'_>) {
        while let Poll::Ready(Some(event)) = self.events.as_mut().poll_next(cx) {
            self.door.heard(&event);
            if let SocketEvent::Accepted(_, peer) = event {
                self.accepted.push(peer);
            }
        }
        self.door.keep(cx);
    }

    /// How many have introduced themselves since all connections were closed, whether they are still there or not.
    pub(super) fn connected(&self) -> usize {
        self.accepted.len()
    }

    /// Closes all connections.
    pub(super) fn close(&mut self) {
        for peer in self.accepted.drain(..) {
            self.backend.peer_disconnected(&peer);
        }
    }
}

impl Drop for Peers {
    fn drop(&mut self) {
        self.note(&mut Context::from_waker(Waker::noop()));
        self.close();
    }
}
