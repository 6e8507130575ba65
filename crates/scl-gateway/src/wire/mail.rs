//! What the callbacks of the network library tell the ends of a stream.

use bytes::Bytes;

use super::header::{Ack, Header};

/// What callbacks tell a sending end.
#[derive(Debug)]
pub(super) enum SendingMail {
    /// The receiving end that is open now.
    Peer(Option<u64>),
    Ack(Ack),
}

/// What callbacks tell a receiving end.
#[derive(Debug)]
pub(super) enum ReceivingMail {
    /// The sending end that is open now.
    Peer(Option<u64>),
    Arrived(Header, Bytes),
}
