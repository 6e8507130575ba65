//! Messages, in the forms in which each transport and library has them.

use crate::clock::now;
use crate::unix::PREFIX;
use scl::bytes::{Buf, BufMut, Bytes, BytesMut};
use std::borrow::Cow;
use zeromq::ZmqMessage;

/// The size of the time, and so of the shortest message that has one.
pub(crate) const MIN_SIZE: usize = 8;

/// A message in both forms that variants send, so that no variant has to copy it first.
pub(crate) struct Message {
    pub(crate) payload: Bytes,
    /// The payload after its length.
    pub(crate) frame: Bytes,
    /// When it was sent, in nanoseconds; the first bytes of the payload.
    pub(crate) time: Option<u64>,
}

/// A message in the form in which an end receives it.
pub(crate) enum Frame<'a> {
    Bytes(Bytes),
    /// A payload after its length, as Unix sockets carry it.
    Unix(&'a [u8]),
    Zeromq(ZmqMessage),
    #[cfg(feature = "libzmq")]
    Libzmq(zmq2::Message),
    #[cfg(feature = "shm")]
    Iceoryx(crate::iceoryx::Received),
    #[cfg(feature = "gateway")]
    Zenoh(zenoh::sample::Sample),
}

impl Message {
    /// A message without a time.
    pub(crate) fn new(size: usize) -> Self {
        Self::with_time(size, None)
    }

    /// A message that is sent now.
    pub(crate) fn sent_now(size: usize) -> Self {
        Self::with_time(size.max(MIN_SIZE), Some(now()))
    }

    fn with_time(size: usize, time: Option<u64>) -> Self {
        let mut frame = BytesMut::with_capacity(PREFIX + size);
        frame.put_uint(size as u64, PREFIX);
        if let Some(time) = time {
            frame.put_u64(time);
        }
        frame.resize(PREFIX + size, 0);
        let frame = frame.freeze();
        Self { payload: frame.slice(PREFIX..), frame, time }
    }
}

impl From<Bytes> for Message {
    /// Not for Unix sockets, which need the length before the payload.
    fn from(payload: Bytes) -> Self {
        Self { payload, frame: Bytes::new(), time: None }
    }
}

impl Frame<'_> {
    /// The payload. Of iceoryx2 it is empty, because only the header is written.
    pub(crate) fn payload(&self) -> Cow<'_, [u8]> {
        match self {
            Self::Bytes(bytes) => Cow::Borrowed(bytes),
            Self::Unix(frame) => Cow::Borrowed(&frame[PREFIX..]),
            Self::Zeromq(message) => Cow::Borrowed(message.get(0).map_or(&[][..], |frame| frame)),
            #[cfg(feature = "libzmq")]
            Self::Libzmq(message) => Cow::Borrowed(message),
            #[cfg(feature = "shm")]
            Self::Iceoryx(_) => Cow::Borrowed(&[]),
            #[cfg(feature = "gateway")]
            Self::Zenoh(sample) => sample.payload().to_bytes(),
        }
    }

    /// The time at which it was sent.
    pub(crate) fn sent_time(&self) -> scl::Result<u64> {
        match self {
            #[cfg(feature = "shm")]
            Self::Iceoryx(sample) => Ok(*sample.user_header()),
            other => Ok((&*other.payload()).try_get_u64()?),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_have_the_size_and_the_time() {
        let before = now();
        let message = Message::sent_now(20);
        assert_eq!(message.payload.len(), 20);
        assert_eq!(message.frame, [&[0, 0, 0, 20], &message.payload[..]].concat());
        let time = Frame::Bytes(message.payload.clone()).sent_time().unwrap();
        assert_eq!(message.time, Some(time));
        assert!((before..=now()).contains(&time));
        assert!(Frame::Bytes(Bytes::from_static(b"short")).sent_time().is_err());
    }
}
