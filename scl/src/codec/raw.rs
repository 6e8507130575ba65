//! The bytes in memory, for types of fixed layout.

use super::{Codec, DecodeError, EncodeError};
use bytes::{Bytes, BytesMut};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Encodes types of fixed layout as their bytes in memory.
///
/// The fastest codec. The bytes depend on the machine's byte order, unless the type uses the numbers of
/// `zerocopy::byteorder`. A frame must be exactly as long as the type. For plain bytes use [`Opaque`](super::Opaque).
#[derive(Debug)]
pub struct Raw;

// Without this attribute the compiler reports the bounds below instead of the message of `Codec`.
#[diagnostic::do_not_recommend]
impl<T: IntoBytes + FromBytes + KnownLayout + Immutable> Codec<T> for Raw {
    const NAME: &'static str = "raw";
    const FIXED_LENGTH: Option<usize> = Some(size_of::<T>());

    fn encode(message: &T, buffer: &mut BytesMut) -> Result<(), EncodeError> {
        buffer.extend_from_slice(message.as_bytes());
        Ok(())
    }

    fn decode(bytes: Bytes) -> Result<T, DecodeError> {
        // The error of `read_from_bytes` borrows the bytes and contains nothing but the lengths.
        T::read_from_bytes(&bytes).map_err(|_| Self::wrong_length::<T>(bytes.len()))
    }
}

impl Raw {
    /// Creates the error for a frame whose length, `received`, is not that of a `T`.
    pub(crate) fn wrong_length<T>(received: usize) -> DecodeError {
        DecodeError::new("raw", format!("expected exactly {} bytes, received {received}", size_of::<T>()))
    }
}
