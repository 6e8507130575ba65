//! The publishing end of one connection: an XPUB socket of its own.
//!
//! A message is written from the caller. The library's `send` cannot be abandoned half way, so the future of a write owns
//! the socket until its message is with the operating system; whoever comes first, the caller with the next message or
//! the connection's task, takes the socket back. Both poll it with the task's waker.

use super::Medium;
use super::accepted::Accepted;
use super::frames::poll_message;
use super::listen::{Listening, listen};
use super::peers::Peers;
use crate::place::{Claim, SystemDir};
use crate::transport::{Outlet, TransportError};
use bytes::Bytes;
use std::task::{Context, Poll};
use tokio_util::sync::ReusableBoxFuture;
use zeromq::{SocketSend, XPubSocket, ZmqMessage};

/// After how many messages without a pause it is looked whether the subscriber is still there: fewer than are sent in a
/// millisecond. In a pause the task hears of it by itself.
const LOOK: u32 = 64;

pub(super) struct Publishing {
    peers: Peers,
    accepted: Accepted,
    subscriber: bool,
    /// How many messages were sent since it was looked.
    unlooked: u32,
    /// `None` while a message is being written; in a box, because it is moved with each message.
    socket: Option<Box<XPubSocket>>,
    writing: ReusableBoxFuture<'static, Box<XPubSocket>>,
    _guard: Claim,
}

impl Publishing {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let Listening { socket, events, door, guard } = listen::<XPubSocket>(place, medium, endpoint)?;
        Ok(Self {
            accepted: Accepted::at(door.address()),
            peers: Peers::of(&socket, events, door),
            subscriber: false,
            unlooked: 0,
            socket: Some(Box::new(socket)),
            writing: ReusableBoxFuture::new(std::future::pending()),
            _guard: guard,
        })
    }

    /// Whether nothing is being written any more.
    fn is_written(&mut self, cx: &mut Context<'_>) -> bool {
        if self.socket.is_none()
            && let Poll::Ready(socket) = self.writing.poll(cx)
        {
            self.socket = Some(socket);
        }
        self.socket.is_some()
    }

    /// Takes note of who came and who left; a socket that writes is deaf.
    fn listen(&mut self, cx: &mut Context<'_>) {
        let Some(socket) = &mut self.socket else { return };
        while let Poll::Ready(heard) = poll_message(&mut **socket, cx) {
            if heard.is_ok_and(|message| is_subscription(&message)) {
                self.accepted.subscribed();
                self.subscriber = self.accepted.is_anybody();
            }
        }
        self.unlooked = 0;
        self.peers.note(cx);
        if self.subscriber && !self.accepted.any_left(self.peers.connected()) {
            self.subscriber = false;
            self.accepted.forget();
            self.peers.close();
        }
    }
}

impl Outlet for Publishing {
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        if self.is_written(cx) {
            self.listen(cx);
        }
        self.subscriber
    }

    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes> {
        if self.socket.is_none() && self.is_written(cx) {
            // Nobody has listened since the write began: the task does.
            cx.waker().wake_by_ref();
        }
        let Some(socket) = self.socket.take_if(|_| self.subscriber) else { return Err(message) };
        // The task budget would refuse the write of a caller that has sent much, and nobody would come back to it.
        self.writing.set(tokio::task::unconstrained(write(socket, message)));
        self.unlooked += 1;
        if self.is_written(cx) && self.unlooked >= LOOK {
            // A write that meets a broken connection succeeds like any other, and takes away what would have told of
            // the break; the task finds out.
            cx.waker().wake_by_ref();
        }
        Ok(())
    }

    fn is_flushed(&self) -> bool {
        self.socket.is_some()
    }
}

async fn write(mut socket: Box<XPubSocket>, message: Bytes) -> Box<XPubSocket> {
    if let Err(error) = socket.send(message.into()).await {
        tracing::debug!(%error, "a message could not be written");
    }
    socket
}

fn is_subscription(message: &ZmqMessage) -> bool {
    message.get(0).and_then(|frame| frame.first()) == Some(&1)
}
