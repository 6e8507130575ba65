//! What a peer can do wrong.

use super::SocketType;

/// A violation of the protocol. The connection is of no further use.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(in crate::transport::zeromq) enum ProtocolError {
    #[error("the peer does not speak ZMTP 2 or later")]
    NotZmtp,
    #[error("the peer speaks a ZMTP older than 3.0")]
    Version,
    #[error("the peer requires a security mechanism; only NULL is supported")]
    Mechanism,
    #[error("the peer did not send READY after its greeting")]
    NotReady,
    #[error("the peer's READY is malformed")]
    MalformedReady,
    #[error("the peer is a {peer} socket, which cannot talk to {own}", own = own.word())]
    SocketType { own: SocketType, peer: String },
    #[error("another end listens at its address, which a program that was killed has left behind")]
    OtherConnection,
    #[error("the peer refused the connection: {0}")]
    Refused(String),
    #[error("the peer sent a frame with reserved flags: {0:#04x}")]
    Flags(u8),
    #[error("the peer announced {announced} bytes; the limit is {limit}")]
    TooLong { announced: u64, limit: u64 },
    #[error("the peer sent a message of more than {limit} frames")]
    TooManyFrames { limit: usize },
    #[error("the peer sent a malformed command")]
    MalformedCommand,
    #[error("the peer acknowledged {acknowledged} messages of {sent} sent")]
    Acknowledgement { acknowledged: u64, sent: u64 },
    #[error("the peer subscribed to too many topics")]
    TooManyTopics,
    #[error("{0}")]
    Sample(String),
    #[error("the peer does not read the answers to its heartbeats")]
    NotReading,
}
