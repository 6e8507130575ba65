//! Messages that start with the time at which they are sent.

use crate::clock::now;
use crate::unix::PREFIX;
use scl::bytes::{Buf, BufMut, Bytes, BytesMut};

/// The size of the time, and so of the shortest message.
pub(crate) const MIN_SIZE: usize = 8;

/// A message in both forms that variants send, so that no variant has to copy it first.
pub(super) struct Message {
    pub(super) payload: Bytes,
    /// The payload after its length.
    pub(super) frame: Bytes,
}

impl Message {
    /// A message that is sent now.
    pub(super) fn new(size: usize) -> Self {
        let size = size.max(MIN_SIZE);
        let mut frame = BytesMut::with_capacity(PREFIX + size);
        frame.put_uint(size as u64, PREFIX);
        frame.put_u64(now());
        frame.resize(PREFIX + size, 0);
        let frame = frame.freeze();
        Self { payload: frame.slice(PREFIX..), frame }
    }

    /// The time at which it is sent.
    pub(super) fn time(&self) -> scl::Result<u64> {
        sent_time(&self.payload)
    }
}

/// The time at which a message was sent.
pub(super) fn sent_time(mut message: &[u8]) -> scl::Result<u64> {
    Ok(message.try_get_u64()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_have_the_size_and_the_time() {
        let before = now();
        let Message { payload, frame } = Message::new(20);
        assert_eq!(payload.len(), 20);
        assert_eq!(frame, [&[0, 0, 0, 20], &payload[..]].concat());
        assert!((before..=now()).contains(&sent_time(&payload).unwrap()));
        assert!(sent_time(b"short").is_err());
    }
}
