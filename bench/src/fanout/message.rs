//! The messages that are published, and how often.

use crate::clock::now;
use scl::bytes::{Buf, BufMut, Bytes, BytesMut};
use std::time::Duration;

/// The size of a message; its last four bytes are unused.
pub(super) const BYTES: usize = 20;

pub(super) const PERIOD: Duration = Duration::from_millis(1);

/// Number of messages before a subscriber is stopped or resumed. Enough to fill the socket of a stopped subscriber,
/// which holds about 278 messages.
pub(super) const BATCH: u32 = 1000;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Message {
    /// When it was sent, in nanoseconds.
    pub(super) sent: u64,
    pub(super) batch: u32,
    /// How many messages of the batch are still to come.
    pub(super) remaining: u32,
}

impl Message {
    /// A message that is sent now.
    pub(super) fn new(batch: u32, remaining: u32) -> Self {
        Self { sent: now(), batch, remaining }
    }

    pub(super) fn encode(self) -> Bytes {
        let mut bytes = BytesMut::with_capacity(BYTES);
        bytes.put_u64(self.sent);
        bytes.put_u32(self.batch);
        bytes.put_u32(self.remaining);
        bytes.resize(BYTES, 0);
        bytes.freeze()
    }

    pub(super) fn decode(mut bytes: &[u8]) -> scl::Result<Self> {
        Ok(Self { sent: bytes.try_get_u64()?, batch: bytes.try_get_u32()?, remaining: bytes.try_get_u32()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_decoded_as_encoded() {
        let message = Message::new(7, 3);
        assert_eq!(message.encode().len(), BYTES);
        assert_eq!(Message::decode(&message.encode()).unwrap(), message);
        assert!(Message::decode(b"too short").is_err());
    }
}
