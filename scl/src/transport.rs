//! How messages travel: roles over opaque frames, without a word about types or codecs.
//!
//! A transport makes the two ends of connections; the gates own queues, policies and codecs. Whoever implements
//! [`Transport`] gives an end for each role, in which every call returns at once and says through the task's waker
//! when it is worth calling again.

use bytes::Bytes;
use std::collections::VecDeque;
use std::task::{Context, Poll};

#[cfg(feature = "memory")]
pub mod memory;
#[cfg(feature = "zeromq")]
pub mod zeromq;

/// Makes the ends of connections. Endpoints are names inside the system's folder, for example
/// `sensor.measurements--controller.sensor.k3v9qd2m`.
///
/// Its methods are called inside a tokio runtime.
pub trait Transport: Send + Sync + 'static {
    /// The publishing end of one connection; it is the end that listens.
    fn publish(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError>;
    /// The subscribing end of one connection.
    fn subscribe(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError>;
    /// A pushing end.
    fn push(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError>;
    /// The pulling end, which listens for any number of pushers.
    fn pull(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError>;
    /// A requesting end.
    fn request(&self, endpoint: &str) -> Result<Box<dyn Asker>, TransportError>;
    /// The replying end, which listens for any number of requesters.
    fn reply(&self, endpoint: &str) -> Result<Box<dyn Answerer>, TransportError>;
}

/// An end that sends: of `pub` one a connection, of `push` one a puller.
pub trait Outlet: Send {
    /// Moves on what happens without being asked (accepting, reconnecting, writing what was taken before) and says
    /// whether a peer is there that takes messages. Wakes the task when there is more to do, and when a message that
    /// was refused may be offered again.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Takes the message for the peer, or gives it back: no peer is there, or it cannot take one now.
    ///
    /// # Errors
    /// The message itself.
    fn offer(&mut self, cx: &mut Context<'_>, message: Bytes) -> Result<(), Bytes>;

    /// Takes messages from the front of a queue, as many as the peer can take now; `taken` is told the length of each.
    ///
    /// An end that can hand over several messages for the price of one does that here.
    fn offer_all(&mut self, cx: &mut Context<'_>, queue: &mut VecDeque<Bytes>, taken: &mut dyn FnMut(usize)) {
        while let Some(message) = queue.pop_front() {
            let length = message.len();
            match self.offer(cx, message) {
                Ok(()) => taken(length),
                Err(message) => return queue.push_front(message),
            }
        }
    }

    /// Whether everything that was taken is with the operating system.
    fn is_flushed(&self) -> bool;
}

/// An end that receives: of `sub` one a publisher, of `pull` one a gate.
pub trait Inlet: Send {
    /// The next message. Reconnects by itself; what is no message of one frame is counted and passed over.
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes>;

    /// How many peers are connected, as far as this end can know: a listening end says `None`.
    fn peers(&self) -> Option<usize>;

    /// How many frames were passed over because they were no message of one frame.
    fn malformed(&self) -> u64 {
        0
    }
}

/// What comes back to an [`Asker`].
#[derive(Debug)]
pub enum Answer {
    /// A reply and the number of the request it belongs to; it may be an old one.
    Reply {
        /// The number given to [`Asker::ask`].
        id: u64,
        /// The reply.
        body: Bytes,
    },
    /// The peer went away; what was asked will not be answered.
    Lost,
}

/// An end that asks.
pub trait Asker: Send {
    /// Ready when the replier is there and can be asked. What came back before, to earlier requests, may be discarded.
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()>;

    /// Sends a request under a number; its reply carries the number back.
    ///
    /// # Errors
    /// The body, if the replier is not there.
    fn ask(&mut self, id: u64, body: Bytes) -> Result<(), Bytes>;

    /// Whether the replier is there, as far as is known without looking.
    fn is_connected(&self) -> bool;

    /// The next thing that comes back.
    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer>;
}

/// A request with the way back to whoever sent it.
pub struct Asked {
    /// The request.
    pub body: Bytes,
    /// Takes the reply.
    pub responder: Box<dyn Responder>,
}

/// The way back to one requester.
pub trait Responder: Send + Sync {
    /// Hands the reply to the transport.
    ///
    /// # Errors
    /// The requester is gone.
    fn respond(self: Box<Self>, body: Bytes) -> Result<(), RequesterGone>;
}

/// The requester went away before it was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RequesterGone;

/// An end that answers.
pub trait Answerer: Send {
    /// The next request. What is no request of one frame is counted and passed over.
    fn poll_asked(&mut self, cx: &mut Context<'_>) -> Poll<Asked>;

    /// How many messages were passed over because they were no request of one frame.
    fn malformed(&self) -> u64 {
        0
    }
}

/// An end could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// The place where the two ends meet could not be prepared.
    #[error(transparent)]
    Place(#[from] crate::place::PlaceError),
    /// The end must not be opened on a runtime of several threads.
    #[error(
        "`{endpoint}` cannot listen on an async runtime of several threads, which the `zeromq` library may bring to a halt; \
         write `#[scl::main]`, or `#[tokio::main(flavor = \"current_thread\")]`"
    )]
    SeveralThreads {
        /// The endpoint's name.
        endpoint: String,
    },
    /// The transport itself refused.
    #[error("the transport cannot open `{endpoint}`: {reason}")]
    Refused {
        /// The endpoint's name.
        endpoint: String,
        /// What it said.
        reason: String,
    },
}
