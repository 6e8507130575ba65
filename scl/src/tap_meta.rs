//! The second frame of a message at a tap: 32 bytes, little endian. Sequence, time of sending, call id (each u64), kind
//! (u8), latched (u8), and 6 zero bytes.

use rustix::time::{ClockId, clock_gettime};

/// Metadata of a message that passes a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TapMeta {
    pub(crate) sequence: u64,
    /// In nanoseconds since 1970.
    pub(crate) sent_ns: u64,
    /// 0 for messages.
    pub(crate) call_id: u64,
    pub(crate) kind: ObservedKind,
    /// Whether it was sent before its observer joined.
    pub(crate) latched: bool,
}

/// The kind of an observed message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "zeromq"), expect(unreachable_pub, reason = "only observers need it"))]
pub enum ObservedKind {
    /// A message at a `pub` or `pull` gate.
    Message = 0,
    /// A request at a `rep` gate.
    Request = 1,
    /// A reply at a `rep` gate.
    Reply = 2,
}

impl TapMeta {
    pub(crate) fn encode(self) -> [u8; 32] {
        let Self { sequence, sent_ns, call_id, kind, latched } = self;
        let mut bytes = [0; 32];
        for (place, value) in [sequence, sent_ns, call_id].into_iter().enumerate() {
            bytes[8 * place..8 * (place + 1)].copy_from_slice(&value.to_le_bytes());
        }
        (bytes[24], bytes[25]) = (kind as u8, latched.into());
        bytes
    }

    #[cfg(any(feature = "zeromq", test))]
    pub(crate) fn decode(bytes: &[u8; 32]) -> Option<Self> {
        let (&[sequence, sent_ns, call_id, last], []) = bytes.as_chunks::<8>() else { return None };
        let kinds = [ObservedKind::Message, ObservedKind::Request, ObservedKind::Reply];
        Some(Self {
            sequence: u64::from_le_bytes(sequence),
            sent_ns: u64::from_le_bytes(sent_ns),
            call_id: u64::from_le_bytes(call_id),
            kind: kinds.into_iter().find(|kind| *kind as u8 == last[0])?,
            latched: last[1] == 1,
        })
    }
}

/// Returns the time, in nanoseconds since 1970.
pub(crate) fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::Realtime);
    now.tv_sec.unsigned_abs() * 1_000_000_000 + now.tv_nsec.unsigned_abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_frame_is_laid_out_as_documented() {
        let meta =
            TapMeta { sequence: 1, sent_ns: 0x0203, call_id: 0x04 << 56, kind: ObservedKind::Reply, latched: true };
        let bytes = meta.encode();
        let expected = [[1, 0, 0, 0, 0, 0, 0, 0], [3, 2, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 4]].concat();
        assert_eq!(bytes[..24], expected);
        assert_eq!(bytes[24..], [2, 1, 0, 0, 0, 0, 0, 0]);
        assert_eq!(TapMeta::decode(&bytes), Some(meta));
        let mut unknown = bytes;
        unknown[24] = 3;
        assert_eq!(TapMeta::decode(&unknown), None);
    }
}
