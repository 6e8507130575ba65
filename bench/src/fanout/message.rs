//! What is published: when it was sent, which batch it belongs to, and how many of that batch follow.

use crate::clock::now;
use scl::bytes::{Buf, BufMut, Bytes, BytesMut};

/// The length of a message; its last four bytes say nothing.
pub(super) const BYTES: usize = 20;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Message {
    /// In nanoseconds.
    pub(super) sent: u64,
    pub(super) batch: u32,
    pub(super) following: u32,
}

impl Message {
    /// One that is sent now.
    pub(super) fn new(batch: u32, following: u32) -> Self {
        Self { sent: now(), batch, following }
    }

    pub(super) fn encode(self) -> Bytes {
        let mut bytes = BytesMut::with_capacity(BYTES);
        bytes.put_u64(self.sent);
        bytes.put_u32(self.batch);
        bytes.put_u32(self.following);
        bytes.resize(BYTES, 0);
        bytes.freeze()
    }

    pub(super) fn decode(mut bytes: Bytes) -> scl::Result<Self> {
        Ok(Self { sent: bytes.try_get_u64()?, batch: bytes.try_get_u32()?, following: bytes.try_get_u32()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_read_back() {
        let message = Message::new(7, 3);
        assert_eq!(message.encode().len(), BYTES);
        assert_eq!(Message::decode(message.encode()).unwrap(), message);
        assert!(Message::decode(Bytes::from_static(b"too short")).is_err());
    }
}
