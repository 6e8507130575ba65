//! Frames: flags, length, body.

use super::ProtocolError;
use bytes::Buf;

/// More frames of the same message follow.
pub(in crate::transport::zeromq) const MORE: u8 = 1;
/// The length takes eight bytes instead of one.
const LONG: u8 = 2;
/// The frame is a command and belongs to no message.
pub(super) const COMMAND: u8 = 4;

/// What precedes the body of a frame to be sent.
#[derive(Clone, Copy)]
pub(in crate::transport::zeromq) struct Header {
    bytes: [u8; 9],
    length: u8,
}

impl Header {
    pub(in crate::transport::zeromq) fn new(flags: u8, body: usize) -> Self {
        let body = body as u64;
        let [.., short] = body.to_be_bytes();
        let mut bytes = [0; 9];
        if body == u64::from(short) {
            bytes[0] = flags;
            bytes[1] = short;
            return Self { bytes, length: 2 };
        }
        bytes[0] = flags | LONG;
        bytes[1..].copy_from_slice(&body.to_be_bytes());
        Self { bytes, length: 9 }
    }

    pub(in crate::transport::zeromq) fn as_bytes(&self) -> &[u8] {
        &self.bytes[..usize::from(self.length)]
    }
}

/// What precedes the body of a received frame.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Head {
    pub(super) flags: u8,
    /// Length of the flags and the length field.
    pub(super) header: usize,
    /// Announced length of the body; not to be trusted yet.
    pub(super) body: u64,
}

impl Head {
    /// Returns `None` if more bytes are needed.
    pub(super) fn parse(bytes: &[u8]) -> Result<Option<Self>, ProtocolError> {
        let Some(&flags) = bytes.first() else { return Ok(None) };
        if flags & !(MORE | LONG | COMMAND) != 0 {
            return Err(ProtocolError::Flags(flags));
        }
        if flags & LONG == 0 {
            return Ok(bytes.get(1).map(|&body| Self { flags, header: 2, body: body.into() }));
        }
        Ok(bytes.get(1..9).map(|mut length| Self { flags, header: 9, body: length.get_u64() }))
    }

    pub(super) fn is_command(&self) -> bool {
        self.flags & COMMAND != 0
    }

    pub(super) fn has_more(&self) -> bool {
        self.flags & MORE != 0
    }
}

/// The bodies of encoded frames, which must be complete.
pub(in crate::transport::zeromq) fn bodies(mut frames: &[u8]) -> impl Iterator<Item = &[u8]> {
    std::iter::from_fn(move || {
        let head = Head::parse(frames).ok()??;
        let (body, rest) = frames.get(head.header..)?.split_at_checked(usize::try_from(head.body).ok()?)?;
        frames = rest;
        Some(body)
    })
}
