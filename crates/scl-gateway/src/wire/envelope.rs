//! A request or a reply as a message of a stream.

use bytes::{BufMut, Bytes, BytesMut};

/// Length of what precedes the body.
pub(super) const LENGTH: usize = 9;

/// What an envelope contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// A request, or the reply to one.
    Message,
    /// No reply will follow.
    Gone,
    /// No reply will follow, because the replier has refused the request.
    Refused,
}

impl Outcome {
    const ALL: [Self; 3] = [Self::Message, Self::Gone, Self::Refused];
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Envelope {
    pub(super) outcome: Outcome,
    pub(super) id: u64,
    pub(super) body: Bytes,
}

impl Envelope {
    pub(super) fn encode(&self) -> Bytes {
        let mut message = BytesMut::with_capacity(LENGTH + self.body.len());
        message.put_u8(self.outcome as u8);
        message.put_u64(self.id);
        message.extend_from_slice(&self.body);
        message.freeze()
    }

    pub(super) fn decode(message: &Bytes) -> Option<Envelope> {
        let (outcome, rest) = message.split_first()?;
        let outcome = *Outcome::ALL.get(usize::from(*outcome))?;
        let id = u64::from_be_bytes(*rest.first_chunk()?);
        Some(Envelope { outcome, id, body: message.slice(LENGTH..) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survives_and_refuses_what_is_too_short() {
        for outcome in Outcome::ALL {
            let envelope = Envelope { outcome, id: 7, body: Bytes::from_static(b"body") };
            let message = envelope.encode();
            assert_eq!(Envelope::decode(&message), Some(envelope));
            assert_eq!(Envelope::decode(&message.slice(..LENGTH - 1)), None);
        }
        assert_eq!(Envelope::decode(&Bytes::from_static(&[3; 9])), None);
    }
}
