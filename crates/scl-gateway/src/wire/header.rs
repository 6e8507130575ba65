//! The headers that are sent with the bytes of a message, and the acknowledgements that come back.

use std::time::{Duration, Instant};

use bytes::Buf;

/// Flag in the first byte: an age follows.
const LATCHED: u8 = 0x80;

/// Attachment of everything that goes from a sending end to a receiving end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) kind: Kind,
    /// Random number of the sending end. Each stream numbers its messages from 1.
    pub(super) stream: u64,
    /// Random number of the receiving end that this is addressed to.
    pub(super) epoch: u64,
    /// How often the sending end has started over. Lets it distinguish new losses from old ones.
    pub(super) attempt: u32,
    /// Number of the message; for [`Kind::Probe`] of the last message sent before.
    pub(super) sequence: u64,
    /// When the message was sent, if that was before its receiver had joined. It is transmitted as an age, because
    /// hosts have different clocks; the age does not include the time on the network.
    pub(super) latched: Option<Instant>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A whole message.
    Whole,
    /// A part of a message of `total` bytes.
    Chunk { offset: u64, total: u64 },
    /// Asks for an acknowledgement of what has arrived; with `flush`, the receiving component is also asked to
    /// acknowledge its messages.
    Probe { flush: bool },
}

impl Header {
    pub(super) fn encode(&self) -> Vec<u8> {
        let (kind, extra) = match self.kind {
            Kind::Whole => (0, None),
            Kind::Chunk { offset, total } => (1, Some((offset, total))),
            Kind::Probe { flush: false } => (2, None),
            Kind::Probe { flush: true } => (3, None),
        };
        let mut bytes = Vec::with_capacity(53);
        bytes.push(if self.latched.is_some() { kind | LATCHED } else { kind });
        bytes.extend(self.stream.to_be_bytes());
        bytes.extend(self.epoch.to_be_bytes());
        bytes.extend(self.attempt.to_be_bytes());
        bytes.extend(self.sequence.to_be_bytes());
        if let Some((offset, total)) = extra {
            bytes.extend(offset.to_be_bytes());
            bytes.extend(total.to_be_bytes());
        }
        if let Some(sent) = self.latched {
            let age = u64::try_from(sent.elapsed().as_nanos()).unwrap_or(u64::MAX);
            bytes.extend(age.to_be_bytes());
        }
        bytes
    }

    pub(super) fn decode(bytes: &[u8]) -> Option<Header> {
        let (kind, mut rest) = bytes.split_first()?;
        let (kind, has_age) = (kind & !LATCHED, kind & LATCHED != 0);
        let (stream, epoch) = (rest.try_get_u64().ok()?, rest.try_get_u64().ok()?);
        let (attempt, sequence) = (rest.try_get_u32().ok()?, rest.try_get_u64().ok()?);
        let kind = match kind {
            0 => Kind::Whole,
            1 => Kind::Chunk { offset: rest.try_get_u64().ok()?, total: rest.try_get_u64().ok()? },
            2 => Kind::Probe { flush: false },
            3 => Kind::Probe { flush: true },
            _ => return None,
        };
        let age = if has_age { Some(Duration::from_nanos(rest.try_get_u64().ok()?)) } else { None };
        let latched = age.and_then(|age| Instant::now().checked_sub(age));
        let is_sound = rest.is_empty() && sequence > 0 || matches!(kind, Kind::Probe { .. });
        is_sound.then_some(Header { kind, stream, epoch, attempt, sequence, latched })
    }
}

/// An acknowledgement of a stream by its receiving end. The counts are cumulative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Ack {
    pub(super) stream: u64,
    pub(super) epoch: u64,
    /// The attempt of the newest header.
    pub(super) attempt: u32,
    /// Messages that the gateway has received.
    pub(super) received: u64,
    /// Messages that the component has taken.
    pub(super) taken: u64,
    /// Number of the last message sent before the header that this acknowledgement answers: messages after `received`
    /// up to this one are lost.
    pub(super) seen: u64,
}

impl Ack {
    pub(super) fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(44);
        bytes.extend(self.attempt.to_be_bytes());
        for number in [self.stream, self.epoch, self.received, self.taken, self.seen] {
            bytes.extend(number.to_be_bytes());
        }
        bytes
    }

    pub(super) fn decode(mut rest: &[u8]) -> Option<Ack> {
        let attempt = rest.try_get_u32().ok()?;
        let mut next = || rest.try_get_u64().ok();
        let (stream, epoch, received, taken, seen) = (next()?, next()?, next()?, next()?, next()?);
        (rest.is_empty() && taken <= received).then_some(Ack { stream, epoch, attempt, received, taken, seen })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_survive_and_anything_else_is_refused() {
        let kinds = [
            Kind::Whole,
            Kind::Chunk { offset: 5, total: 1 << 40 },
            Kind::Probe { flush: false },
            Kind::Probe { flush: true },
        ];
        for kind in kinds {
            let header = Header { kind, stream: 1, epoch: u64::MAX, attempt: 3, sequence: 4, latched: None };
            let bytes = header.encode();
            assert_eq!(Header::decode(&bytes), Some(header));
            for end in 0..bytes.len() {
                assert_eq!(Header::decode(&bytes[..end]), None);
            }
        }
        let number_zero = Header { kind: Kind::Whole, stream: 1, epoch: 2, attempt: 3, sequence: 0, latched: None };
        assert_eq!(Header::decode(&number_zero.encode()), None);
        assert_eq!(Header::decode(&[9; 29]), None);
    }

    #[test]
    fn an_age_survives_whatever_the_clock_of_the_other_host() {
        for kind in [Kind::Whole, Kind::Chunk { offset: 5, total: 9 }] {
            let sent = Instant::now() - Duration::from_secs(7);
            let header = Header { kind, stream: 1, epoch: 2, attempt: 3, sequence: 4, latched: Some(sent) };
            let bytes = header.encode();
            let decoded = Header::decode(&bytes).expect("a header");
            let later = decoded.latched.expect("an age").duration_since(sent);
            assert!(later <= sent.elapsed() - Duration::from_secs(7), "{later:?}");
            assert_eq!(Header { latched: None, ..decoded }, Header { latched: None, ..header });
            for end in 0..bytes.len() {
                assert_eq!(Header::decode(&bytes[..end]), None);
            }
            // The oldest age that can be told.
            let oldest = [&bytes[..bytes.len() - 8], &[0xff; 8]].concat();
            assert!(Header::decode(&oldest).is_some());
        }
    }

    #[test]
    fn acknowledgements_survive_and_impossible_ones_are_refused() {
        let ack = Ack { stream: 1, epoch: 2, attempt: 3, received: 5, taken: 4, seen: 6 };
        let bytes = ack.encode();
        assert_eq!(Ack::decode(&bytes), Some(ack));
        assert_eq!(Ack::decode(&bytes[..43]), None);
        assert_eq!(Ack::decode(&Ack { taken: 6, ..ack }.encode()), None);
    }
}
