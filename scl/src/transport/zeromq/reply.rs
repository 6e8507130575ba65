//! The replying end: a ROUTER, so that each request can be answered when its answer is ready, in any order.
//!
//! The library keeps the socket, listener and all, until both its halves are gone. A request holds only a weak
//! reference to the sending half, so that one that is never answered does not keep requesters waiting at an end that
//! nobody reads.

use super::Medium;
use super::frames::Messages;
use super::latecomers::ClosesLatecomers;
use super::listen::{Listening, listen};
use crate::place::{Claim, SystemDir};
use crate::sync::AbortOnDrop;
use crate::transport::{Answerer, Asked, RequesterGone, Responder, TransportError};
use bytes::Bytes;
use std::collections::VecDeque;
use std::sync::{Arc, Weak};
use std::task::{Context, Poll, Waker};
use zeromq::{RouterRecvHalf, RouterSendHalf, RouterSocket, SocketSend, ZmqMessage};

pub(super) struct Replying {
    requests: Messages<RouterRecvHalf>,
    replies: Arc<RouterSendHalf>,
    malformed: u64,
    _connections: ClosesLatecomers,
    _door: AbortOnDrop,
    _guard: Claim,
}

impl Replying {
    pub(super) fn open(place: &SystemDir, medium: Medium, endpoint: &str) -> Result<Self, TransportError> {
        let Listening { socket, events, door, guard } = listen::<RouterSocket>(place, medium, endpoint)?;
        let connections = ClosesLatecomers::of(&socket);
        let door = door.watch(events);
        let (replies, requests) = socket.split();
        let replies = Arc::new(replies);
        let requests = Messages::of(requests);
        Ok(Self { requests, replies, malformed: 0, _connections: connections, _door: door, _guard: guard })
    }
}

impl Answerer for Replying {
    fn poll_asked(&mut self, cx: &mut Context<'_>) -> Poll<Asked> {
        loop {
            match self.requests.poll(cx) {
                Poll::Ready(Ok(message)) => match split_envelope(message) {
                    Some((envelope, body)) => {
                        let responder = Box::new(Envelope { frames: envelope, replies: Arc::downgrade(&self.replies) });
                        return Poll::Ready(Asked { body, responder });
                    }
                    None => self.malformed += 1,
                },
                Poll::Ready(Err(error)) => tracing::debug!(%error, "a requester was dropped"),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }
}

/// Splits `[identity, .., empty, body]` behind the empty frame.
fn split_envelope(message: ZmqMessage) -> Option<(VecDeque<Bytes>, Bytes)> {
    let mut frames = message.into_vecdeque();
    let delimiter = frames.iter().skip(1).position(Bytes::is_empty)? + 1;
    if frames.len() != delimiter + 2 {
        return None;
    }
    let body = frames.pop_back()?;
    Some((frames, body))
}

/// The frames that lead back to one requester.
struct Envelope {
    frames: VecDeque<Bytes>,
    replies: Weak<RouterSendHalf>,
}

impl Responder for Envelope {
    fn respond(mut self: Box<Self>, body: Bytes) -> Result<(), RequesterGone> {
        let mut replies = RouterSendHalf::clone(&*self.replies.upgrade().ok_or(RequesterGone)?);
        self.frames.push_back(body);
        let message = ZmqMessage::try_from(self.frames).map_err(|_empty| RequesterGone)?;
        // The library only queues here; its writer runs as a task of its own.
        match replies.send(message).as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(Ok(())) => Ok(()),
            Poll::Ready(Err(_)) | Poll::Pending => Err(RequesterGone),
        }
    }
}
