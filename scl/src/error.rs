//! Errors, one type per operation. Every text names the component, the gate and the peer, and says what to do.

mod any;
mod names;
mod not_flushed;
mod not_ready;
mod open;
mod set;

pub use any::{Error, Result};
pub(crate) use names::Missing;
pub use names::{GateName, PeerName, Peers};
pub use not_flushed::{NotFlushed, Unflushed};
pub use not_ready::{MissingPeer, NotReady};
use open::suggestion;
pub use open::{MissingGuarantee, OpenError};
pub use set::SetError;

use crate::codec::{DecodeError, EncodeError};
use crate::time::Rounded;
use std::fmt;
use std::time::Duration;
use thiserror::Error;

/// A call could not be made, or had to stop waiting.
#[derive(Debug, Error, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlockingError {
    /// A blocking call inside async code, which would block every task on its thread.
    #[error("a blocking call inside async code would block its thread; use the async call with `.await`")]
    InsideAsync,
    /// The program was asked to stop, by SIGTERM or SIGINT.
    #[error("stop requested")]
    Stopped,
    /// The calling process is a forked child of the one that opened the component.
    #[error("the component was opened before a `fork` and belongs to the parent process; open it in one process only")]
    Forked,
    /// The component's calls were ended, see [`Closer`](crate::untyped::Closer).
    #[error("the component was closed")]
    Closed,
    /// The async runtime on which the component was opened has ended.
    #[error("the async runtime on which the component was opened has ended; keep it running while the gates are used")]
    RuntimeEnded,
    /// The calling thread is ending and its thread-local values are gone, so it cannot wait. Closing a component works
    /// there.
    #[error(
        "the calling thread is ending and cannot wait for gates any more; make the call earlier or on another thread"
    )]
    ThreadEnding,
}

/// A message was not sent.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SendError {
    /// The codec cannot express the message.
    #[error("gate `{gate}` cannot encode this message")]
    Encode {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: EncodeError,
    },
    /// The message is longer than a peer accepts. It was sent to no peer.
    #[error(
        "gate `{gate}` cannot send a message of {size} bytes: {peer} accepts at most {limit}; raise its `max_size`"
    )]
    TooLong {
        /// The gate.
        gate: GateName,
        /// The peer that accepts the shortest messages.
        peer: PeerName,
        /// Length of the encoded message, in bytes.
        size: u64,
        /// The peer's `max_size`, in bytes.
        limit: u64,
    },
    /// The call could not be made, or had to stop waiting.
    #[error("gate `{gate}` did not send the message")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: BlockingError,
    },
}

/// No memory was lent for a message.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoanError {
    /// The gate's codec encodes messages into bytes other than those in memory.
    #[error(
        "gate `{gate}` lends no memory for its messages: its codec is `{codec}`; only messages with `codec: raw` are written \
         in place, use `send` for others"
    )]
    Codec {
        /// The gate.
        gate: GateName,
        /// Its codec, as in the topology file.
        codec: &'static str,
    },
    /// The message would be longer than a peer accepts.
    #[error(
        "gate `{gate}` cannot send a message of {size} bytes: {peer} accepts at most {limit}; raise its `max_size`"
    )]
    TooLong {
        /// The gate.
        gate: GateName,
        /// The peer that accepts the shortest messages.
        peer: PeerName,
        /// Length of the message, in bytes.
        size: u64,
        /// The peer's `max_size`, in bytes.
        limit: u64,
    },
    /// The gate cannot be used any more.
    #[error("gate `{gate}` lends no memory")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: BlockingError,
    },
}

/// A message was not sent by a call that never waits.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TrySendError {
    /// A peer with `when_full: wait` would make this gate wait.
    #[error("gate `{gate}` would have to wait: the queue of {peer} is full; send later, or use `send`")]
    Full {
        /// The gate.
        gate: GateName,
        /// The peer whose queue is full.
        peer: PeerName,
    },
    /// An error of `send`.
    #[error(transparent)]
    Send(#[from] SendError),
}

/// A message was not sent in time.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SendTimeoutError {
    /// A peer with `when_full: wait` made this gate wait for too long. The message was sent to no peer.
    #[error("gate `{gate}` did not send the message within {}: the queue of {peer} is full", Rounded(*waited))]
    Timeout {
        /// The gate.
        gate: GateName,
        /// The peer whose queue is full.
        peer: PeerName,
        /// How long it waited.
        waited: Duration,
    },
    /// An error of `send`.
    #[error(transparent)]
    Send(#[from] SendError),
}

/// A message was not received.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecvError {
    /// The codec cannot read a message, and the gate declares `undecodable: fail`. The next call returns the next
    /// message.
    #[error("gate `{gate}` received an undecodable message from {peers}")]
    Decode {
        /// The gate.
        gate: GateName,
        /// The sender; for a gate with several peers, the possible senders.
        peers: Peers,
        /// Why it cannot be read; it names the codec.
        source: DecodeError,
    },
    /// The gate's codec encodes messages into bytes other than those in memory. No message was taken.
    #[error(
        "gate `{gate}` has no views of its messages: its codec is `{codec}`; only messages with `codec: raw` are read in place, \
         use `recv` for others"
    )]
    NoViews {
        /// The gate.
        gate: GateName,
        /// Its codec, as in the topology file.
        codec: &'static str,
    },
    /// The gate has no `deadline`, so no message of its peers is ever missed.
    #[error("gate `{gate}` has no `deadline`; declare one in the topology to be told of messages that do not come")]
    NoDeadline {
        /// The gate.
        gate: GateName,
    },
    /// The operating system refused a timer, so the call cannot know when a message is missing.
    #[error("gate `{gate}` cannot wait for its `deadline`: the operating system refused a timer")]
    Timer {
        /// The gate.
        gate: GateName,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The call could not be made, or had to stop waiting.
    #[error("gate `{gate}` did not receive")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: BlockingError,
    },
}

/// A message was not received in time.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecvTimeoutError {
    /// No message arrived.
    #[error("gate `{gate}` received nothing from {peers} within {}{}", Rounded(*waited), because(reason))]
    Timeout {
        /// The gate.
        gate: GateName,
        /// Its peers.
        peers: Peers,
        /// How long it waited.
        waited: Duration,
        /// Why peers are not connected, if any is missing.
        reason: Option<String>,
    },
    /// An error that any receiving call may return.
    #[error(transparent)]
    Recv(#[from] RecvError),
}

/// A request got no reply.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CallError {
    /// The codec cannot express the request.
    #[error("gate `{gate}` cannot encode this request")]
    Encode {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: EncodeError,
    },
    /// The request is longer than the replier accepts. It was not sent.
    #[error(
        "gate `{gate}` cannot send a request of {size} bytes: {peer} accepts at most {limit}; raise its `max_size`"
    )]
    TooLong {
        /// The gate.
        gate: GateName,
        /// The replier.
        peer: PeerName,
        /// Length of the encoded request, in bytes.
        size: u64,
        /// The replier's `max_size`, in bytes.
        limit: u64,
    },
    /// No reply arrived in time. A late one is discarded.
    #[error("gate `{gate}` got no reply from {peers} within {}{}", Rounded(*waited), because(reason))]
    Timeout {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
        /// How long it waited.
        waited: Duration,
        /// Whether the replier was connected at the end.
        connected: bool,
        /// Why the replier is not connected, if it is missing.
        reason: Option<String>,
    },
    /// The replier disconnected after the request was sent; whether it acted on the request is unknown.
    #[error("gate `{gate}` got no reply: {peers} disconnected after the request was sent; the next call reconnects")]
    PeerLost {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
    },
    /// The replier has refused the request, for example because it could not decode it, and did not act on it.
    #[error("gate `{gate}` got no reply: {peers} could not decode the request")]
    Refused {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
    },
    /// The codec cannot read the reply.
    #[error("gate `{gate}` received an undecodable reply from {peers}")]
    Decode {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
        /// Why it cannot be read; it names the codec.
        source: DecodeError,
    },
    /// The call could not be made, or had to stop waiting.
    #[error("gate `{gate}` did not send the request")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: BlockingError,
    },
}

/// A reply was not sent.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplyError {
    /// The codec cannot express the reply.
    #[error("gate `{gate}` cannot encode this reply")]
    Encode {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: EncodeError,
    },
    /// The reply is longer than a requester accepts.
    #[error("gate `{gate}` cannot send a reply of {size} bytes: {peer} accepts at most {limit}; raise its `max_size`")]
    TooLong {
        /// The gate.
        gate: GateName,
        /// The requester that accepts the shortest replies.
        peer: PeerName,
        /// Length of the encoded reply, in bytes.
        size: u64,
        /// The requester's `max_size`, in bytes.
        limit: u64,
    },
    /// The requester has disconnected.
    #[error("gate `{gate}` cannot reply: the requester has disconnected")]
    RequesterGone {
        /// The gate.
        gate: GateName,
    },
    /// The call could not be made.
    #[error("gate `{gate}` did not reply")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: BlockingError,
    },
}

/// Formats the reason as the end of a sentence; returns an empty text if there is none.
fn because(reason: &Option<String>) -> String {
    reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"))
}

fn listed(items: &[impl fmt::Display]) -> String {
    items.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
