//! A request or a reply as a message of a stream.

use bytes::{BufMut, Bytes, BytesMut};

/// What is before the body.
pub(super) const LENGTH: usize = 9;

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Envelope {
    /// Instead of a reply: there will be none.
    pub(super) is_gone: bool,
    pub(super) id: u64,
    pub(super) body: Bytes,
}

impl Envelope {
    pub(super) fn encode(&self) -> Bytes {
        let mut message = BytesMut::with_capacity(LENGTH + self.body.len());
        message.put_u8(self.is_gone.into());
        message.put_u64(self.id);
        message.extend_from_slice(&self.body);
        message.freeze()
    }

    pub(super) fn decode(message: &Bytes) -> Option<Envelope> {
        let (is_gone, rest) = message.split_first().filter(|(is_gone, _)| **is_gone < 2)?;
        let id = u64::from_be_bytes(*rest.first_chunk()?);
        Some(Envelope { is_gone: *is_gone == 1, id, body: message.slice(LENGTH..) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survives_and_refuses_what_is_too_short() {
        let envelope = Envelope { is_gone: false, id: 7, body: Bytes::from_static(b"body") };
        let message = envelope.encode();
        assert_eq!(Envelope::decode(&message), Some(envelope));
        assert_eq!(Envelope::decode(&message.slice(..LENGTH - 1)), None);
        assert_eq!(Envelope::decode(&Bytes::from_static(&[2; 9])), None);
    }
}
